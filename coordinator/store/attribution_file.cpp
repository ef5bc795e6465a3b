// Writes and reads which worker rendered which rows, as text fields. The first field is the number
// of pieces. Then each piece has its first row, the row after its last row, and its worker.

#include "coordinator/store/attribution_file.h"

#include <span>

#include "absl/strings/str_cat.h"
#include "coordinator/store/fields.h"
#include "renderlib/base/atomic_file.h"
#include "renderlib/base/file.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/render/settings.h"

namespace bandsaw::coordinator {
namespace {

/// Limit of a file's size. It is more than the tallest image needs if each of its rows is by a
/// different worker with a name of the maximum length.
constexpr std::uint64_t kMaxBytes = std::uint64_t{1} << 26;

}  // namespace

absl::Status write_attribution(const std::vector<RowsBy>& attribution, const std::string& path) {
  FieldWriter fields;
  fields.number("pieces", attribution.size());
  for (const RowsBy& by : attribution) {
    fields.number("first", by.rows.first);
    fields.number("last", by.rows.last);
    fields.text("worker", by.worker);
  }
  const std::string text = fields.take();
  return write_file_atomically(path, std::as_bytes(std::span(text)));
}

absl::StatusOr<std::vector<RowsBy>> read_attribution(const std::string& path) {
  ASSIGN_OR_RETURN(const std::string text, read_whole_file(path, kMaxBytes));
  FieldReader fields(text);
  const std::uint64_t pieces = fields.number("pieces", kMaxSide);
  std::vector<RowsBy> attribution;
  std::uint64_t before = 0;
  for (std::uint64_t i = 0; i < pieces; ++i) {
    const std::uint64_t first = fields.number("first", kMaxSide);
    const std::uint64_t last = fields.number("last", kMaxSide);
    if (first < before || last <= first) {
      fields.refuse(absl::StrCat("rows ", first, " to ", last, " cannot follow row ", before));
      break;
    }
    attribution.push_back({{static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(last)},
                           fields.text("worker")});
    before = last;
  }
  if (const absl::Status status = fields.finish(); !status.ok()) {
    return absl::DataLossError(absl::StrCat(path, " is damaged: ", status.message()));
  }
  return attribution;
}

}  // namespace bandsaw::coordinator
