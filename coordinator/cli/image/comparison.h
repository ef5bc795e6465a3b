#pragma once

// Metrics computed by `bandsaw compare` for an image and a reference.

#include <string>

#include "absl/status/statusor.h"
#include "renderlib/compare/bias.h"
#include "renderlib/compare/error_metrics.h"
#include "renderlib/compare/plane.h"

namespace bandsaw::coordinator {

struct Comparison {
  ErrorMetrics errors;
  BiasTest bias;
  double ssim = 1;
  Plane flip;        ///< per pixel
  bool hdr = false;  ///< the reference exceeds the range of a display: flip is HDR-FLIP
};

/// INVALID_ARGUMENT: the sizes differ.
absl::StatusOr<Comparison> compare_images(const Image& image, const Image& reference);

/// Formats the metrics in four lines, the last without a line end; or "identical".
std::string comparison_text(const Comparison& comparison);

/// Formats the metrics as one JSON object.
std::string comparison_json(const Comparison& comparison);

}  // namespace bandsaw::coordinator
