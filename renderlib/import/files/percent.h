#pragma once

#include <string>

#include "absl/strings/string_view.h"

namespace bandsaw {

/// A URI's path as a file name: %20 becomes a space (RFC 3986, 2.1). What is no escape stays.
std::string percent_decoded(absl::string_view text);

}  // namespace bandsaw
