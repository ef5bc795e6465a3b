// The constructor numbers all lights and computes their bounds. sample() chooses a light
// (light_choice.h), then a point on the light, in a way that depends on the kind of light. pdf()
// returns the pdf of this choice for a point that a ray has hit.

#include "renderlib/light/lights.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <type_traits>
#include <utility>

#include "renderlib/geometry/placement.h"
#include "renderlib/light/emission.h"
#include "renderlib/light/shape_light.h"
#include "renderlib/material/opacity.h"

namespace bandsaw {
namespace {

/// Returns the pivot of a delta light, around which distances along a ray are sampled. It is the
/// position of the light, or `distant` for a directional light.
LightPivot pivot_of(const DeltaLight& light) {
  return std::visit(
      [](const auto& kind) -> LightPivot {
        if constexpr (std::is_same_v<std::decay_t<decltype(kind)>, DirectionalLight>) {
          return {.distant = true};
        } else {
          return {.position = kind.position};
        }
      },
      light);
}

}  // namespace

Lights::Lights(const Geometry& geometry, const std::vector<Material>& materials,
               const std::vector<Texture>& textures, const std::vector<DeltaLight>& delta_lights,
               const Background& background)
    : geometry_(&geometry),
      materials_(&materials),
      textures_(&textures),
      background_(&background),
      uses_uv_(std::any_of(textures.begin(), textures.end(), uses_uv)) {
  std::vector<LightBound> local = add_surfaces();
  std::vector<DistantBound> distant = add_delta_lights(delta_lights, local);
  if (background.environment) {
    environment_ = EnvironmentLight(*background.environment, textures);
  }
  if (!environment_.empty()) {
    distant.push_back({environment_.excess(), std::nullopt});
  }
  choice_ = LightChoice(std::move(local), std::move(distant));
}

std::vector<LightBound> Lights::add_surfaces() {
  std::vector<double> radiance(materials_->size(), 0.0);
  std::map<TextureId, Rgb> means;  // many materials may share one large image
  const auto mean_of = [&](TextureId texture) {
    auto known = means.find(texture);
    if (known == means.end()) {
      known = means.emplace(texture, mean(*textures_, texture)).first;
    }
    return known->second;
  };
  for (std::size_t i = 0; i < materials_->size(); ++i) {
    const MeanEmission emission =
        mean_emission(*materials_, MaterialId{static_cast<std::uint32_t>(i)}, mean_of);
    radiance[i] = brightness(emission.radiance);
    one_sided_.push_back(emission.one_sided);
  }
  const Geometry& geometry = *geometry_;
  std::map<GroupId, bool> emitting_groups;
  std::vector<LightBound> bounds;
  // Instance 0 stands for the shapes that are in no instance.
  for (std::uint32_t instance = 0; instance <= geometry.instances.size(); ++instance) {
    std::size_t primitives = geometry.size();
    if (instance > 0) {
      const Instance& placed = geometry.instances[instance - 1];
      const bool own = placed.group != kNoGroup && placed.material == kOwnMaterial;
      const bool emits = own ? group_emits(instance, radiance, emitting_groups)
                             : radiance[index_of(placed.material)] > 0;
      primitives = emits ? primitives_of(geometry, placed) : 0;
    }
    first_of_instance_.push_back(primitives == 0 ? kNoLight
                                                 : static_cast<std::uint32_t>(light_of_.size()));
    for (std::uint32_t primitive = 0; primitive < primitives; ++primitive) {
      add_surface({instance, primitive}, radiance, bounds);
    }
  }
  return bounds;
}

// The result for a group is kept in `known`. Examining a group again for each of its instances
// would take too long, because a group may have many instances and many primitives.
bool Lights::group_emits(std::uint32_t instance, const std::vector<double>& radiance,
                         std::map<GroupId, bool>& known) const {
  const Instance& placed = geometry_->instances[instance - 1];
  const auto found = known.find(placed.group);
  if (found != known.end()) {
    return found->second;
  }
  bool emits = false;
  const std::size_t primitives = primitives_of(*geometry_, placed);
  for (std::uint32_t primitive = 0; primitive < primitives && !emits; ++primitive) {
    emits = radiance[index_of(material_of(*geometry_, {instance, primitive}))] > 0;
  }
  return known.emplace(placed.group, emits).first->second;
}

void Lights::add_surface(PrimitiveId id, const std::vector<double>& radiance,
                         std::vector<LightBound>& to) {
  light_of_.push_back(kNoLight);
  const MaterialId material = material_of(*geometry_, id);
  if (radiance[index_of(material)] == 0) {
    return;
  }
  const auto bound_at = [&](double time) {
    return bound_of(shape_view(*geometry_, id, time), radiance[index_of(material)],
                    one_sided_[index_of(material)]);
  };
  const Interval& shutter = geometry_->shutter;
  LightBound bound = bound_at(shutter.open);
  if (id.instance != 0) {
    const Instance& instance = geometry_->instances[id.instance - 1];
    if (deforms(*geometry_, instance)) {
      const double middle = shutter.open + (shutter.close - shutter.open) / 2;
      bound.intensity = std::max(
          {bound.intensity, bound_at(middle).intensity, bound_at(shutter.close).intensity});
    }
    if (moves(*geometry_, instance)) {
      // The bound of a moving light covers its whole path and all orientations.
      bound = {.ball = moving_ball(*geometry_, id), .intensity = bound.intensity};
    }
  }
  if (!(bound.intensity > 0) || !std::isfinite(bound.intensity)) {
    return;
  }
  light_of_.back() = static_cast<std::uint32_t>(ids_.size());
  ids_.push_back(id);
  to.push_back(bound);
}

std::vector<DistantBound> Lights::add_delta_lights(const std::vector<DeltaLight>& delta_lights,
                                                   std::vector<LightBound>& local) {
  std::vector<DistantBound> distant;
  std::vector<DeltaLight> distant_lights;
  for (const DeltaLight& light : delta_lights) {
    if (const auto* directional = std::get_if<DirectionalLight>(&light)) {
      if (!is_black(directional->irradiance)) {
        distant.push_back({brightness(directional->irradiance), -directional->direction});
        distant_lights.push_back(light);
      }
      continue;
    }
    const auto* point = std::get_if<PointLight>(&light);
    const auto* spot = std::get_if<SpotLight>(&light);
    const LightBound bound = point != nullptr ? bound_of(*point)
                             : spot != nullptr
                                 ? bound_of(*spot, *textures_)
                                 : bound_of(std::get<ProjectorLight>(light), *textures_);
    if (bound.intensity > 0) {
      local.push_back(bound);
      delta_.push_back(light);
    }
  }
  delta_.insert(delta_.end(), distant_lights.begin(), distant_lights.end());
  return distant;
}

std::uint32_t Lights::index_of_light(PrimitiveId id) const {
  if (id.instance >= first_of_instance_.size() || first_of_instance_[id.instance] == kNoLight) {
    return kNoLight;
  }
  return light_of_[first_of_instance_[id.instance] + id.primitive];
}

std::optional<LightSample> Lights::sample(const Receiver& receiver, double choice, double u,
                                          double v) const {
  const auto chosen = choice_.choose(receiver, choice);
  if (!chosen) {
    return std::nullopt;
  }
  const std::size_t delta = chosen->light - ids_.size();
  std::optional<LightSample> sample =
      chosen->light < ids_.size() ? sample_surface(ids_[chosen->light], receiver, u, v)
      : delta < delta_.size()     ? sample_delta(delta_[delta], receiver)
                                  : sample_environment(receiver, u, v);
  if (!sample || is_black(sample->radiance)) {
    return std::nullopt;
  }
  sample->pdf *= chosen->probability;
  return sample->pdf > 0 ? sample : std::nullopt;
}

std::optional<LightPivot> Lights::sample_pivot(const ReceiverSegment& segment, double time,
                                               double choice, double u, double v) const {
  const auto chosen = choice_.choose(segment, choice);
  if (!chosen) {
    return std::nullopt;
  }
  const std::size_t delta = chosen->light - ids_.size();
  if (chosen->light >= ids_.size()) {
    return delta < delta_.size() ? pivot_of(delta_[delta]) : LightPivot{.distant = true};
  }
  const ShapeView shape = shape_view(*geometry_, ids_[chosen->light], time);
  const Vec3 middle = bounds(shape).center;
  const Vec3 from = segment.origin + segment.direction * segment.nearest(middle);
  const std::optional<ShapeSample> on_light = bandsaw::sample(shape, from, u, v);
  return LightPivot{on_light ? on_light->position : middle};
}

std::optional<LightSample> Lights::sample_surface(PrimitiveId id, const Receiver& receiver,
                                                  double u, double v) const {
  const ShapeView shape = shape_view(*geometry_, id, receiver.time);
  const std::optional<ShapeSample> on_light = bandsaw::sample(shape, receiver.position, u, v);
  if (!on_light) {
    return std::nullopt;
  }
  const Vec3 to_light = on_light->position - receiver.position;
  const double facing = -dot(on_light->normal, to_light);
  if (!receiver.faces(to_light) || facing == 0) {
    return std::nullopt;
  }
  const Ray ray{.origin = receiver.position, .direction = to_light, .time = receiver.time};
  const Hit hit{.t = 1, .id = id, .u = on_light->on_shape.x, .v = on_light->on_shape.y};
  const SurfacePoint point = surface_at(*geometry_, ray, hit, uses_uv_);
  LightSample sample;
  sample.direction = normalize(to_light);
  sample.target = on_light->position + (facing < 0 ? -point.away : point.away);
  const bool to_camera = receiver.within != nullptr;
  sample.radiance = emitted_if_present(*materials_, point.material, *textures_, point,
                                       -sample.direction, to_camera);
  sample.pdf = on_light->pdf;
  return sample;
}

std::optional<LightSample> Lights::sample_delta(const DeltaLight& light,
                                                const Receiver& receiver) const {
  const Arrival arrives = std::visit(
      [&](const auto& kind) { return arrival(kind, *textures_, receiver.position); }, light);
  if (!receiver.faces(arrives.to_light)) {
    return std::nullopt;
  }
  return LightSample{.direction = normalize(arrives.to_light),
                     .target = receiver.position + arrives.to_light,
                     .radiance = arrives.irradiance,
                     .pdf = 1,
                     .distant = std::holds_alternative<DirectionalLight>(light),
                     .delta = true};
}

std::optional<LightSample> Lights::sample_environment(const Receiver& receiver, double u,
                                                      double v) const {
  const EnvironmentLight::Sample toward = environment_.sample(u, v);
  if (!receiver.faces(toward.direction)) {
    return std::nullopt;
  }
  return LightSample{.direction = toward.direction,
                     .target = {},
                     .radiance = bandsaw::radiance(*background_, *textures_, toward.direction),
                     .pdf = toward.pdf,
                     .distant = true};
}

double Lights::pdf(const Receiver& receiver, const SurfacePoint& hit) const {
  const double chosen = probability(receiver, hit.id);
  if (chosen == 0 ||
      (receiver.within != nullptr && !receiver.faces(hit.position - receiver.position))) {
    return 0;
  }
  return chosen * direction_pdf(shape_view(*geometry_, hit.id, receiver.time), receiver.position,
                                hit.position, hit.geometric_normal);
}

double Lights::environment_pdf(const Receiver& receiver, const Vec3& direction) const {
  const double pdf = environment_.pdf(direction);
  return pdf > 0 && receiver.faces(direction) ? pdf * choice_.probability(receiver, size() - 1) : 0;
}

double Lights::probability(const Receiver& receiver, PrimitiveId id) const {
  const std::uint32_t index = index_of_light(id);
  return index == kNoLight ? 0 : choice_.probability(receiver, index);
}

}  // namespace bandsaw
