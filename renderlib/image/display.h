#pragma once

// Conversion of linear radiance to the values of 8-bit image files.

#include <optional>

#include "absl/strings/string_view.h"
#include "renderlib/math/rgb.h"

namespace bandsaw {

/// The tone curve of 8-bit files. The numeric values are those of package.proto.
enum class Tone {
  kNone = 0,  ///< no curve: radiance above 1 is clamped
  /// x (2.51 x + 0.03) / (x (2.43 x + 0.59) + 0.14) for each channel: a fit of the ACES film curve
  /// (Narkowicz 2016, "ACES filmic tone mapping curve").
  kFilmic = 1,
};
inline constexpr int kLastTone = 1;  ///< largest value of Tone

/// Returns "none" or "filmic".
absl::string_view tone_name(Tone tone);
/// Returns the tone with this name; std::nullopt if there is none.
std::optional<Tone> tone_named(absl::string_view name);

inline constexpr double kMaxExposure = 30;  ///< in stops

/// How an image is written to a file.
struct Display {
  double exposure = 0;      ///< for 8-bit files: stops, [-kMaxExposure, kMaxExposure]
  Tone tone = Tone::kNone;  ///< for 8-bit files
  bool half = false;        ///< EXR files store halves instead of floats
  friend bool operator==(const Display&, const Display&) = default;
};

/// Applies the settings of 8-bit files to `light`: multiplies it by 2^exposure and then applies the
/// tone curve. The result is linear; the sRGB curve is not yet applied. With the default settings
/// it is exactly `light`. The result is monotonic in every channel. Infinite radiance becomes white
/// in the file, and NaN stays NaN.
Rgb shown(const Rgb& light, const Display& display);

}  // namespace bandsaw
