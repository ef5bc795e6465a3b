#pragma once

// The errors of a whole image (CleanError), summed up row by row from the two parts of its samples.
// denoise.cpp and halves.cpp use them.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "absl/types/span.h"
#include "renderlib/denoise/denoise.h"
#include "renderlib/denoise/squared_error.h"

namespace bandsaw {

/// A pixel in both parts of the samples. If the pixel stays as it was rendered, the filtered values
/// are those as rendered.
struct PixelInParts {
  bool rendered = false;  ///< the pixel stays as it was rendered
  std::array<InParts<double>, 3> channels;

  /// Sets the values that were filtered from the first part (`a`) and from the second part (`b`).
  void set_filtered(const Rgb& a, const Rgb& b);
};

/// Returns pixel number `at` of the image, staying as it was rendered. Returns std::nullopt if the
/// mean of one of its parts does not exist or is not finite.
std::optional<PixelInParts> rendered_in_parts(const DenoiseInput& input, std::size_t at);

/// The pixels of a row; std::nullopt for a pixel whose parts are not finite.
using RowInParts = std::vector<std::optional<PixelInParts>>;

/// Sums over all channels and over the pixels of a row that have finite parts.
struct RowSums {
  std::uint64_t pixels = 0;  ///< number of these pixels
  double value = 0;          ///< values as rendered
  double raw = 0;            ///< estimated squared errors as rendered
  double clean = 0;          ///< estimated squared errors of the result
  double variance = 0;       ///< the parts of `clean` that are noise
  double bias = 0;           ///< common_bias() of neighbours
  std::uint64_t pairs = 0;   ///< number of pairs of neighbours in `bias`, times 3 channels

  void add(const RowSums& other);
  void add(const PixelInParts& pixel);
  /// Adds the common bias of a pixel and one of its neighbours, if the neighbour has finite parts.
  /// A pixel that stays as it was rendered has no bias.
  void add_bias(const PixelInParts& pixel, const std::optional<PixelInParts>& neighbour);
};

/// Returns the sums of the pixel at column x of the row `here`, and of its pairs with the pixels to
/// the right and below. `below` may be empty: there is no row below.
RowSums sums_at(const RowInParts& here, const RowInParts& below, std::size_t x);

/// Returns the errors of the image from the sums of all its rows. `rendered_share`: as in
/// DenoiseInput.
CleanError total_of(absl::Span<const RowSums> rows, double rendered_share);

}  // namespace bandsaw
