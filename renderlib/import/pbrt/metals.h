#pragma once

// Metals, with and without a coat.

#include "absl/status/status.h"
#include "renderlib/import/pbrt/material_source.h"

namespace bandsaw::pbrt {

absl::Status conductor(const MaterialSource& from, Surface& to);

/// A metal under a clear coat: glTF's metal with clear coat stands for it.
absl::Status coated_conductor(const MaterialSource& from, Surface& to);

}  // namespace bandsaw::pbrt
