#pragma once

#include <string>

#include "absl/strings/string_view.h"

namespace bandsaw::worker {

/// Returns the text as a JSON string, with its quotation marks. `text` MUST be UTF-8.
std::string json_text(absl::string_view text);

}  // namespace bandsaw::worker
