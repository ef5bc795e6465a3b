#pragma once

// Parses the lines about bands in a worker's log: "rendered job=7 rows=0:12 samples=0:16", "stored
// job=7 …".

#include <cstdint>
#include <string>
#include <vector>

namespace bandsaw::test {

/// A band: rows [first_row, last_row) with samples [first_sample, last_sample) of each pixel.
struct LoggedBand {
  std::uint64_t job = 0;
  std::uint32_t first_row = 0;
  std::uint32_t last_row = 0;
  std::uint64_t first_sample = 0;
  std::uint64_t last_sample = 0;

  /// Whether both bands have the same sample of any pixel.
  bool overlaps(const LoggedBand& other) const {
    return job == other.job && first_row < other.last_row && other.first_row < last_row &&
           first_sample < other.last_sample && other.first_sample < last_sample;
  }
};

/// Returns the bands of the lines with this verb, in order. A worker's log has the verbs "rendered"
/// (all pixels of the band are computed) and "stored" (they are on the coordinator's disk).
std::vector<LoggedBand> logged_bands(const std::string& log, const std::string& verb);

}  // namespace bandsaw::test
