// Fuzz target (fuzz.h): join strings, which contain the addresses, the certificate's digest and the
// secret of a farm.

#include "proto/link/join.h"

#include "renderlib/base/check.h"
#include "tests/fuzz/fuzz.h"

void bandsaw::fuzz::run(absl::Span<const std::uint8_t> input) {
  const absl::StatusOr<link::JoinString> join = link::parse_join_string(text(input));
  if (!join.ok()) {
    return;
  }
  const absl::StatusOr<link::JoinString> again = link::parse_join_string(join->text());
  BANDSAW_CHECK(again.ok() && again->text() == join->text(),
                "a join string is written and read unchanged");
}
