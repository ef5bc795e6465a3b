#pragma once

// Decodes file names in percent-encoding, the encoding of the URIs by which models name files.

#include <string>

#include "absl/strings/string_view.h"

namespace bandsaw {

/// Returns a URI's path as a file name: %20 becomes a space (RFC 3986, 2.1). Invalid escapes stay
/// unchanged.
std::string percent_decoded(absl::string_view text);

}  // namespace bandsaw
