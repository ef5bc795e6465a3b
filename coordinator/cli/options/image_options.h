#pragma once

// Options of the commands that make or examine images.

#include <CLI/CLI.hpp>

#include "coordinator/cli/options/checked_options.h"

namespace bandsaw::coordinator {

// Each function adds a command's options.
void add_submit(CLI::App& app, RawOptions& raw);
void add_watch(CLI::App& app, RawOptions& raw);
void add_render(CLI::App& app, RawOptions& raw);
void add_info(CLI::App& app, RawOptions& raw);
void add_import(CLI::App& app, RawOptions& raw);
void add_stitch(CLI::App& app, RawOptions& raw);
void add_compare(CLI::App& app, RawOptions& raw);

}  // namespace bandsaw::coordinator
