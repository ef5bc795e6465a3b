#pragma once

// Measures what removing the noise (renderlib/denoise) is worth: images as rendered and clean,
// against a converged reference that has another seed.

#include <string>
#include <vector>

namespace bandsaw::coordinator {

/// Means over the seeds. The estimated error of the reference is subtracted from the errors.
struct CleanPoint {
  double samples = 0;    ///< per pixel
  double raw_mse = 0;    ///< relMSE (compare/error_metrics.h) of the image as rendered
  double clean_mse = 0;  ///< relMSE of the clean image
  double raw_cpu_s = 0;
  double clean_cpu_s = 0;  ///< CPU time of the image, of the filter's guides and of the filter
  double raw_flip = 0;     ///< mean FLIP, or HDR-FLIP if the reference exceeds a screen
  double clean_flip = 0;
  /// For each seed, the estimated RMSE of the clean image divided by the true one.
  std::vector<double> error_ratios = {};

  double gain() const { return clean_mse > 0 ? raw_mse / clean_mse : 0; }
  /// Returns by how much the clean image's squared error is smaller than that of an image as
  /// rendered in the clean one's time; without the filter, the squared error falls as 1 / time.
  double gain_in_equal_time() const {
    return clean_cpu_s > 0 ? gain() * raw_cpu_s / clean_cpu_s : 0;
  }
};

struct CleanOfScene {
  std::string scene;
  std::vector<CleanPoint> points;  ///< sorted by samples
};

/// Returns a table in Markdown, a row for each scene and number of samples, then the geometric
/// means and the least gains over the scenes; then the share of images whose estimated error is
/// within 0.7 to 1.5 of the true one. Ends with a line end.
std::string clean_table(const std::vector<CleanOfScene>& studies);

}  // namespace bandsaw::coordinator
