#pragma once

// --report, of every command that writes images.

#include <CLI/CLI.hpp>

#include "coordinator/cli/options/checked_options.h"

namespace bandsaw::coordinator {

void add_report(CLI::App& app, RawOptions& raw);

}  // namespace bandsaw::coordinator
