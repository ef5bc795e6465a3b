// Keeps for each row the ranges of samples that the parts have, in ascending order. Parts fit
// together if no ranges overlap and all rows have the samples 0 to N - 1 for the same N.

#include "coordinator/cli/image/stitch_coverage.h"

#include <algorithm>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {

absl::Status StitchCoverage::add(const std::string& part, const Band& band) {
  parts_.push_back(part);
  const std::size_t index = parts_.size() - 1;
  for (std::uint32_t row = band.rows.first; row < band.rows.last; ++row) {
    std::vector<Piece>& pieces = rows_[row];
    const auto at = std::find_if(pieces.begin(), pieces.end(), [&](const Piece& p) {
      return p.samples.last > band.samples.first;
    });
    if (at != pieces.end() && at->samples.first < band.samples.last) {
      return absl::InvalidArgumentError(absl::StrCat("row ", row, " is in both ", parts_[at->part],
                                                     " and ", part, ": leave one out"));
    }
    pieces.insert(at, Piece{band.samples, index});
  }
  return absl::OkStatus();
}

absl::StatusOr<std::uint64_t> StitchCoverage::samples_of_row(std::size_t row) const {
  std::uint64_t end = 0;
  for (const Piece& piece : rows_[row]) {
    if (piece.samples.first != end) {
      return absl::InvalidArgumentError(absl::StrCat("row ", row, " lacks the samples ", end, ":",
                                                     piece.samples.first, " (", parts_[piece.part],
                                                     " begins after them)"));
    }
    end = piece.samples.last;
  }
  return end;
}

absl::StatusOr<std::uint64_t> StitchCoverage::samples() const {
  std::vector<std::string> missing;
  for (std::size_t row = 0; row < rows_.size();) {
    std::size_t end = row;
    while (end < rows_.size() && rows_[end].empty()) {
      ++end;
    }
    if (end > row) {
      missing.push_back(absl::StrCat(row, ":", end));
    }
    row = end + 1;
  }
  if (!missing.empty()) {
    return absl::InvalidArgumentError(absl::StrCat("rows ", absl::StrJoin(missing, ", "),
                                                   " are in no part: render them with --rows ",
                                                   missing.front()));
  }
  std::uint64_t samples = 0;
  for (std::size_t row = 0; row < rows_.size(); ++row) {
    ASSIGN_OR_RETURN(const std::uint64_t here, samples_of_row(row));
    if (row > 0 && here != samples) {
      return absl::InvalidArgumentError(absl::StrCat(
          "parts have different numbers of samples: ", parts_[rows_[row - 1].front().part], " has ",
          samples, ", ", parts_[rows_[row].front().part], " has ", here,
          "; render all with the same --samples"));
    }
    samples = here;
  }
  return samples;
}

}  // namespace bandsaw::coordinator
