#include "renderlib/integrate/medium_walk.h"

#include <algorithm>

#include "renderlib/geometry/surface.h"
#include "renderlib/medium/attenuation.h"

namespace bandsaw {

void MediumWalk::Around::enter(const Crossing& crossing) {
  if (size_ < kMostNested && !contains(crossing.shape)) {
    entries_[size_++] = {crossing.shape, crossing.medium};
  }
}

bool MediumWalk::Around::leave(const PrimitiveId& shape) {
  for (std::size_t i = 0; i < size_; ++i) {
    if (entries_[i].shape == shape) {
      entries_[i] = entries_[--size_];
      return true;
    }
  }
  return false;
}

bool MediumWalk::Around::contains(const PrimitiveId& shape) const {
  return std::any_of(entries_.begin(), entries_.begin() + size_,
                     [&](const Entry& entry) { return entry.shape == shape; });
}

std::optional<MediumId> MediumWalk::Around::medium() const {
  std::optional<MediumId> top;
  for (std::size_t i = 0; i < size_; ++i) {
    top = !top || entries_[i].medium > *top ? entries_[i].medium : top;
  }
  return top;
}

MediumWalk::MediumWalk(const Scene& scene, const Ray& ray, double length, std::uint64_t& rays)
    : scene_(scene), ray_(ray), length_(length), rays_(rays) {
  // Beyond its end, too, boundaries tell what the origin is inside of; and the surface that the ray
  // starts on is no boundary by its number.
  ray_.t_max = kInfinity;
  ray_.from = kNoPrimitive;
  if (scene.media().has_boundaries()) {
    find_around_origin();
  }
}

std::optional<MediumWalk::Crossing> MediumWalk::crossing_after(const Hit& after) {
  const Accel& boundaries = scene_.boundary_accel();
  ++rays_;
  const Hit hit = after ? boundaries.closest_after(ray_, after) : boundaries.closest(ray_);
  if (!hit) {
    return std::nullopt;
  }
  const SurfacePoint point = surface_at(scene_.media().boundaries, ray_, hit, false);
  Crossing crossing;
  crossing.hit = hit;
  crossing.shape = {hit.id.instance, hit.id.instance == 0 ? hit.id.primitive : 0};
  crossing.medium = medium_in(point.material);
  crossing.inwards = dot(ray_.direction, point.geometric_normal) < 0;
  return crossing;
}

void MediumWalk::find_around_origin() {
  Around entered;
  Crossing before;
  Hit last;
  while (const std::optional<Crossing> crossing = crossing_after(last)) {
    last = crossing->hit;
    // Through an edge that two triangles share a ray goes once.
    const bool again = crossing->shape == before.shape && crossing->inwards == before.inwards;
    before = *crossing;
    if (kept_size_ < kKept) {
      kept_[kept_size_++] = *crossing;
      last_ = last;
    } else {
      all_kept_ = false;
    }
    if (crossing->inwards) {
      entered.enter(*crossing);
    } else if (!entered.leave(crossing->shape) && !again) {
      around_.enter(*crossing);
    }
  }
}

std::optional<MediumWalk::Crossing> MediumWalk::take_crossing() {
  if (taken_ < kept_size_) {
    return kept_[taken_++];
  }
  if (all_kept_) {
    return std::nullopt;
  }
  const std::optional<Crossing> crossing = crossing_after(last_);
  last_ = crossing ? crossing->hit : last_;
  all_kept_ = !crossing;
  return crossing;
}

const Medium* MediumWalk::here() const {
  const Media& media = scene_.media();
  const std::optional<MediumId> inside = around_.medium();
  const std::optional<MediumId> id = inside ? inside : media.fog;
  if (!id) {
    return nullptr;
  }
  const Medium& medium = media.media[index_of(*id)];
  return is_clear(medium) ? nullptr : &medium;
}

std::optional<Stretch> MediumWalk::next() {
  while (at_ < length_) {
    const double begin = at_;
    const Medium* const medium = here();
    const std::optional<Crossing> crossing = take_crossing();
    at_ = crossing ? std::min(crossing->hit.t, length_) : length_;
    if (crossing && crossing->inwards) {
      around_.enter(*crossing);
    } else if (crossing) {
      around_.leave(crossing->shape);
    }
    if (medium != nullptr && at_ > begin) {
      return Stretch{begin, at_, medium};
    }
  }
  return std::nullopt;
}

Rgb media_transmittance(const Scene& scene, const Ray& ray, std::uint64_t& rays) {
  const double size = length(ray.direction);
  Ray unit = ray;
  unit.direction = ray.direction / size;
  MediumWalk walk(scene, unit, ray.t_max * size, rays);
  Rgb share = gray(1);
  while (const std::optional<Stretch> stretch = walk.next()) {
    share *= transmittance(*stretch->medium, stretch->end - stretch->begin);
    if (is_black(share)) {
      break;
    }
  }
  return share;
}

}  // namespace bandsaw
