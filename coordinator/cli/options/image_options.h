#pragma once

// What the commands that make or judge images can be told.

#include <CLI/CLI.hpp>

#include "coordinator/cli/options/checked_options.h"

namespace bandsaw::coordinator {

// Each adds a command's options.
void add_submit(CLI::App& app, RawOptions& raw);
void add_watch(CLI::App& app, RawOptions& raw);
void add_render(CLI::App& app, RawOptions& raw);
void add_info(CLI::App& app, RawOptions& raw);
void add_stitch(CLI::App& app, RawOptions& raw);
void add_compare(CLI::App& app, RawOptions& raw);

}  // namespace bandsaw::coordinator
