#pragma once

// Options of the administration commands.

#include <CLI/CLI.hpp>

#include "coordinator/cli/options/checked_options.h"

namespace bandsaw::coordinator {

// Each function adds a command's options.
void add_serve(CLI::App& app, RawOptions& raw);
void add_logs(CLI::App& app, RawOptions& raw);
void add_quarantine(CLI::App& app, RawOptions& raw);
void add_doctor(CLI::App& app, RawOptions& raw);
void add_secret(CLI::App& app, RawOptions& raw);

// Options shared by several commands.
void add_data(CLI::App& app, RawOptions& raw);
void add_keep(CLI::App& app, RawOptions& raw);
void add_farm(CLI::App& app, RawOptions& raw);
void add_verbosity(CLI::App& app, RawOptions& raw, bool can_be_quiet = true);

}  // namespace bandsaw::coordinator
