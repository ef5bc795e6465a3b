#pragma once

// Options that accept one of a few words: the words, for error messages, help and shell completion.

#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "coordinator/cli/options/options.h"
#include "renderlib/render/kernel.h"

namespace bandsaw::coordinator {

/// Returns the words that an option ("--tone") or an argument ("role") accepts; empty: anything.
std::vector<std::string> choices_of(const std::string& name);

/// Returns the kernel that --kernel names; nullptr if the option is not given, which stands for the
/// fastest. INVALID_ARGUMENT: this machine runs no kernel of that name.
absl::StatusOr<const Kernel*> chosen_kernel(const std::optional<std::string>& name);

/// Parses a list such as "albedo,normal,depth,samples", each at most once. INVALID_ARGUMENT:
/// unknown or repeated name.
absl::StatusOr<std::vector<LayerKind>> parse_layers(const std::string& list);

/// Joins the words to a phrase: "none or filmic".
std::string one_of(const std::vector<std::string>& words);

/// INVALID_ARGUMENT: "--tone: must be none or filmic, is 'flimic'; did you mean filmic?" `called`
/// is the name used in the message.
absl::Status wrong_choice(const std::string& called, const std::string& name,
                          const std::string& text);
inline absl::Status wrong_choice(const std::string& option, const std::string& text) {
  return wrong_choice(option, option, text);
}

}  // namespace bandsaw::coordinator
