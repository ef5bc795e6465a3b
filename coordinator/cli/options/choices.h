#pragma once

// Options that take one of a few words: what the words are, for errors, help and shells.

#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "renderlib/render/kernel.h"

namespace bandsaw::coordinator {

/// The words that an option ("--tone") or an argument ("role") takes; empty: anything.
std::vector<std::string> choices_of(const std::string& name);

/// What --kernel chooses; null: nothing, when the fastest is taken. INVALID_ARGUMENT: this machine
/// runs no kernel of that name.
absl::StatusOr<const Kernel*> chosen_kernel(const std::optional<std::string>& name);

/// "none or filmic".
std::string one_of(const std::vector<std::string>& words);

/// INVALID_ARGUMENT: "--tone: must be none or filmic, is 'flimic'; did you mean filmic?" `called`:
/// how the error calls it.
absl::Status wrong_choice(const std::string& called, const std::string& name,
                          const std::string& text);
inline absl::Status wrong_choice(const std::string& option, const std::string& text) {
  return wrong_choice(option, option, text);
}

}  // namespace bandsaw::coordinator
