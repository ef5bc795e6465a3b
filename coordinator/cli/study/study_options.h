#pragma once

// Options of `bandsaw study`.

#include <CLI/CLI.hpp>

#include "coordinator/cli/options/checked_options.h"

namespace bandsaw::coordinator {

void add_study(CLI::App& app, RawOptions& raw);
absl::StatusOr<Command> checked_study(const RawOptions& raw);

}  // namespace bandsaw::coordinator
