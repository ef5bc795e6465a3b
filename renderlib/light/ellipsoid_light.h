#pragma once

// Sampling of ellipsoids as area lights. An ellipsoid is the image of the unit sphere under an
// affine map. A sample is the image of a uniform point of the sphere. The area pdf of the sample is
// the area pdf of the sphere, divided by the factor by which the map scales areas at the point.

#include <optional>

#include "renderlib/light/shape_light.h"

namespace bandsaw {

/// Samples a point of the ellipsoid, seen from `from`; u, v in [0, 1). The pdf of the result is by
/// solid angle. `shape` MUST be a `ShapeView::Kind::kEllipsoid`.
std::optional<ShapeSample> sample_ellipsoid(const ShapeView& shape, const Vec3& from, double u,
                                            double v);
/// Returns the pdf with respect to area at `position`, a point on the ellipsoid.
double ellipsoid_area_pdf(const ShapeView& shape, const Vec3& position);
/// Returns the area, accurate to a few percent.
double ellipsoid_area(const ShapeView& shape);

}  // namespace bandsaw
