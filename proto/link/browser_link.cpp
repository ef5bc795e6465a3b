// The link for browsers is kept in the file `browsers` of the data folder. Only the owner of the
// file can read it. The file has a heading, the secret of the link, and the time when the link
// ends.

#include "proto/link/browser_link.h"

#include <unistd.h>

#include <cerrno>
#include <vector>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_split.h"
#include "proto/link/private_file.h"
#include "proto/link/random.h"

namespace bandsaw::link {
namespace {

constexpr char kLinkHeading[] = "bandsaw-browsers 1";

std::string file_of(const std::string& folder) { return folder + "/browsers"; }

}  // namespace

absl::StatusOr<std::optional<BrowserLink>> load_browser_link(const std::string& folder) {
  const absl::StatusOr<std::string> text = read_private_file(file_of(folder));
  if (absl::IsNotFound(text.status())) {
    return std::nullopt;
  }
  if (!text.ok()) {
    return text.status();
  }
  const std::vector<std::string> words = absl::StrSplit(*text, absl::ByAnyChar("\n "));
  BrowserLink link;
  // heading (two words), "secret", the secret, "ends", the time, and the end of the last line
  if (words.size() != 7 || absl::StrCat(words[0], " ", words[1]) != kLinkHeading ||
      words[2] != "secret" || words[3].size() != kSecretLength || words[4] != "ends" ||
      !absl::SimpleAtod(words[5], &link.ends_unix_s)) {
    return absl::DataLossError(absl::StrCat(file_of(folder),
                                            ": the link for browsers is damaged; remove the file, "
                                            "and make a new link with `bandsaw link`"));
  }
  link.secret = words[3];
  return link;
}

absl::Status write_browser_link(const std::string& folder, const BrowserLink& link) {
  return write_private_file(
      file_of(folder),
      absl::StrFormat("%s\nsecret %s\nends %.3f\n", kLinkHeading, link.secret, link.ends_unix_s));
}

absl::Status remove_browser_link(const std::string& folder) {
  const std::string file = file_of(folder);
  return unlink(file.c_str()) == 0 || errno == ENOENT
             ? absl::OkStatus()
             : absl::ErrnoToStatus(errno, absl::StrCat("cannot remove ", file));
}

}  // namespace bandsaw::link
