// Finds the crossings of a ray with the boundaries of media one after the other, and stores the
// first few. First counts, for each medium, how many shapes with this medium contain the ray's
// origin. For this count, each place ahead where the ray leaves such a shape adds 1, and each place
// where it enters one subtracts 1. Then walks along the ray and keeps the count up to date: a place
// where the ray enters a shape adds 1, and a place where it leaves one subtracts 1.

#include "renderlib/integrate/medium_traversal.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "renderlib/geometry/surface.h"
#include "renderlib/medium/attenuation.h"
#include "renderlib/medium/tracking.h"

namespace bandsaw {
namespace {

/// A barycentric coordinate below this is 0 up to rounding.
constexpr double kRim = 1e-12;

}  // namespace

int* MediumTraversal::Around::count_of(const Region& region) {
  for (std::size_t i = 0; i < size_; ++i) {
    if (entries_[i].region == region) {
      return &entries_[i].shapes;
    }
  }
  for (std::size_t i = 0; i < size_; ++i) {
    if (entries_[i].shapes == 0) {
      entries_[i].region = region;
      return &entries_[i].shapes;
    }
  }
  if (size_ == kMaxOverlappingMedia) {
    return nullptr;
  }
  entries_[size_] = {region, 0};
  return &entries_[size_++].shapes;
}

void MediumTraversal::Around::add(const Region& region, int shapes) {
  if (int* const count = count_of(region)) {
    *count += shapes;
  }
}

void MediumTraversal::Around::forget_negative() {
  for (std::size_t i = 0; i < size_; ++i) {
    entries_[i].shapes = std::max(0, entries_[i].shapes);
  }
}

std::optional<MediumTraversal::Around::Region> MediumTraversal::Around::top() const {
  const auto order = [](const Region& region) { return std::pair(region.medium, region.boundary); };
  std::optional<Region> top;
  for (std::size_t i = 0; i < size_; ++i) {
    if (entries_[i].shapes > 0 && (!top || order(entries_[i].region) > order(*top))) {
      top = entries_[i].region;
    }
  }
  return top;
}

MediumTraversal::MediumTraversal(const Scene& scene, const Ray& ray, double length,
                                 std::uint64_t& rays)
    : scene_(scene), ray_(ray), length_(length), rays_(rays) {
  // The boundaries beyond the end of the segment also determine what contains the origin.
  // `ray.from` refers to the scene's primitives, not to the boundaries', so it is cleared.
  ray_.t_max = kInfinity;
  ray_.from = kNoPrimitive;
  if (scene.media().has_boundaries()) {
    find_around_origin();
  }
}

bool MediumTraversal::is_of_mesh(const Hit& hit) const {
  return hit.id.instance != 0 &&
         scene_.media().boundaries.instances[hit.id.instance - 1].group == kNoGroup;
}

bool MediumTraversal::varies(MediumId medium) const {
  return scene_.features().grids && scene_.grid_medium(medium) != nullptr;
}

std::optional<MediumTraversal::Crossing> MediumTraversal::find_next(Search& search) {
  const Accel& boundaries = scene_.boundary_accel();
  for (;;) {
    ++rays_;
    const Hit hit =
        search.last ? boundaries.closest_after(ray_, search.last) : boundaries.closest(ray_);
    if (!hit) {
      return std::nullopt;
    }
    search.last = hit;
    const SurfacePoint point = surface_at(scene_.media().boundaries, ray_, hit, false);
    const double slope = dot(ray_.direction, point.geometric_normal);
    Crossing crossing;
    crossing.t = hit.t;
    crossing.shape = {hit.id.instance, hit.id.instance == 0 ? hit.id.primitive : 0};
    crossing.medium = medium_in(point.material);
    crossing.boundary = varies(crossing.medium) ? hit.id.instance : 0;
    crossing.inwards = slope < 0;
    // Where triangles of a mesh share an edge or a corner, a ray crosses the boundary only once, so
    // further hits at the same distance are skipped. Such distances differ by a rounding error,
    // which the offset bounds.
    crossing.on_rim = is_of_mesh(hit) && std::min({hit.u, hit.v, 1 - hit.u - hit.v}) < kRim;
    const double same = 4 * point.offset / std::max(0.01, std::abs(slope));
    const auto known = static_cast<std::ptrdiff_t>(std::min(search.found, Search::kRecent));
    const bool again = std::any_of(
        search.recent.begin(), search.recent.begin() + known, [&](const Crossing& other) {
          return other.on_rim && crossing.on_rim && other.shape == crossing.shape &&
                 other.inwards == crossing.inwards && crossing.t - other.t <= same;
        });
    if (!again) {
      search.recent[search.found++ % Search::kRecent] = crossing;
      return crossing;
    }
  }
}

void MediumTraversal::find_around_origin() {
  Search all;
  while (const std::optional<Crossing> crossing = find_next(all)) {
    if (kept_size_ < kKept) {
      kept_[kept_size_++] = *crossing;
      if (kept_size_ == kKept) {
        beyond_kept_ = all;
      }
    } else {
      all_kept_ = false;
    }
    around_.add({crossing->medium, crossing->boundary}, crossing->inwards ? -1 : 1);
  }
  around_.forget_negative();
}

std::optional<MediumTraversal::Crossing> MediumTraversal::take_crossing() {
  if (taken_ < kept_size_) {
    return kept_[taken_++];
  }
  if (all_kept_) {
    return std::nullopt;
  }
  const std::optional<Crossing> crossing = find_next(beyond_kept_);
  all_kept_ = !crossing;
  return crossing;
}

MediumSegment MediumTraversal::here() const {
  const Media& media = scene_.media();
  const std::optional<Around::Region> inside = around_.top();
  const std::optional<MediumId> id = inside ? std::optional(inside->medium) : media.fog;
  if (!id || is_clear(media.media[index_of(*id)])) {
    return {};
  }
  MediumSegment segment;
  segment.medium = &media.media[index_of(*id)];
  if (varies(*id)) {
    segment.varying = scene_.grid_medium(*id);
    segment.boundary = inside->boundary;
  }
  return segment;
}

std::optional<MediumSegment> MediumTraversal::next() {
  while (at_ < length_) {
    MediumSegment segment = here();
    segment.begin = at_;
    const std::optional<Crossing> crossing = take_crossing();
    at_ = crossing ? std::min(crossing->t, length_) : length_;
    if (crossing) {
      around_.add({crossing->medium, crossing->boundary}, crossing->inwards ? 1 : -1);
    }
    if (segment.medium != nullptr && at_ > segment.begin) {
      segment.end = at_;
      return segment;
    }
  }
  return std::nullopt;
}

GridRay in_medium_space(const Scene& scene, const Ray& ray, const MediumSegment& segment) {
  const Transform to_medium = scene.to_medium(segment.boundary, ray.time);
  return {to_medium.point(ray.origin + ray.direction * segment.begin),
          to_medium.direction(ray.direction)};
}

Rgb media_transmittance(const Scene& scene, const Ray& ray, NumberStream numbers,
                        std::uint64_t& rays) {
  const double size = length(ray.direction);
  Ray unit = ray;
  unit.direction = ray.direction / size;
  MediumTraversal walk(scene, unit, ray.t_max * size, rays);
  Rgb share = gray(1);
  while (const std::optional<MediumSegment> segment = walk.next()) {
    const double part = segment->end - segment->begin;
    share *= segment->varying == nullptr
                 ? transmittance(*segment->medium, part)
                 : estimate_transmittance(*segment->varying, in_medium_space(scene, unit, *segment),
                                          part, numbers);
    if (is_black(share)) {
      break;
    }
  }
  return share;
}

}  // namespace bandsaw
