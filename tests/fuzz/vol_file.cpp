// Fuzz target (fuzz.h): a *.vol file of Mitsuba, a grid of numbers in a box that gives the density
// of a medium. What is accepted must be a valid grid.

#include <span>

#include "renderlib/base/check.h"
#include "renderlib/import/volume/volume_file.h"
#include "tests/fuzz/fuzz.h"

void bandsaw::fuzz::run(absl::Span<const std::uint8_t> input) {
  const auto bytes = std::as_bytes(std::span(input.data(), input.size()));
  const auto read = read_vol({bytes.data(), bytes.size()});
  if (!read.ok()) {
    return;
  }
  const absl::StatusOr<float> checked = check_grid(read->grid);
  // The file's box may be so flat that `to_medium` has no inverse. The reader of scene files checks
  // the box later.
  BANDSAW_CHECK(checked.ok() || !inverse(read->grid.to_medium),
                checked.status().ToString().c_str());
}
