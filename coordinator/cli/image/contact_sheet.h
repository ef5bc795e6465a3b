#pragma once

// A contact sheet is one picture that shows the frames of a sequence, each reduced in size, with
// its number below it, for --contact-sheet of `submit` and `watch`.

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "renderlib/image/display.h"
#include "renderlib/image/image.h"

namespace bandsaw::coordinator {

/// Maximum number of frames on a contact sheet. Of a longer sequence, the sheet shows
/// kMaxSheetFrames evenly spaced frames.
inline constexpr std::size_t kMaxSheetFrames = 400;

class ContactSheet {
 public:
  /// `numbers`: the numbers of all frames, ascending, at least one. `width`, `height`: the size of
  /// a frame in pixels, above 0.
  ContactSheet(const std::vector<std::int64_t>& numbers, std::uint32_t width, std::uint32_t height);

  /// Returns true if the sheet shows this frame.
  bool shows(std::int64_t number) const { return cells_.contains(number); }
  /// Adds a frame with the brightness that an 8-bit file of it has. Ignores a frame that the sheet
  /// does not show.
  void add(std::int64_t number, const Image& image, const Display& display);
  /// Returns the sheet, in linear values that are displayed without exposure and tone. Frames that
  /// were not added are crossed out.
  Image picture() const;

 private:
  /// `cell`: index of the frame's place on the sheet, row by row. `frame`: the reduced frame; if it
  /// has no pixels, a cross is drawn.
  void draw_frame(Image& sheet, std::size_t cell, const Image& frame) const;
  void draw_number(Image& sheet, std::size_t cell, std::int64_t number) const;

  std::map<std::int64_t, Image> cells_;  ///< reduced frames by number; no pixels: not added
  std::uint32_t columns_ = 1;            ///< number of frames in a row
  std::uint32_t cell_width_ = 1;         ///< size of a reduced frame in pixels
  std::uint32_t cell_height_ = 1;
};

}  // namespace bandsaw::coordinator
