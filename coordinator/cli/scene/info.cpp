// The command `bandsaw info`: prints a summary of a scene or model, and which of its features are
// not supported.

#include <algorithm>
#include <thread>
#include <utility>

#include "coordinator/cli/options/commands.h"
#include "coordinator/cli/scene/import_scene_file.h"
#include "coordinator/cli/scene/scene_summary.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/scene/scene.h"

namespace bandsaw::coordinator {
namespace {

/// Imports the scene of the options, builds it, and returns its summary.
absl::StatusOr<SceneSummary> summary_of_file(const InfoOptions& options, Process& process) {
  // Quiet, because the summary contains the warnings.
  ASSIGN_OR_RETURN(DecodedScene decoded,
                   decode_scene_file(options.scene, {.quiet = true}, process, options.choices));
  ASSIGN_OR_RETURN(const std::vector<BlobRef> blobs, package_blobs(decoded.manifest));
  std::uint64_t bytes = decoded.manifest.size();
  for (const BlobRef& blob : blobs) {
    bytes += blob.size;
  }
  SceneSummary summary = summary_of(decoded.scene, decoded.info, bytes);
  // The BVHs are built only to determine their size.
  Pool pool(static_cast<int>(std::max(1U, std::thread::hardware_concurrency())));
  ASSIGN_OR_RETURN(const auto built, Scene::build(std::move(decoded.scene), pool));
  summary.tree_bytes = built->accel().bytes();
  return summary;
}

}  // namespace

ExitCode run(const InfoOptions& options, Process& process) {
  const auto summary = summary_of_file(options, process);
  if (!summary.ok()) {
    return process.console.fail(import_exit_code(summary.status()),
                                std::string(summary.status().message()));
  }
  if (options.verbosity.json) {
    process.console.line(summary_json(*summary));
    return ExitCode::kDone;
  }
  for (const std::string& line : summary_text(*summary)) {
    process.console.line(line);
  }
  return ExitCode::kDone;
}

}  // namespace bandsaw::coordinator
