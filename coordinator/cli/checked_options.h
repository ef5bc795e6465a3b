#pragma once

// Options as they were typed, and the checks that turn them into a command's options. All errors
// are INVALID_ARGUMENT.

#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "coordinator/cli/options.h"

namespace bandsaw::coordinator {

/// The union of all commands' options, unread.
struct RawOptions {
  std::string scene, image, reference, data, farm;
  std::optional<std::string> job, listen;
  std::vector<std::string> outputs, parts;
  std::optional<std::string> samples, error, time, seed, width, height, depth, threads, rows;
  std::optional<std::string> integrator, exposure, tone, layers;
  bool half = false, insecure = false, detach = false, quiet = false, json = false;
};

absl::StatusOr<Command> checked_serve(const RawOptions& raw);
absl::StatusOr<Command> checked_submit(const RawOptions& raw);
absl::StatusOr<Command> checked_watch(const RawOptions& raw);
absl::StatusOr<Command> checked_jobs(const RawOptions& raw);
absl::StatusOr<Command> checked_workers(const RawOptions& raw);
absl::StatusOr<Command> checked_cancel(const RawOptions& raw);
absl::StatusOr<Command> checked_render(const RawOptions& raw);
absl::StatusOr<Command> checked_info(const RawOptions& raw);
absl::StatusOr<Command> checked_stitch(const RawOptions& raw);
absl::StatusOr<Command> checked_compare(const RawOptions& raw);

}  // namespace bandsaw::coordinator
