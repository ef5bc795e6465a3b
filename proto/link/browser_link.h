#pragma once

// The secret of the link by which browsers join a farm as workers (role `browser`), and the time
// when the link ends. Both are in a file of their own in the coordinator's data folder (mode 0600),
// because the link is made and revoked while the farm's identity (identity.h) stays.

#include <optional>
#include <string>

#include "absl/status/statusor.h"

namespace bandsaw::link {

struct BrowserLink {
  std::string secret;      ///< base64url, 22 characters
  double ends_unix_s = 0;  ///< seconds since 1970, UTC
};

/// Loads `folder`/browsers; std::nullopt: no link was made, or it was revoked. DATA_LOSS: the file
/// cannot be parsed.
absl::StatusOr<std::optional<BrowserLink>> load_browser_link(const std::string& folder);

/// Writes the file. If that fails, the previous file is kept.
absl::Status write_browser_link(const std::string& folder, const BrowserLink& link);

/// Removes the file, if there is one.
absl::Status remove_browser_link(const std::string& folder);

}  // namespace bandsaw::link
