// Reads the bands out of a worker's log with a regular expression.

#include "tests/farm/band_log.h"

#include <regex>

namespace bandsaw::test {

std::vector<LoggedBand> logged_bands(const std::string& log, const std::string& verb) {
  const std::regex line("\\b" + verb + " job=(\\d+) rows=(\\d+):(\\d+) samples=(\\d+):(\\d+)");
  std::vector<LoggedBand> bands;
  for (std::sregex_iterator at(log.begin(), log.end(), line), end; at != end; ++at) {
    const std::smatch& m = *at;
    bands.push_back({std::stoull(m[1]), static_cast<std::uint32_t>(std::stoul(m[2])),
                     static_cast<std::uint32_t>(std::stoul(m[3])), std::stoull(m[4]),
                     std::stoull(m[5])});
  }
  return bands;
}

}  // namespace bandsaw::test
