#include "renderlib/import/pbrt/convert_pbrt.h"

#include "absl/strings/str_cat.h"

namespace bandsaw {

absl::StatusOr<ConvertedScene> convert_pbrt(const ForeignScene& from) {
  return absl::UnimplementedError(absl::StrCat(from.name, ": is not read yet"));
}

}  // namespace bandsaw
