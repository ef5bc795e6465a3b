#pragma once

// Ellipsoids as lights: spheres that a placement has stretched. A uniform point of the unit sphere
// is mapped along, so the density by area is that of the sphere over what the map does to areas.

#include <optional>

#include "renderlib/light/shape_light.h"

namespace bandsaw {

/// As sample (light/shape_light.h), of a ShapeView::Kind::kEllipsoid.
std::optional<ShapeSample> sample_ellipsoid(const ShapeView& shape, const Vec3& from, double u,
                                            double v);
/// The density by area at `position`, a point of the ellipsoid.
double ellipsoid_area_pdf(const ShapeView& shape, const Vec3& position);
double ellipsoid_area(const ShapeView& shape);

}  // namespace bandsaw
