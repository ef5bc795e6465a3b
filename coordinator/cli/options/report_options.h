#pragma once

// The option --report, for all commands that write images.

#include <CLI/CLI.hpp>

#include "coordinator/cli/options/checked_options.h"

namespace bandsaw::coordinator {

void add_report(CLI::App& app, RawOptions& raw);

}  // namespace bandsaw::coordinator
