// A caster is a surface that casts caustics. For each material, the constructor lists the
// primitives that are casters. sample() chooses a material, and then a point of its primitives.

#include "renderlib/integrate/casters.h"

#include <algorithm>
#include <utility>

#include "renderlib/geometry/placement.h"
#include "renderlib/geometry/primitive_list.h"

namespace bandsaw {
namespace {

/// Maximum number of primitives that are listed.
constexpr std::uint64_t kMaxPrimitives = std::uint64_t{1} << 18;

/// Largest roughness of a caster that is no Dielectric (glass). Metals with a larger roughness cast
/// no sharp light. A MetallicRoughness or Principled material blends several kinds of surface. It
/// is a caster only if its factor of metal is above the same number 0.5. In a Principled material,
/// the factor of transmission may be above 0.5 instead.
constexpr double kRoughest = 0.5;

/// Returns true if surfaces of the material cast caustics. Alpha of a Conductor is the square of
/// the roughness.
bool is_caster(const Material& material) {
  if (const auto* metal = std::get_if<Metal>(&material.kind)) {
    return metal->fuzz <= kRoughest;
  }
  if (const auto* conductor = std::get_if<Conductor>(&material.kind)) {
    return std::max(conductor->surface.alpha_u, conductor->surface.alpha_v) <=
           kRoughest * kRoughest;
  }
  if (const auto* gltf = std::get_if<MetallicRoughness>(&material.kind)) {
    return gltf->metallic.factor > kRoughest && gltf->roughness.factor <= kRoughest;
  }
  if (const auto* principled = std::get_if<Principled>(&material.kind)) {
    return (principled->metallic.value > kRoughest || principled->spec_trans.value > kRoughest) &&
           principled->roughness.value <= kRoughest;
  }
  return std::holds_alternative<Dielectric>(material.kind);
}

}  // namespace

Casters::Casters(const Scene& scene) : scene_(scene) {
  const Geometry& geometry = scene.geometry();
  for (const Material& material : scene.materials()) {
    casting_.push_back(is_caster(material));
  }
  if (scene.moves()) {
    for (const Instance& instance : geometry.instances) {
      moving_.push_back(bandsaw::moves(geometry, instance));
    }
  }
  const PrimitiveList list(geometry, casting_);
  const std::uint64_t step = (list.size() + kMaxPrimitives - 1) / kMaxPrimitives;
  complete_ = step <= 1;
  std::vector<SurfaceSampler> all(scene.materials().size());
  for (std::uint64_t i = 0; i < list.size(); i += step) {
    const PrimitiveId id = list[i];
    complete_ = all[index_of(material_of(geometry, id))].add(scene, id) && complete_;
  }
  for (SurfaceSampler& of : all) {
    if (!of.empty()) {
      materials_.push_back(std::move(of));
    }
  }
}

Casters Casters::none(const Scene& scene) { return {scene, scene.materials().size()}; }

std::optional<SurfaceSample> Casters::sample(double material, double primitive, double u, double v,
                                             double time) const {
  const auto which = static_cast<std::size_t>(material * static_cast<double>(materials_.size()));
  std::optional<SurfaceSample> sample =
      materials_[std::min(which, materials_.size() - 1)].sample(scene_, primitive, u, v, time);
  if (sample) {
    sample->pdf /= static_cast<double>(materials_.size());
  }
  return sample;
}

}  // namespace bandsaw
