#pragma once

// The functions add_X() add the options of command X to the parser (CLI11), which stores their
// texts in RawOptions. The functions checked_X(), here and in cli/options/checked_options.h,
// convert these texts to checked options. cli/command_line.cpp calls both.

#include <CLI/CLI.hpp>

#include "coordinator/cli/options/checked_options.h"

namespace bandsaw::coordinator {

// Options that several commands have. add_keep() adds --keep-days, --keep-size and --keep-jobs.
// add_verbosity() adds --json and, if `can_be_quiet`, --quiet.
void add_data(CLI::App& app, RawOptions& raw);
void add_keep(CLI::App& app, RawOptions& raw);
void add_farm(CLI::App& app, RawOptions& raw);
void add_verbosity(CLI::App& app, RawOptions& raw, bool can_be_quiet = true);

// Commands that control a farm and its machines (admin_options.cpp).
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

// Commands for workers on other machines (machines/invite_options.cpp). The checks return
// INVALID_ARGUMENT if an option is wrong or missing.
void add_invite(CLI::App& app, RawOptions& raw);
void add_dismiss(CLI::App& app, RawOptions& raw);
absl::StatusOr<Command> checked_invite(const RawOptions& raw);
absl::StatusOr<Command> checked_dismiss(const RawOptions& raw);

// The command that measures error against time (study/study_options.cpp). The check returns
// INVALID_ARGUMENT if an option is wrong.
void add_study(CLI::App& app, RawOptions& raw);
absl::StatusOr<Command> checked_study(const RawOptions& raw);

}  // namespace bandsaw::coordinator
