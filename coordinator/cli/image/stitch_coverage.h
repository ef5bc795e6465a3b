#pragma once

// Determines which rows and samples the parts of an image contain, and what is missing or
// duplicate.

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "renderlib/render/band.h"

namespace bandsaw::coordinator {

class StitchCoverage {
 public:
  explicit StitchCoverage(std::uint32_t height) : rows_(height) {}

  /// Adds a band. `part`: the file's name. INVALID_ARGUMENT: samples of one of its rows were added
  /// before; the message names both files.
  absl::Status add(const std::string& part, const Band& band);

  /// Returns the samples per pixel. INVALID_ARGUMENT: rows are missing (the message lists all), a
  /// row lacks samples, or rows have different numbers of samples.
  absl::StatusOr<std::uint64_t> samples() const;

 private:
  struct Piece {
    SampleRange samples;
    std::size_t part = 0;
  };
  absl::StatusOr<std::uint64_t> samples_of_row(std::size_t row) const;

  std::vector<std::string> parts_;
  std::vector<std::vector<Piece>> rows_;  // each sorted by samples, without overlaps
};

}  // namespace bandsaw::coordinator
