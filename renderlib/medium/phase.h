#pragma once

// The phase function of Henyey and Greenstein 1941, "Diffuse radiation in the Galaxy",
// Astrophysical Journal 93, eq. 2. g is the mean cosine between the directions of travel before and
// after scattering; 0 is isotropic.

#include "renderlib/math/vec.h"

namespace bandsaw {

/// Returns the pdf, by solid angle, of each direction that has this cosine to the previous
/// direction. |g| < 1.
double phase(double g, double cosine);

/// Samples a unit direction of travel after scattering, with the pdf phase(). `direction` is the
/// unit direction of travel before scattering; u, v in [0, 1).
Vec3 sample_phase(double g, const Vec3& direction, double u, double v);

}  // namespace bandsaw
