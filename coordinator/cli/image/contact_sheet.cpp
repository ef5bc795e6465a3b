// Draws a contact sheet, one picture of all frames of a sequence. The number of columns is chosen
// so that the sheet has about the shape of a screen. Each frame is reduced to a cell of the sheet.
// The frame's number is drawn below the cell in digits of 3 x 5 dots.

#include "coordinator/cli/image/contact_sheet.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "renderlib/base/check.h"
#include "renderlib/image/shrink.h"

namespace bandsaw::coordinator {
namespace {

constexpr std::uint32_t kSheetWidth = 1'920;  ///< about the width of the sheet in pixels
constexpr std::uint32_t kMaxCell = 320;       ///< largest width of a reduced frame in pixels
constexpr std::uint32_t kGap = 6;             ///< pixels between frames
/// Digits of 3 x 5 dots, drawn with kDot pixels a dot.
constexpr std::uint32_t kDot = 2;
constexpr std::uint32_t kDigitWidth = 3;
constexpr std::uint32_t kDigitHeight = 5;
constexpr std::uint32_t kTextHeight = kDot * kDigitHeight;
constexpr std::array<std::uint16_t, 11> kDigits = {
    // 0 to 9 and the minus sign. Rows from the top, three bits each, the left dot first.
    0b111'101'101'101'111, 0b010'110'010'010'111, 0b111'001'111'100'111, 0b111'001'111'001'111,
    0b101'101'111'001'001, 0b111'100'111'001'111, 0b111'100'111'101'111, 0b111'001'010'010'010,
    0b111'101'111'101'111, 0b111'101'111'001'111, 0b000'000'111'000'000};
constexpr Rgb kPaper{0.02f, 0.02f, 0.02f};  ///< background of the sheet
constexpr Rgb kInk{0.6f, 0.6f, 0.6f};       ///< numbers, and the cross of a missing frame
constexpr Rgb kCross{0.25f, 0.05f, 0.04f};  ///< background of that cross

/// Returns at most `most` of the numbers, evenly spaced. The first and the last are among them.
std::vector<std::int64_t> spread(const std::vector<std::int64_t>& numbers, std::size_t most) {
  if (numbers.size() <= most) {
    return numbers;
  }
  std::vector<std::int64_t> out;
  for (std::size_t i = 0; i < most; ++i) {
    out.push_back(numbers[i * (numbers.size() - 1) / (most - 1)]);
  }
  return out;
}

}  // namespace

ContactSheet::ContactSheet(const std::vector<std::int64_t>& numbers, std::uint32_t width,
                           std::uint32_t height) {
  BANDSAW_CHECK(!numbers.empty() && width > 0 && height > 0, "a sheet shows frames");
  for (const std::int64_t number : spread(numbers, kMaxSheetFrames)) {
    cells_[number] = {};
  }
  // With n frames in c columns, the sheet has the shape c * aspect : n / c, which is to be 16:10.
  const double aspect = static_cast<double>(width) / height;
  const double columns = std::ceil(std::sqrt(static_cast<double>(cells_.size()) * 1.6 / aspect));
  columns_ =
      static_cast<std::uint32_t>(std::clamp(columns, 1.0, static_cast<double>(cells_.size())));
  // A cell is at least 24 pixels wide, unless the frame itself is narrower.
  cell_width_ = std::min({width, kMaxCell, std::max(kSheetWidth / columns_, kGap + 24) - kGap});
  cell_height_ =
      std::max<std::uint32_t>(1, static_cast<std::uint32_t>(std::lround(cell_width_ / aspect)));
}

void ContactSheet::add(std::int64_t number, const Image& image, const Display& display) {
  const auto cell = cells_.find(number);
  if (cell == cells_.end() || image.width == 0 || image.height == 0) {
    return;
  }
  Image bright = image;
  for (Rgb& pixel : bright.pixels) {
    pixel = shown(pixel, display);
  }
  // First reduces the image by an integer factor: each pixel is the mean of a block of pixels. Then
  // takes the nearest pixel, to get the exact size.
  const std::uint32_t factor = std::max<std::uint32_t>(1, image.width / cell_width_);
  const Image near = shrunk(bright, factor, factor);
  Image& small = cell->second;
  small = {.width = cell_width_, .height = cell_height_, .pixels = {}};
  for (std::uint32_t y = 0; y < cell_height_; ++y) {
    for (std::uint32_t x = 0; x < cell_width_; ++x) {
      small.pixels.push_back(near.at(x * near.width / cell_width_, y * near.height / cell_height_));
    }
  }
}

Image ContactSheet::picture() const {
  const auto rows = static_cast<std::uint32_t>((cells_.size() + columns_ - 1) / columns_);
  const std::uint32_t down = cell_height_ + kTextHeight + 2 * kGap;
  Image sheet{
      .width = columns_ * (cell_width_ + kGap) + kGap, .height = rows * down + kGap, .pixels = {}};
  sheet.pixels.assign(std::size_t{sheet.width} * sheet.height, kPaper);
  std::size_t cell = 0;
  for (const auto& [number, frame] : cells_) {
    draw_frame(sheet, cell, frame);
    draw_number(sheet, cell++, number);
  }
  return sheet;
}

void ContactSheet::draw_frame(Image& sheet, std::size_t cell, const Image& frame) const {
  const auto column = static_cast<std::uint32_t>(cell % columns_);
  const auto row = static_cast<std::uint32_t>(cell / columns_);
  const std::uint32_t left = kGap + column * (cell_width_ + kGap);
  const std::uint32_t top = kGap + row * (cell_height_ + kTextHeight + 2 * kGap);
  for (std::uint32_t y = 0; y < cell_height_; ++y) {
    for (std::uint32_t x = 0; x < cell_width_; ++x) {
      // The x at which the diagonal from the upper left corner to the lower right one passes row y.
      const std::uint32_t across = y * cell_width_ / cell_height_;
      const bool on_cross = x == across || x + across + 1 == cell_width_;
      sheet.pixels[std::size_t{top + y} * sheet.width + left + x] = !frame.pixels.empty()
                                                                        ? frame.at(x, y)
                                                                    : on_cross ? kInk
                                                                               : kCross;
    }
  }
}

void ContactSheet::draw_number(Image& sheet, std::size_t cell, std::int64_t number) const {
  const auto column = static_cast<std::uint32_t>(cell % columns_);
  const auto row = static_cast<std::uint32_t>(cell / columns_);
  const std::string text = std::to_string(number);
  std::uint32_t left = kGap + column * (cell_width_ + kGap);
  const std::uint32_t end = left + cell_width_;
  const std::uint32_t top =
      kGap + row * (cell_height_ + kTextHeight + 2 * kGap) + cell_height_ + kGap / 2;
  for (const char c : text) {
    const std::uint16_t digit = kDigits[c == '-' ? 10 : static_cast<std::size_t>(c - '0')];
    for (std::uint32_t y = 0; y < kTextHeight; ++y) {
      for (std::uint32_t x = 0; x < kDot * kDigitWidth && left + x < end; ++x) {
        // A digit has 15 bits; the first dot is the highest.
        const std::uint32_t bit = 14 - (y / kDot * kDigitWidth + x / kDot);
        if (((digit >> bit) & 1) != 0) {
          sheet.pixels[std::size_t{top + y} * sheet.width + left + x] = kInk;
        }
      }
    }
    left += kDot * (kDigitWidth + 1);
  }
}

}  // namespace bandsaw::coordinator
