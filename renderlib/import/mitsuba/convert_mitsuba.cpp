#include "renderlib/import/mitsuba/convert_mitsuba.h"

#include "absl/strings/str_cat.h"

namespace bandsaw {

absl::StatusOr<ConvertedScene> convert_mitsuba(const ForeignScene& from) {
  return absl::UnimplementedError(absl::StrCat(from.name, ": is not read yet"));
}

}  // namespace bandsaw
