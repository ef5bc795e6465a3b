#pragma once

// Options of `invite` and `dismiss`.

#include <CLI/CLI.hpp>

#include "coordinator/cli/options/checked_options.h"

namespace bandsaw::coordinator {

void add_invite(CLI::App& app, RawOptions& raw);
void add_dismiss(CLI::App& app, RawOptions& raw);
absl::StatusOr<Command> checked_invite(const RawOptions& raw);
absl::StatusOr<Command> checked_dismiss(const RawOptions& raw);

}  // namespace bandsaw::coordinator
