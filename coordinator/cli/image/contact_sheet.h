#pragma once

// A picture with the frames of a sequence, small, each above its number.

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "renderlib/image/display.h"
#include "renderlib/image/image.h"

namespace bandsaw::coordinator {

/// Maximum number of frames on a contact sheet. If a sequence has more, this many are shown, at
/// equal distances.
inline constexpr std::size_t kMaxSheetFrames = 400;

class ContactSheet {
 public:
  /// `numbers` of all frames, ascending, at least one. `width` and `height` of a frame in pixels.
  ContactSheet(const std::vector<std::int64_t>& numbers, std::uint32_t width, std::uint32_t height);

  /// Returns true if the sheet shows this frame.
  bool shows(std::int64_t number) const { return cells_.contains(number); }
  /// Adds a frame that the sheet shows, as an 8-bit file shows it.
  void add(std::int64_t number, const Image& image, const Display& display);
  /// Returns the sheet, whose values are those that are displayed. Frames that were not added are
  /// crossed out.
  Image picture() const;

 private:
  void draw_frame(Image& sheet, std::size_t cell, const Image& frame) const;
  void draw_number(Image& sheet, std::size_t cell, std::int64_t number) const;

  std::map<std::int64_t, Image> cells_;  ///< small frames; without pixels: not added
  std::uint32_t columns_ = 1;
  std::uint32_t cell_width_ = 1;  ///< pixels of a small frame
  std::uint32_t cell_height_ = 1;
};

}  // namespace bandsaw::coordinator
