#pragma once

// Names of the files that commands write: their defaults, and the place for the number of a frame.

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "absl/strings/match.h"

namespace bandsaw::coordinator {

/// Returns true if the name ends in .band (any case). Such a file is no picture: it has the sums of
/// the samples of some rows (`render --rows`), which `stitch` joins.
inline bool is_part_name(const std::string& path) {
  return absl::EndsWithIgnoreCase(path, ".band");
}

/// Returns the default name of an output in the current folder, made of the scene's name and the
/// suffix: "scenes/cornell.textproto", ".png" -> "cornell.png".
inline std::string default_output(const std::string& scene, const std::string& suffix) {
  return std::filesystem::path(scene).stem().string() + suffix;
}

/// Replaces the last run of '#' in the name of the file (not of its folder) by the number of a
/// frame, with zeros in front: "walk.####.exr", 7 -> "walk.0007.exr". A longer number is not cut. A
/// name without '#' is returned unchanged.
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
