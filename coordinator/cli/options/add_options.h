#pragma once

// Adds the options of the commands to the parser. They are parsed into RawOptions, from which
// cli/options/checked_options.h and the functions below make checked options.

#include <CLI/CLI.hpp>

#include "coordinator/cli/options/checked_options.h"

namespace bandsaw::coordinator {

// Options shared by several commands.
void add_data(CLI::App& app, RawOptions& raw);
void add_keep(CLI::App& app, RawOptions& raw);
void add_farm(CLI::App& app, RawOptions& raw);
void add_verbosity(CLI::App& app, RawOptions& raw, bool can_be_quiet = true);

// Administration (admin_options.cpp). Here and below, each function adds a command's options.
void add_serve(CLI::App& app, RawOptions& raw);
void add_logs(CLI::App& app, RawOptions& raw);
void add_quarantine(CLI::App& app, RawOptions& raw);
void add_doctor(CLI::App& app, RawOptions& raw);
void add_secret(CLI::App& app, RawOptions& raw);
void add_link(CLI::App& app, RawOptions& raw);

// Commands that make or examine images (image_options.cpp).
void add_submit(CLI::App& app, RawOptions& raw);
void add_watch(CLI::App& app, RawOptions& raw);
void add_render(CLI::App& app, RawOptions& raw);
void add_info(CLI::App& app, RawOptions& raw);
void add_import(CLI::App& app, RawOptions& raw);
void add_stitch(CLI::App& app, RawOptions& raw);
void add_compare(CLI::App& app, RawOptions& raw);

// Workers on other machines (machines/invite_options.cpp). The checks return INVALID_ARGUMENT if an
// option is wrong or missing.
void add_invite(CLI::App& app, RawOptions& raw);
void add_dismiss(CLI::App& app, RawOptions& raw);
absl::StatusOr<Command> checked_invite(const RawOptions& raw);
absl::StatusOr<Command> checked_dismiss(const RawOptions& raw);

// Studies (study/study_options.cpp). The check returns INVALID_ARGUMENT if an option is wrong.
void add_study(CLI::App& app, RawOptions& raw);
absl::StatusOr<Command> checked_study(const RawOptions& raw);

}  // namespace bandsaw::coordinator
