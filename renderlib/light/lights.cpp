#include "renderlib/light/lights.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "renderlib/base/check.h"
#include "renderlib/geometry/placement.h"
#include "renderlib/light/emission.h"
#include "renderlib/material/opacity.h"

namespace bandsaw {
namespace {

constexpr double kUnits = 0x1p32;

std::optional<Emission> emission_of(const std::vector<Material>& materials, MaterialId id) {
  return bandsaw::emission_of(materials[index_of(id)]);
}

/// Whether any primitive that the instance places may give light.
bool may_emit(const Instance& instance, const std::vector<Material>& materials) {
  const bool own = instance.group != kNoGroup && instance.material == kOwnMaterial;
  return own || emission_of(materials, instance.material).has_value();
}

}  // namespace

Lights::Lights(const Geometry& geometry, const std::vector<Material>& materials,
               const std::vector<Texture>& textures, const Interval& interval)
    : geometry_(&geometry), materials_(&materials), textures_(&textures) {
  std::vector<double> radiance_means(materials.size(), 0.0);
  for (std::size_t i = 0; i < materials.size(); ++i) {
    if (const auto emission = bandsaw::emission_of(materials[i])) {
      const Rgb value = mean(textures, emission->radiance.texture) * emission->radiance.factor;
      radiance_means[i] = (double{value.r} + value.g + value.b) / 3;
    }
  }
  std::vector<double> powers;
  for (std::uint32_t instance = 0; instance <= geometry.instances.size(); ++instance) {
    std::size_t primitives = geometry.size();
    if (instance > 0) {
      const Instance& placed = geometry.instances[instance - 1];
      primitives = may_emit(placed, materials) ? primitives_of(geometry, placed) : 0;
    }
    first_of_instance_.push_back(primitives == 0 ? kNoLight
                                                 : static_cast<std::uint32_t>(light_of_.size()));
    for (std::uint32_t primitive = 0; primitive < primitives; ++primitive) {
      add(geometry, {instance, primitive}, radiance_means, interval, powers);
    }
  }
  if (ids_.size() > kFewLights) {
    bounds_.clear();
    bounds_.shrink_to_fit();
    choose_by_power(powers);
  }
}

void Lights::add(const Geometry& geometry, PrimitiveId id,
                 const std::vector<double>& radiance_means, const Interval& interval,
                 std::vector<double>& powers) {
  light_of_.push_back(kNoLight);
  const MaterialId material = material_of(geometry, id);
  const double radiance = radiance_means[index_of(material)];
  if (radiance == 0) {
    return;
  }
  const ShapeView shape = shape_view(geometry, id, interval.open);
  const Emission emission = *emission_of(*materials_, material);
  const bool flat = is_flat(shape);
  const double sides = flat && !emission.one_sided ? 2 : 1;
  const double power = kPi * radiance * area(shape) * sides;
  if (!(power > 0) || !std::isfinite(power)) {
    return;
  }
  light_of_.back() = static_cast<std::uint32_t>(ids_.size());
  ids_.push_back(id);
  powers.push_back(power);
  if (bounds_.size() <= kFewLights) {
    const bool rests = id.instance == 0 || geometry.instances[id.instance - 1].frame == kNoFrame;
    bounds_.push_back({.ball = rests ? bounds(shape) : moving_ball(geometry, id, interval),
                       .power = power,
                       .flat = flat && rests,
                       .one_sided = emission.one_sided,
                       .normal = flat ? normalize(flat_normal(shape)) : Vec3{}});
  }
}

void Lights::choose_by_power(const std::vector<double>& powers) {
  double total = 0;
  for (const double power : powers) {
    total += power;
  }
  // Every light gets one unit, so that none is never chosen; the rest is dealt out by power, by
  // rounding the running sum.
  const double to_deal = kUnits - static_cast<double>(powers.size());
  BANDSAW_CHECK(to_deal > 0, "there are fewer lights than numbers to choose them by");
  double sum = 0;
  for (std::size_t i = 0; i < powers.size(); ++i) {
    sum += powers[i];
    const double dealt = std::floor(to_deal * std::min(1.0, sum / total));
    ends_.push_back(static_cast<std::uint64_t>(dealt) + i + 1);
  }
  ends_.back() = std::uint64_t{1} << 32;
}

/// power x cosines / distance^2, each factor at its largest over the light; zero only where nothing
/// can arrive.
double Lights::weight(const Bound& bound, const Receiver& receiver) {
  const Vec3 way = bound.ball.center - receiver.position;
  const double radius = bound.ball.radius;
  const double distance = length(way);
  const double nearest = std::max(distance - radius, 0.0);
  const double above = dot(receiver.normal, way) + radius;
  if (above <= 0) {
    return 0;
  }
  double cosines = nearest > above ? above / nearest : 1;
  if (bound.flat) {
    const double height = -dot(bound.normal, way);
    if (height == 0 || (height < 0 && bound.one_sided)) {
      return 0;
    }
    cosines *= nearest > std::abs(height) ? std::abs(height) / nearest : 1;
  }
  return bound.power * cosines / std::max(distance * distance, radius * radius);
}

std::optional<Lights::Choice> Lights::choose(const Receiver& receiver, double choice) const {
  if (!bounds_.empty()) {
    std::array<double, kFewLights> sums;
    double sum = 0;
    for (std::size_t i = 0; i < bounds_.size(); ++i) {
      sum += weight(bounds_[i], receiver);
      sums[i] = sum;
    }
    if (!(sum > 0)) {
      return std::nullopt;
    }
    std::size_t index = 0;
    while (index + 1 < bounds_.size() && sums[index] <= choice * sum) {
      ++index;
    }
    const double before = index == 0 ? 0 : sums[index - 1];
    const double probability = (sums[index] - before) / sum;
    return probability > 0 ? std::optional(Choice{index, probability}) : std::nullopt;
  }
  const auto unit = static_cast<std::uint64_t>(choice * kUnits);
  const auto end = std::upper_bound(ends_.begin(), ends_.end(), unit);
  if (end == ends_.end()) {
    return std::nullopt;
  }
  const auto index = static_cast<std::size_t>(end - ends_.begin());
  return Choice{index, probability_of(receiver, index)};
}

double Lights::probability_of(const Receiver& receiver, std::size_t index) const {
  if (bounds_.empty()) {
    const std::uint64_t begin = index == 0 ? 0 : ends_[index - 1];
    return static_cast<double>(ends_[index] - begin) / kUnits;
  }
  double sum = 0;
  double before = 0;
  double end = 0;
  for (std::size_t i = 0; i < bounds_.size(); ++i) {
    before = i == index ? sum : before;
    sum += weight(bounds_[i], receiver);
    end = i == index ? sum : end;
  }
  return sum > 0 ? (end - before) / sum : 0;
}

std::uint32_t Lights::index_of_light(PrimitiveId id) const {
  if (id.instance >= first_of_instance_.size() || first_of_instance_[id.instance] == kNoLight) {
    return kNoLight;
  }
  return light_of_[first_of_instance_[id.instance] + id.primitive];
}

std::optional<LightSample> Lights::sample(const Receiver& receiver, double choice, double u,
                                          double v) const {
  const std::optional<Choice> chosen = choose(receiver, choice);
  if (!chosen) {
    return std::nullopt;
  }
  const PrimitiveId id = ids_[chosen->index];
  const ShapeView shape = shape_view(*geometry_, id, receiver.time);
  const std::optional<ShapeSample> on_light = bandsaw::sample(shape, receiver.position, u, v);
  if (!on_light) {
    return std::nullopt;
  }
  const Vec3 way = on_light->position - receiver.position;
  const double facing = -dot(on_light->normal, way);
  if (dot(way, receiver.normal) <= 0 || facing == 0) {
    return std::nullopt;
  }
  const Ray ray{.origin = receiver.position, .direction = way, .time = receiver.time};
  const Hit hit{.t = 1, .id = id, .u = on_light->on_shape.x, .v = on_light->on_shape.y};
  const SurfacePoint point = surface_at(*geometry_, ray, hit);
  LightSample sample;
  sample.direction = normalize(way);
  sample.target = on_light->position + on_light->normal * std::copysign(point.offset, facing);
  sample.radiance =
      emitted((*materials_)[index_of(point.material)], *textures_, point, -sample.direction) *
      static_cast<float>(opacity((*materials_)[index_of(point.material)], *textures_, point));
  sample.pdf = on_light->pdf * chosen->probability;
  return sample.pdf > 0 && !is_black(sample.radiance) ? std::optional(sample) : std::nullopt;
}

double Lights::pdf(const Receiver& receiver, const SurfacePoint& hit) const {
  const double chosen = probability(receiver, hit.id);
  if (chosen == 0) {
    return 0;
  }
  return chosen * direction_pdf(shape_view(*geometry_, hit.id, receiver.time), receiver.position,
                                hit.position, hit.geometric_normal);
}

double Lights::probability(const Receiver& receiver, PrimitiveId id) const {
  const std::uint32_t index = index_of_light(id);
  return index == kNoLight ? 0 : probability_of(receiver, index);
}

}  // namespace bandsaw
