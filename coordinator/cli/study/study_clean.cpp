// clean_table() writes the measurements of `bandsaw study --denoise` as a table, and then the
// geometric means and the worst scene for each number of samples.

#include "coordinator/cli/study/study_clean.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_replace.h"

namespace bandsaw::coordinator {
namespace {

/// An estimated error is counted as right if it is between these multiples of the true error.
constexpr double kMinRatio = 0.7;
constexpr double kMaxRatio = 1.5;

/// Accumulates the gains (CleanPoint::gain) of all scenes at one number of samples.
struct Gains {
  double logarithms = 0;  ///< sum of the logarithms of the gains, for their geometric mean
  double of_time = 0;     ///< sum of the logarithms of the gains in equal time
  double least = 1e300;
  double least_of_time = 1e300;
  std::string worst;  ///< name of the scene with the least gain
  double count = 0;

  /// A gain of 0 or below counts as 1e-9, so that its logarithm is finite.
  void add(const std::string& scene, const CleanPoint& point) {
    logarithms += std::log(std::max(1e-9, point.gain()));
    of_time += std::log(std::max(1e-9, point.gain_in_equal_time()));
    worst = point.gain() < least ? scene : worst;
    least = std::min(least, point.gain());
    least_of_time = std::min(least_of_time, point.gain_in_equal_time());
    count += 1;
  }
};

std::string range_text(const std::vector<double>& ratios) {
  const auto [least, most] = std::minmax_element(ratios.begin(), ratios.end());
  return ratios.empty() ? "–" : absl::StrFormat("%.2f–%.2f", *least, *most);
}

std::string row(const std::string& scene, const CleanPoint& point) {
  return absl::StrFormat("| %s | %.4g | %.2g | %.2g | %.2f × | %.2f × | %.4f → %.4f | %s |\n",
                         absl::StrReplaceAll(scene, {{"|", "/"}}), point.samples, point.raw_mse,
                         point.clean_mse, point.gain(), point.gain_in_equal_time(), point.raw_flip,
                         point.clean_flip, range_text(point.error_ratios));
}

}  // namespace

std::string clean_table(const std::vector<CleanOfScene>& studies) {
  std::string out =
      "| scene | samples a pixel | relMSE as rendered | clean | ratio | ratio in equal time | FLIP "
      "| estimated / true error |\n| --- | --- | --- | --- | --- | --- | --- | --- |\n";
  std::map<double, Gains> gains;
  double images = 0;
  double right = 0;
  for (const CleanOfScene& study : studies) {
    for (const CleanPoint& point : study.points) {
      absl::StrAppend(&out, row(study.scene, point));
      gains[point.samples].add(study.scene, point);
      for (const double ratio : point.error_ratios) {
        images += 1;
        right += ratio >= kMinRatio && ratio <= kMaxRatio ? 1 : 0;
      }
    }
  }
  absl::StrAppend(
      &out,
      "\n| samples a pixel | geometric mean of the ratios | in equal time | least ratio "
      "| in equal time |\n| --- | --- | --- | --- | --- |\n");
  for (const auto& [samples, total] : gains) {
    absl::StrAppendFormat(&out, "| %.4g | %.2f × | %.2f × | %.2f × (%s) | %.2f × |\n", samples,
                          std::exp(total.logarithms / total.count),
                          std::exp(total.of_time / total.count), total.least,
                          absl::StrReplaceAll(total.worst, {{"|", "/"}}), total.least_of_time);
  }
  if (images > 0) {
    absl::StrAppendFormat(
        &out,
        "\nThe estimated error is %.1f to %.1f times the true one in %.0f %% of %.0f images.\n",
        kMinRatio, kMaxRatio, 100 * right / images, images);
  }
  return out;
}

}  // namespace bandsaw::coordinator
