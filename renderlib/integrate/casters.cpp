// The constructor lists the primitives of casters by material, with the sums of their areas.
// sample() chooses a material, a primitive by its area, and a point.

#include "renderlib/integrate/casters.h"

#include <algorithm>
#include <cmath>

#include "renderlib/geometry/placement.h"
#include "renderlib/light/ellipsoid_light.h"
#include "renderlib/light/shape_light.h"
#include "renderlib/sampling/warp.h"

namespace bandsaw {
namespace {

/// Maximum number of primitives that are listed.
constexpr std::size_t kMaxPrimitives = std::size_t{1} << 18;

/// Rougher metals cast no sharp light. A material that blends several kinds of surface is a caster
/// if its factor of metal or of transmission is above this.
constexpr double kRoughest = 0.5;

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

/// A random place on a shape, uniform except on ellipsoids.
struct Place {
  Vec3 position;
  Vec2 on_shape;  ///< Hit::u and Hit::v of the place
};

Place place_on(const ShapeView& shape, double u, double v) {
  using Kind = ShapeView::Kind;
  if (shape.kind == Kind::kSphere) {
    return {shape.a + sample_sphere(u, v) * shape.radius, {}};
  }
  if (shape.kind == Kind::kEllipsoid) {
    const Vec3 on_ball = sample_sphere(u, v);
    return {shape.a + shape.u * on_ball.x + shape.v * on_ball.y + shape.w * on_ball.z, {}};
  }
  Vec2 at{u, v};
  if (shape.kind == Kind::kDisk) {
    at = sample_disk(u, v);
  } else if (shape.kind == Kind::kTriangle) {
    const double far = std::sqrt(u);
    at = {far * (1 - v), far * v};
  }
  return {shape.a + shape.u * at.x + shape.v * at.y, at};
}

}  // namespace

Casters::Casters(const Scene& scene) : scene_(scene) {
  const Geometry& geometry = scene.geometry();
  const std::size_t materials = scene.materials().size();
  for (const Material& material : scene.materials()) {
    casting_.push_back(is_caster(material));
  }
  std::vector<PrimitiveId> ids;
  for (std::uint32_t instance = 0; instance <= geometry.instances.size(); ++instance) {
    const Instance* placed = instance == 0 ? nullptr : &geometry.instances[instance - 1];
    const std::size_t count =
        placed == nullptr ? geometry.size() : primitives_of(geometry, *placed);
    for (std::uint32_t primitive = 0; primitive < count; ++primitive) {
      const MaterialId material = placed == nullptr
                                      ? material_of(static_cast<const Shapes&>(geometry), primitive)
                                      : material_of(geometry, *placed, primitive);
      if (casts(material)) {
        ids.push_back({instance, primitive});
      }
    }
  }
  const std::size_t step = (ids.size() + kMaxPrimitives - 1) / kMaxPrimitives;
  complete_ = step <= 1;
  std::vector<OfMaterial> all(materials);
  for (std::size_t i = 0; i < ids.size(); i += step) {
    OfMaterial& to = all[index_of(material_of(geometry, ids[i]))];
    const double before = to.primitives.empty() ? 0 : to.primitives.back().area_up_to;
    const double size = area(shape_view(geometry, ids[i], middle_of(shutter_of(scene.camera()))));
    if (size > 0 && std::isfinite(before + size)) {
      to.primitives.push_back({ids[i], before + size});
    } else if (size > 0) {
      complete_ = false;
    }
  }
  for (OfMaterial& of : all) {
    if (!of.primitives.empty()) {
      materials_.push_back(std::move(of));
    }
  }
}

std::optional<CasterSample> Casters::sample(double material, double primitive, double u, double v,
                                            double time) const {
  const auto which = static_cast<std::size_t>(material * static_cast<double>(materials_.size()));
  const std::vector<Primitive>& primitives =
      materials_[std::min(which, materials_.size() - 1)].primitives;
  const double total = primitives.back().area_up_to;
  const auto found =
      std::upper_bound(primitives.begin(), primitives.end() - 1, primitive * total,
                       [](double area, const Primitive& one) { return area < one.area_up_to; });
  // surface_at() computes the surface point from a ray and a hit: on a sphere or an ellipsoid from
  // the end of the ray, on other shapes from Hit::u and Hit::v.
  const ShapeView shape = shape_view(scene_.geometry(), found->id, time);
  const Place place = place_on(shape, u, v);
  const Ray ray{
      .origin = shape.kind == ShapeView::Kind::kSphere || shape.kind == ShapeView::Kind::kEllipsoid
                    ? shape.a
                    : place.position,
      .direction = place.position - shape.a,
      .time = time};
  const Hit hit{.t = 1, .id = found->id, .u = place.on_shape.x, .v = place.on_shape.y};
  CasterSample sample{surface_at(scene_.geometry(), ray, hit, scene_.features().uv)};
  sample.pdf = 1 / (total * static_cast<double>(materials_.size()));
  if (shape.kind == ShapeView::Kind::kEllipsoid) {
    sample.pdf *= area(shape) * ellipsoid_area_pdf(shape, place.position);
  }
  return std::isfinite(sample.pdf) && is_finite(sample.point.position) ? std::optional(sample)
                                                                       : std::nullopt;
}

}  // namespace bandsaw
