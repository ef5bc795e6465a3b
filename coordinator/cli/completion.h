#pragma once

// Shell completion, generated from the table of commands.

#include <CLI/CLI.hpp>
#include <string>

namespace bandsaw::coordinator {

/// Returns a script for bash that completes commands, their options, the words that options accept
/// (cli/options/choices.h), and file names where a file is expected.
std::string bash_completion(const CLI::App& app);

}  // namespace bandsaw::coordinator
