#pragma once

// Overlap of bands (ranges of rows and samples of one job), and their names in messages.

#include <string>

#include "absl/strings/str_cat.h"
#include "renderlib/render/band.h"

namespace bandsaw::coordinator {

/// Returns true if the bands have a sample of a row in common.
inline bool overlap(const Band& a, const Band& b) {
  return a.samples.first < b.samples.last && b.samples.first < a.samples.last &&
         a.rows.first < b.rows.last && b.rows.first < a.rows.last;
}

/// Returns for example "rows 0–16 of samples 0–32"; the ends are exclusive.
inline std::string name_of(const Band& band) {
  return absl::StrCat("rows ", band.rows.first, "–", band.rows.last, " of samples ",
                      band.samples.first, "–", band.samples.last);
}

}  // namespace bandsaw::coordinator
