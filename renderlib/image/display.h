#pragma once

// How linear light becomes the numbers of a picture file.

#include <optional>

#include "absl/strings/string_view.h"
#include "renderlib/math/rgb.h"

namespace bandsaw {

/// What becomes of light above 1 in 8-bit files. The numbers are those of package.proto.
enum class Tone {
  kNone = 0,    ///< cut off
  kFilmic = 1,  ///< x (2.51 x + 0.03) / (x (2.43 x + 0.59) + 0.14), each channel: a fit of the ACES
                ///< film curve (Narkowicz 2016, "ACES filmic tone mapping curve")
};
inline constexpr int kLastTone = 1;

/// "none", "filmic".
absl::string_view tone_name(Tone tone);
std::optional<Tone> tone_named(absl::string_view name);

inline constexpr double kMostExposure = 30;

struct Display {
  double exposure = 0;  ///< of 8-bit files: stops, [-kMostExposure, kMostExposure]
  Tone tone = Tone::kNone;
  bool half = false;  ///< EXR files hold halves, not floats
  friend bool operator==(const Display&, const Display&) = default;
};

/// The light that an 8-bit file shows, before its transfer function: 2^exposure times it, then the
/// tone curve. With the default exactly the light itself. Rising in every channel; infinite light
/// is white, NaN stays NaN.
Rgb shown(const Rgb& light, const Display& display);

}  // namespace bandsaw
