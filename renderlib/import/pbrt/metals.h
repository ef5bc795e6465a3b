#pragma once

// Converts pbrt's metals. Each function reads the parameters of the pbrt material `from` and sets
// the material `to` of our scene. Errors are INVALID_ARGUMENT for a parameter that is wrong.

#include "absl/status/status.h"
#include "renderlib/import/pbrt/material_source.h"

namespace bandsaw::pbrt {

/// Converts a metal without a coat. The parameters give either its complex index of refraction, eta
/// and k, or its reflectance.
absl::Status conductor(const MaterialSource& from, Surface& to);

/// Converts a metal under a clear coat to glTF's metal with a clear coat.
absl::Status coated_conductor(const MaterialSource& from, Surface& to);

}  // namespace bandsaw::pbrt
