#pragma once

// Gradient noise in space: Perlin 1985, "An Image Synthesizer", with Hermite weights and unit
// gradients as in Shirley et al., "Ray Tracing: The Next Week", chapter 5. Gradients are selected
// by a hash of the lattice point instead of a permutation, so the noise does not repeat.

#include <cstdint>

#include "renderlib/math/vec.h"

namespace bandsaw {

/// Returns noise in [-0.87, 0.87]. The noise is once differentiable, and it is 0 at points with
/// integer coordinates. Returns 0 where a component of p is not finite or too large (2^51) to have
/// a useful fraction.
double noise(const Vec3& p);

/// Returns |sum of noise(2^i p) / 2^i over i < octaves|, in [0, 1.74].
double turbulence(const Vec3& p, std::uint32_t octaves);

}  // namespace bandsaw
