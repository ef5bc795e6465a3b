#pragma once

// Words for a shell to complete, made of the table of commands itself.

#include <CLI/CLI.hpp>
#include <string>

namespace bandsaw::coordinator {

/// A script for bash: commands, their options, the words that options take (cli/options/choices.h),
/// and files where a file is meant.
std::string bash_completion(const CLI::App& app);

}  // namespace bandsaw::coordinator
