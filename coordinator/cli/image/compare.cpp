// bandsaw compare: error metrics between two images.

#include <atomic>

#include "coordinator/cli/image/comparison.h"
#include "coordinator/cli/options/commands.h"
#include "coordinator/cli/options/output.h"
#include "coordinator/cli/scene/import_process.h"
#include "renderlib/compare/false_color.h"

namespace bandsaw::coordinator {

ExitCode run(const CompareOptions& options, Process& process) {
  if (const absl::Status status = check_outputs_writable(options.outputs); !status.ok()) {
    return process.console.fail(ExitCode::kWrong, std::string(status.message()));
  }
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
  const auto comparison = compare_images(*image, *reference);
  if (!comparison.ok()) {
    return process.console.fail(ExitCode::kWrong, std::string(comparison.status().message()));
  }
  const absl::Status written = write_outputs(false_color(comparison->flip), options.outputs, {});
  if (!written.ok()) {
    return process.console.fail(ExitCode::kFailed, std::string(written.message()));
  }
  process.console.line(options.verbosity.json ? comparison_json(*comparison)
                                              : comparison_text(*comparison));
  return ExitCode::kDone;
}

}  // namespace bandsaw::coordinator
