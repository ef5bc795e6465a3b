#pragma once

// Converts pbrt's metals for make_surface() (materials.cpp). Errors are INVALID_ARGUMENT for a
// parameter that is wrong.

#include "absl/status/status.h"
#include "renderlib/import/pbrt/material_source.h"

namespace bandsaw::pbrt {

/// Converts a metal without a coat, given by eta and k or by its reflectance.
absl::Status conductor(const MaterialSource& from, Surface& to);

/// Converts a metal under a clear coat to glTF's metal with a clear coat.
absl::Status coated_conductor(const MaterialSource& from, Surface& to);

}  // namespace bandsaw::pbrt
