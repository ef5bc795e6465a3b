#pragma once

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "absl/strings/match.h"

namespace bandsaw::coordinator {

/// Returns true if the name ends in .band (any case): a file with the sums of some rows instead of
/// a picture.
inline bool is_part_name(const std::string& path) {
  return absl::EndsWithIgnoreCase(path, ".band");
}

/// Returns the default file name: the scene's stem in the current folder. From
/// "scenes/cornell.textproto" and ".png" follows "cornell.png".
inline std::string default_output(const std::string& scene, const std::string& suffix) {
  return std::filesystem::path(scene).stem().string() + suffix;
}

/// Replaces the last run of '#' in the name of the file by the number of a frame, with zeros in
/// front: "walk.####.exr", 7 -> "walk.0007.exr". Unchanged without '#'.
inline std::string name_of_frame(const std::string& path, std::int64_t frame) {
  const std::size_t last = path.rfind('#');
  const std::size_t folder = path.rfind('/');
  if (last == std::string::npos || (folder != std::string::npos && folder > last)) {
    return path;
  }
  const std::size_t before = path.find_last_not_of('#', last);
  const std::size_t first = before == std::string::npos ? 0 : before + 1;
  std::string number = std::to_string(std::abs(frame));
  number.insert(0, last + 1 - first > number.size() ? last + 1 - first - number.size() : 0, '0');
  return path.substr(0, first) + (frame < 0 ? "-" : "") + number + path.substr(last + 1);
}

/// Returns true if the name of the file has a place for the number of a frame.
inline bool has_frame_place(const std::string& path) { return name_of_frame(path, 0) != path; }

}  // namespace bandsaw::coordinator
