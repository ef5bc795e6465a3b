#pragma once

// The results of `bandsaw study --denoise`: errors and CPU times of images as rendered and of the
// same images with their noise removed (renderlib/denoise). The errors are against a converged
// reference image of another seed. study_measure.cpp measures them.

#include <string>
#include <vector>

namespace bandsaw::coordinator {

/// Results for one number of samples, as means over the seeds. The part of the error that the noise
/// of the reference causes is subtracted from both relMSE.
struct CleanPoint {
  double samples = 0;    ///< per pixel
  double raw_mse = 0;    ///< relMSE (compare/error_metrics.h) of the image as rendered
  double clean_mse = 0;  ///< relMSE of the clean image
  double raw_cpu_s = 0;  ///< CPU time of the image as rendered
  /// raw_cpu_s plus the CPU time of the guides (images by which the filter finds edges) and of the
  /// filter.
  double clean_cpu_s = 0;
  double raw_flip = 0;  ///< mean FLIP; HDR-FLIP if the reference has values that no screen shows
  double clean_flip = 0;
  /// For each seed, the estimated RMSE of the clean image divided by its true RMSE. The part of the
  /// true RMSE that the noise of the reference causes is subtracted. If nothing remains of the true
  /// RMSE, the seed is omitted.
  std::vector<double> error_ratios = {};

  /// Returns the relMSE of the image as rendered divided by that of the clean one; 0: unknown.
  double gain() const { return clean_mse > 0 ? raw_mse / clean_mse : 0; }
  /// Returns gain() for equal CPU time, as if the image as rendered had been given the CPU time of
  /// the clean image. The relMSE of such an image is not measured. It is estimated as `raw_mse`
  /// scaled by 1 / time.
  double gain_in_equal_time() const {
    return clean_cpu_s > 0 ? gain() * raw_cpu_s / clean_cpu_s : 0;
  }
};

struct CleanOfScene {
  std::string scene;
  std::vector<CleanPoint> points;  ///< sorted by samples
};

/// Returns two tables in Markdown and a sentence. The first table has a row for each scene and
/// number of samples; the second has the geometric means and the least gains over the scenes. The
/// sentence states for how many images the estimated error is 0.7 to 1.5 times the true one. The
/// text ends with a line end.
std::string clean_table(const std::vector<CleanOfScene>& studies);

}  // namespace bandsaw::coordinator
