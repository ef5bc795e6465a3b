// Fuzz target (fuzz.h): a record of the coordinator's journal, the file from which a restarted
// coordinator rebuilds its state. The first line of the input is the kind of the record, and the
// rest is the text of the record's fields.

#include "coordinator/store/record_text.h"
#include "renderlib/base/check.h"
#include "tests/fuzz/fuzz.h"

void bandsaw::fuzz::run(absl::Span<const std::uint8_t> input) {
  const std::string all = text(input);
  const std::size_t end = all.find('\n');
  if (end == std::string::npos) {
    return;
  }
  const auto record =
      coordinator::from_text({.kind = all.substr(0, end), .fields = all.substr(end + 1)});
  if (!record.ok()) {
    return;
  }
  const coordinator::RecordText written = coordinator::to_text(*record);
  const auto again = coordinator::from_text(written);
  BANDSAW_CHECK(again.ok() && coordinator::to_text(*again) == written,
                "a record is written and read unchanged");
}
