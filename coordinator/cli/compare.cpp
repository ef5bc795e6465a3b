// bandsaw compare: error metrics between two images.

#include <atomic>

#include "coordinator/cli/commands.h"
#include "coordinator/cli/image_metrics.h"
#include "coordinator/cli/import_process.h"
#include "coordinator/cli/json.h"

namespace bandsaw::coordinator {
namespace {

std::string json_text(const ImageMetrics& metrics) {
  return JsonObject()
      .flag("identical", metrics.identical)
      .number("rmse", metrics.rmse)
      .number("relative_rmse", metrics.relative_rmse)
      .number("relative_mse", metrics.relative_mse)
      .number("max_difference", metrics.max_difference)
      .whole("max_x", metrics.max_x)
      .whole("max_y", metrics.max_y)
      .whole("not_finite", metrics.not_finite)
      .str();
}

}  // namespace

ExitCode run(const CompareOptions& options, Process& process) {
  std::atomic<bool> stop{false};
  Interrupts::Listener listener(process.interrupts, [&] { stop = true; });
  ImportLimits limits;
  limits.stop = &stop;
  const auto image = read_image_in_process(options.image, limits);
  const auto reference = image.ok() ? read_image_in_process(options.reference, limits) : image;
  if (!image.ok() || !reference.ok()) {
    const absl::Status status = image.ok() ? reference.status() : image.status();
    const bool interrupted = absl::IsCancelled(status);
    return process.console.fail(interrupted ? ExitCode::kInterrupted : ExitCode::kWrong,
                                std::string(status.message()));
  }
  const auto metrics = compare_images(*image, *reference);
  if (!metrics.ok()) {
    return process.console.fail(ExitCode::kWrong, std::string(metrics.status().message()));
  }
  process.console.line(options.verbosity.json ? json_text(*metrics) : metrics_text(*metrics));
  return ExitCode::kDone;
}

}  // namespace bandsaw::coordinator
