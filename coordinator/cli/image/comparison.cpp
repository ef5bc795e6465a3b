// compare_images() computes all error metrics; the other functions write them as text and as JSON.

#include "coordinator/cli/image/comparison.h"

#include <cmath>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "coordinator/cli/base/json.h"
#include "renderlib/compare/flip.h"
#include "renderlib/compare/ssim.h"

namespace bandsaw::coordinator {
namespace {

/// If one of the two values is not finite, sets both to the reference's value, or to 0 if the
/// reference's value is not finite.
void leave_out_if_not_finite(float& value, float& reference) {
  if (!std::isfinite(reference)) {
    reference = 0;
    value = 0;
  } else if (!std::isfinite(value)) {
    value = reference;
  }
}

/// Calls leave_out_if_not_finite() for all channels of two images of the same size, so that SSIM
/// and FLIP see no difference where a value is not finite.
void leave_out_not_finite(Image& image, Image& reference) {
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    Rgb& a = image.pixels[i];
    Rgb& b = reference.pixels[i];
    leave_out_if_not_finite(a.r, b.r);
    leave_out_if_not_finite(a.g, b.g);
    leave_out_if_not_finite(a.b, b.b);
  }
}

/// Sets the metrics of what a viewer sees: Comparison::ssim, flip and hdr.
void add_seen_differences(const Image& image, const Image& reference, Comparison& to) {
  to.hdr = beyond_screen(reference);
  to.ssim = ssim(image, reference);
  to.flip = to.hdr ? hdr_flip(image, reference) : flip(image, reference);
}

}  // namespace

absl::StatusOr<Comparison> compare_images(const Image& image, const Image& reference) {
  if (image.width != reference.width || image.height != reference.height) {
    return absl::InvalidArgumentError(absl::StrCat("the images differ in size: ", image.width, "×",
                                                   image.height, " and ", reference.width, "×",
                                                   reference.height));
  }
  Comparison out;
  out.errors = error_metrics(image, reference);
  out.bias = test_bias(image, reference);
  if (out.errors.not_finite == 0) {
    add_seen_differences(image, reference, out);
    return out;
  }
  Image seen = image;
  Image seen_reference = reference;
  leave_out_not_finite(seen, seen_reference);
  add_seen_differences(seen, seen_reference, out);
  return out;
}

std::string comparison_text(const Comparison& comparison) {
  const ErrorMetrics& errors = comparison.errors;
  if (errors.identical) {
    return "identical";
  }
  const BiasTest& bias = comparison.bias;
  // The last line is the bias test. "Blocks off" are blocks of pixels whose |t| exceeds the test's
  // bound.
  std::string text = absl::StrFormat(
      "RMSE %.4g · relRMSE %.4g %% · relMSE %.4g, %.4g without the worst 0.1 %% of pixels · "
      "MAPE %.4g %%\n"
      "PSNR %.4g dB · SSIM %.4f · %s %.4f\n"
      "max difference %.4g at pixel (%d, %d)\n"
      "bias %+.3g %%, t %.2f · %d of %d blocks off, worst t %.2f at pixel (%d, %d)",
      errors.rmse, errors.relative_rmse * 100, errors.relative_mse, errors.trimmed_relative_mse,
      errors.mape * 100, errors.psnr, comparison.ssim, comparison.hdr ? "HDR-FLIP" : "FLIP",
      mean(comparison.flip), errors.max_difference, errors.max_x, errors.max_y,
      bias.relative_bias * 100, bias.t, bias.suspicious_blocks, bias.blocks, bias.worst_t,
      bias.worst_x, bias.worst_y);
  if (errors.not_finite > 0) {
    absl::StrAppend(&text, "\n", errors.not_finite,
                    errors.not_finite == 1 ? " value is not finite and was left out"
                                           : " values are not finite and were left out");
  }
  return text;
}

std::string comparison_json(const Comparison& comparison) {
  const ErrorMetrics& errors = comparison.errors;
  const BiasTest& bias = comparison.bias;
  return JsonObject()
      .flag("identical", errors.identical)
      .number("rmse", errors.rmse)
      .number("relative_rmse", errors.relative_rmse)
      .number("relative_mse", errors.relative_mse)
      .number("trimmed_relative_mse", errors.trimmed_relative_mse)
      .number("mape", errors.mape)
      .number("psnr", errors.psnr)
      .number("ssim", comparison.ssim)
      .number("flip", mean(comparison.flip))
      .flag("flip_is_hdr", comparison.hdr)
      .number("max_difference", errors.max_difference)
      .whole("max_x", errors.max_x)
      .whole("max_y", errors.max_y)
      .whole("not_finite", errors.not_finite)
      .number("relative_bias", bias.relative_bias)
      .number("bias_t", bias.t)
      .whole("bias_blocks", bias.blocks)
      .whole("bias_suspicious_blocks", bias.suspicious_blocks)
      .number("bias_worst_t", bias.worst_t)
      .str();
}

}  // namespace bandsaw::coordinator
