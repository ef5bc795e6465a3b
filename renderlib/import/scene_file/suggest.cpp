// did_you_mean() finds the known name with the smallest edit distance from a name, ignoring case.
// It returns the end of an error message that suggests this name.

#include "renderlib/import/scene_file/suggest.h"

#include <algorithm>
#include <numeric>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"

namespace bandsaw {
namespace {

// Returns the Levenshtein distance of two words, computed row by row.
std::size_t distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t changed = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({changed, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row[b.size()];
}

}  // namespace

std::string did_you_mean(const std::string& name, const std::vector<std::string>& known) {
  constexpr std::size_t kMaxLength = 100;  // longer names are not searched
  if (name.size() > kMaxLength) {
    return "";
  }
  // Only a name at a smaller distance than `best` is suggested.
  std::size_t best = std::max<std::size_t>(1, name.size() / 3) + 1;
  const std::string* nearest = nullptr;
  for (const std::string& candidate : known) {
    if (candidate.size() > kMaxLength) {
      continue;
    }
    const std::size_t far = distance(absl::AsciiStrToLower(name), absl::AsciiStrToLower(candidate));
    if (far < best) {
      best = far;
      nearest = &candidate;
    }
  }
  return nearest == nullptr ? "" : absl::StrCat("; did you mean \"", *nearest, "\"?");
}

}  // namespace bandsaw
