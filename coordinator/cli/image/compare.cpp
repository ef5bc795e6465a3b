// The command `bandsaw compare`: prints error metrics of an image against a reference, and writes a
// picture of the differences.

#include <atomic>

#include "coordinator/cli/image/comparison.h"
#include "coordinator/cli/image/output.h"
#include "coordinator/cli/options/commands.h"
#include "coordinator/cli/scene/import_process.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/compare/false_color.h"

namespace bandsaw::coordinator {

namespace {

struct Pair {
  Image image;
  Image reference;
};

/// Reads both images, each in a child process with limits (ImportLimits). CANCELLED: a signal came.
absl::StatusOr<Pair> read_pair(const CompareOptions& options, Interrupts& interrupts) {
  std::atomic<bool> stop{false};
  const Interrupts::Listener listener(interrupts, [&] { stop = true; });
  ImportLimits limits;
  limits.stop = &stop;
  Pair pair;
  ASSIGN_OR_RETURN(pair.image, read_image_in_process(options.image, limits));
  ASSIGN_OR_RETURN(pair.reference, read_image_in_process(options.reference, limits));
  return pair;
}

}  // namespace

ExitCode run(const CompareOptions& options, Process& process) {
  if (const absl::Status status = check_outputs_writable(options.outputs); !status.ok()) {
    return process.console.fail(ExitCode::kWrong, std::string(status.message()));
  }
  const auto pair = read_pair(options, process.interrupts);
  if (!pair.ok()) {
    const bool interrupted = absl::IsCancelled(pair.status());
    return process.console.fail(interrupted ? ExitCode::kInterrupted : ExitCode::kWrong,
                                std::string(pair.status().message()));
  }
  const auto comparison = compare_images(pair->image, pair->reference);
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
