#pragma once

// Some options, such as --tone, accept one of a few words. The functions of this file return the
// words, for error messages, help and shell completion, and check a word that the user typed.

#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "coordinator/cli/options/options.h"
#include "renderlib/render/kernel.h"

namespace bandsaw::coordinator {

/// Returns the words that an option ("--tone") or an argument ("role") accepts; empty: it accepts
/// any text.
std::vector<std::string> choices_of(const std::string& name);

/// Returns the kernel (the renderer's code for one instruction set) that --kernel names. If the
/// option is not given, returns nullptr, which stands for the fastest kernel. INVALID_ARGUMENT:
/// there is no kernel of that name, or this machine cannot run it.
absl::StatusOr<const Kernel*> chosen_kernel(const std::optional<std::string>& name);

/// Parses the names of layers, such as "albedo,normal,depth,samples". INVALID_ARGUMENT: a name is
/// unknown or repeated.
absl::StatusOr<std::vector<LayerKind>> parse_layers(const std::string& list);

/// Joins the words to a phrase: "none or filmic".
std::string one_of(const std::vector<std::string>& words);

/// Makes the error for a text that an option or argument does not accept. Always returns
/// INVALID_ARGUMENT, without checking `text`. `called`: how the message calls the option. `name`:
/// the option or argument, as choices_of() takes it. `text`: what the user typed. The message is,
/// for example, "--tone: must be none or filmic, is 'flimic'; did you mean filmic?"
absl::Status wrong_choice(const std::string& called, const std::string& name,
                          const std::string& text);
/// Makes the error for an option that the message calls by its name.
inline absl::Status wrong_choice(const std::string& option, const std::string& text) {
  return wrong_choice(option, option, text);
}

}  // namespace bandsaw::coordinator
