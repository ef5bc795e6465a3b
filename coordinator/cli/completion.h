#pragma once

// Generates the script by which a shell completes commands and options, for `bandsaw completion`.

#include <CLI/CLI.hpp>
#include <string>

namespace bandsaw::coordinator {

/// Returns a script for bash that completes commands, their options, the words that options accept
/// (cli/options/choices.h), and file names where a file is expected. `app`: the parser with all
/// commands and options.
std::string bash_completion(const CLI::App& app);

}  // namespace bandsaw::coordinator
