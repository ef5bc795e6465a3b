#pragma once

// Which rows and samples the parts of an image bring, and what is missing or there twice.

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "renderlib/render/band.h"

namespace bandsaw::coordinator {

class StitchCoverage {
 public:
  explicit StitchCoverage(std::uint32_t height) : rows_(height) {}

  /// `part`: the file's name. INVALID_ARGUMENT: samples of one of its rows are there already; names
  /// both files.
  absl::Status add(const std::string& part, const Band& band);

  /// The samples a pixel. INVALID_ARGUMENT: rows are missing (all of them named), a row lacks
  /// samples, or rows have different numbers of samples.
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
