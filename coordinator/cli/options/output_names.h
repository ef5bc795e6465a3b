#pragma once

#include <filesystem>
#include <string>

#include "absl/strings/match.h"

namespace bandsaw::coordinator {

/// True if the name ends in .band (any case): a file with the sums of some rows instead of a
/// picture.
inline bool is_part_name(const std::string& path) {
  return absl::EndsWithIgnoreCase(path, ".band");
}

/// Returns the default file name: the scene's stem in the current folder.
/// "scenes/cornell.textproto", ".png" -> "cornell.png".
inline std::string default_output(const std::string& scene, const std::string& suffix) {
  return std::filesystem::path(scene).stem().string() + suffix;
}

}  // namespace bandsaw::coordinator
