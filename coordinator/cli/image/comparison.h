#pragma once

// Computes the metrics of an image against a reference and formats them, for `bandsaw compare`.
// `bandsaw study` uses compare_images() as well.

#include <string>

#include "absl/status/statusor.h"
#include "renderlib/compare/bias.h"
#include "renderlib/compare/error_metrics.h"
#include "renderlib/compare/plane.h"

namespace bandsaw::coordinator {

struct Comparison {
  ErrorMetrics errors;
  BiasTest bias;
  double ssim = 1;   ///< structural similarity, at most 1; 1: no difference
  Plane flip;        ///< FLIP of each pixel: the difference that people see, in [0, 1]
  bool hdr = false;  ///< the reference has values above those of a screen, so `flip` is HDR-FLIP
};

/// Computes all metrics. If a channel of a pixel is not finite in one of the images, no metric
/// counts it as a difference. INVALID_ARGUMENT: the images differ in size.
absl::StatusOr<Comparison> compare_images(const Image& image, const Image& reference);

/// Formats the metrics in four lines, and a fifth if values are not finite; the last line has no
/// line end. Returns "identical" for equal images.
std::string comparison_text(const Comparison& comparison);

/// Formats the metrics as one JSON object.
std::string comparison_json(const Comparison& comparison);

}  // namespace bandsaw::coordinator
