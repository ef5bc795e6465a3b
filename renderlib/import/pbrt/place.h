#pragma once

// Places in the files of a pbrt scene, for errors and warnings.

#include <string>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"

namespace bandsaw::pbrt {

struct Place {
  std::string file;  ///< name, relative to the scene's folder: "kitchen.pbrt"
  int line = 0;      ///< from 1
};

inline std::string text_of(const Place& place) { return absl::StrCat(place.file, ":", place.line); }

/// Returns INVALID_ARGUMENT: "kitchen.pbrt:17: <what>".
inline absl::Status error_at(const Place& place, absl::string_view what) {
  return absl::InvalidArgumentError(absl::StrCat(text_of(place), ": ", what));
}

}  // namespace bandsaw::pbrt
