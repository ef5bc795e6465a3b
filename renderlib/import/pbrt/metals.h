#pragma once

// Metals, with and without a coat.

#include "absl/status/status.h"
#include "renderlib/import/pbrt/material_source.h"

namespace bandsaw::pbrt {

/// Converts a metal.
absl::Status conductor(const MaterialSource& from, Surface& to);

/// Converts a metal under a clear coat to glTF's metal with a clear coat.
absl::Status coated_conductor(const MaterialSource& from, Surface& to);

}  // namespace bandsaw::pbrt
