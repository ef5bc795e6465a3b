#pragma once

// Determines which rows and samples of an image are in none of its parts, or in two parts. The
// command `bandsaw stitch` uses it.

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "renderlib/render/band.h"

namespace bandsaw::coordinator {

class StitchCoverage {
 public:
  /// `height`: number of rows of the image.
  explicit StitchCoverage(std::uint32_t height) : rows_(height) {}

  /// Adds a band (a range of rows and a range of samples) of the file `part`. INVALID_ARGUMENT:
  /// samples of one of its rows were added before; the message names both files. The rows MUST be
  /// within the image.
  absl::Status add(const std::string& part, const Band& band);

  /// Returns the number of samples per pixel of the whole image. INVALID_ARGUMENT: rows are missing
  /// (the message lists all), a row lacks samples, or rows have different numbers of samples.
  absl::StatusOr<std::uint64_t> samples() const;

 private:
  /// The samples of one row that a part has.
  struct Piece {
    SampleRange samples;
    std::size_t part = 0;  ///< index into parts_
  };
  /// Returns the number of samples of a row. INVALID_ARGUMENT: samples before the last one are
  /// missing.
  absl::StatusOr<std::uint64_t> samples_of_row(std::size_t row) const;

  std::vector<std::string> parts_;        // the file of each band, in the order of add()
  std::vector<std::vector<Piece>> rows_;  // each sorted by samples, without overlaps
};

}  // namespace bandsaw::coordinator
