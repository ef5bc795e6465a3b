#pragma once

// Where a medium scatters light: Henyey and Greenstein 1941, "Diffuse radiation in the Galaxy",
// Astrophysical Journal 93, eq. 2. g is the mean cosine between the ways before and after; 0 is
// isotropic.

#include "renderlib/math/vec.h"

namespace bandsaw {

/// The density, by solid angle, of directions that make this cosine with the way before. |g| < 1.
double phase(double g, double cosine);

/// A direction after scattering, unit, with that density; `way` is the unit direction before; u, v
/// in [0, 1).
Vec3 sample_phase(double g, const Vec3& way, double u, double v);

}  // namespace bandsaw
