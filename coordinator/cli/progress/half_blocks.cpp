// A character cell of the terminal shows two pixels, one above the other. Its character is the
// upper half block in the colour of the upper pixel. Its background has the colour of the lower
// pixel. Each shown pixel is the mean of the pixels of the image that it covers.

#include "coordinator/cli/progress/half_blocks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "absl/strings/str_cat.h"
#include "renderlib/image/srgb.h"

namespace bandsaw::coordinator {
namespace {

using Codes = std::array<std::uint8_t, 3>;  // r, g, b in sRGB

/// The size of the picture that is drawn, in pixels.
struct Grid {
  std::uint32_t width = 0;   ///< one pixel per column
  std::uint32_t height = 0;  ///< two pixels per line
};

/// Returns the size of the picture: that of the image, reduced if it does not fit into `available`.
Grid grid_of(const Image& image, TerminalSize available) {
  const double scale = std::min({1.0, static_cast<double>(available.columns) / image.width,
                                 2.0 * static_cast<double>(available.rows) / image.height});
  const auto scaled = [scale](std::uint32_t side) {
    return std::max(1U, static_cast<std::uint32_t>(std::floor(side * scale)));
  };
  return {scaled(image.width), scaled(image.height)};
}

/// A side of the image has `side` pixels, which are divided among `cells` pixels of the picture.
/// Returns the first pixel of the image that belongs to pixel `i` of the picture.
std::uint32_t edge(std::uint32_t side, std::uint32_t i, std::uint32_t cells) {
  return static_cast<std::uint32_t>(std::uint64_t{side} * i / cells);
}

/// Returns the colour of pixel (x, y) of the picture.
Codes codes_at(const Image& image, const Display& display, const Grid& grid, std::uint32_t x,
               std::uint32_t y) {
  double sum[3] = {};
  const std::uint32_t left = edge(image.width, x, grid.width);
  const std::uint32_t right = edge(image.width, x + 1, grid.width);
  const std::uint32_t top = edge(image.height, y, grid.height);
  const std::uint32_t bottom = edge(image.height, y + 1, grid.height);
  for (std::uint32_t v = top; v < bottom; ++v) {
    for (std::uint32_t u = left; u < right; ++u) {
      const Rgb light = shown(image.at(u, v), display);
      // Values are limited to 1, so that one very bright pixel does not make all of (x, y) bright.
      sum[0] += std::min(light.r, 1.0F);
      sum[1] += std::min(light.g, 1.0F);
      sum[2] += std::min(light.b, 1.0F);
    }
  }
  const double n = double{1} * (right - left) * (bottom - top);
  return {srgb_encode(static_cast<float>(sum[0] / n)), srgb_encode(static_cast<float>(sum[1] / n)),
          srgb_encode(static_cast<float>(sum[2] / n))};
}

/// Returns the escape sequence that sets a colour. `kind`: "38" for characters, "48" for their
/// background.
std::string colour(const char* kind, const Codes& codes) {
  return absl::StrCat("\x1b[", kind, ";2;", codes[0], ";", codes[1], ";", codes[2], "m");
}

}  // namespace

std::vector<std::string> half_blocks(const Image& image, const Display& display,
                                     TerminalSize available) {
  std::vector<std::string> lines;
  if (image.pixels.empty() || available.columns == 0 || available.rows == 0) {
    return lines;
  }
  const Grid grid = grid_of(image, available);
  for (std::uint32_t y = 0; y < grid.height; y += 2) {
    std::string& line = lines.emplace_back();
    std::string last;
    for (std::uint32_t x = 0; x < grid.width; ++x) {
      std::string colours = colour("38", codes_at(image, display, grid, x, y));
      if (y + 1 < grid.height) {
        absl::StrAppend(&colours, colour("48", codes_at(image, display, grid, x, y + 1)));
      }
      absl::StrAppend(&line, colours == last ? "" : colours, "▀");
      last = std::move(colours);
    }
    absl::StrAppend(&line, "\x1b[0m");
  }
  return lines;
}

}  // namespace bandsaw::coordinator
