#pragma once

// Removes noise from a rendered image and estimates the error of the result, bias included, without
// a reference (README.md).

#include <vector>

#include "renderlib/base/pool.h"
#include "renderlib/denoise/fit.h"
#include "renderlib/image/image.h"

namespace bandsaw {

/// A rendered image, and two guide images that show the surfaces almost without noise. All images
/// have the same size and are not empty.
struct DenoiseInput {
  Image mean;   ///< mean of all samples of each pixel, linear radiance
  Image first;  ///< mean of the first of two independent parts of the samples
  /// Share of the first part in each pixel's samples, (0, 1).
  std::vector<float> first_share;
  Image albedo;  ///< guide: by the integrator kGuideAlbedo (scene/guide_integrators.h)
  Image shape;   ///< guide: normal and distance, by the integrator kGuideShape
  /// Share of the image as rendered in the samples of `mean`, (0, 1]. It is below 1 if further
  /// samples were added for the denoiser (halves.h, add_samples).
  double rendered_share = 1;
};

/// Estimated errors of the image as rendered ("raw") and of the result ("clean"). A pixel counts,
/// with all three channels, if it is finite in the image and in both parts of the samples. All
/// members are 0 if no pixel counts.
struct CleanError {
  double mean = 0;        ///< mean value of the image
  double rmse_raw = 0;    ///< RMSE of the image as rendered, without further samples
  double rmse_clean = 0;  ///< RMSE of the clean image, bias included
  double bias_share = 0;  ///< share of the squared bias in rmse_clean^2, [0, 1]

  double relative_raw() const { return mean > 0 ? rmse_raw / mean : 0; }
  double relative_clean() const { return mean > 0 ? rmse_clean / mean : 0; }
  /// Returns an upper bound of the clean image's relative error. Stop rules compare this bound with
  /// their target.
  double at_most() const { return kMargin * relative_clean(); }
  /// This factor covers most ratios of true and estimated error in NOTES.md. With it, all 66 images
  /// of seven scenes that stopped at a target of 3 % met the target.
  static constexpr double kMargin = 1.4;
  friend bool operator==(const CleanError&, const CleanError&) = default;
};

/// The result of denoise().
struct Denoised {
  Image image;
  /// Estimated error of each pixel: the root of the mean squared error over its channels and over
  /// the pixels around it. All three channels of a pixel hold this value.
  Image error;
  CleanError total;
};

/// Removes the noise. `fit` is the fit() of any kernel (render/kernel.h). A pixel stays as it was
/// rendered if the estimated error of its filtered value is larger than that of its rendered value,
/// by more than the standard error of this estimate.
/// It also stays as it was rendered if one of its values is negative, above 1e15 or not finite.
///
/// The image is filtered in strips of `strip_rows` rows, an even number. If `strip_rows` is 0, a
/// strip has about a quarter of a megapixel. In addition to input and result, denoise() needs less
/// than 350 bytes for each pixel of a strip and of the rows around it. The result has the same bits
/// for any number of threads, any kernel and any `strip_rows`.
Denoised denoise(const DenoiseInput& input, FitFunction fit, Pool& pool, int strip_rows = 0);

}  // namespace bandsaw
