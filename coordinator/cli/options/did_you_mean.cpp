// did_you_mean() returns the known word with the smallest edit distance from the typed one. The
// distance may be at most a third of the length of the typed word, but 1 is always allowed.

#include "coordinator/cli/options/did_you_mean.h"

#include <algorithm>
#include <cstddef>

namespace bandsaw::coordinator {
namespace {

// Returns the optimal string alignment distance, computed by dynamic programming. It is the edit
// distance of Damerau (1964), except that no place is edited twice. d[i][j] is the distance between
// the first i letters of a and the first j letters of b.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) {
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        d[i][j] = i + j;
        continue;
      }
      const std::size_t replace = d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, replace});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
      }
    }
  }
  return d[a.size()][b.size()];
}

}  // namespace

std::optional<std::string> did_you_mean(const std::string& word,
                                        const std::vector<std::string>& known) {
  // Longer than all known words; bounds the time of edit_distance().
  constexpr std::size_t kMaxWord = 64;
  if (word.size() > kMaxWord) {
    return std::nullopt;
  }
  std::optional<std::string> best;
  std::size_t least = std::max<std::size_t>(1, word.size() / 3) + 1;
  for (const std::string& candidate : known) {
    if (const std::size_t distance = edit_distance(word, candidate); distance < least) {
      least = distance;
      best = candidate;
    }
  }
  return best;
}

}  // namespace bandsaw::coordinator
