#pragma once

// The features that a scene uses; unused features cost nothing. A flag only skips work that would
// change nothing: with additional flags a scene has the same pixels to the bit. integrate/NOTES.md
// has the cost of each.

#include <array>

namespace bandsaw {

struct Needs {
  bool lights = false;  ///< lights that can be sampled (next-event estimation)
  bool alpha = false;   ///< surfaces that are not fully opaque
  bool motion = false;  ///< instances that move during the shutter interval
  bool media = false;   ///< participating media
  bool uv = false;      ///< textures that use uv coordinates
  friend bool operator==(const Needs&, const Needs&) = default;
};

struct NamedNeed {
  const char* name;
  bool Needs::*need;
};

inline constexpr std::array<NamedNeed, 5> kEachNeed = {{
    {"lights", &Needs::lights},
    {"alpha", &Needs::alpha},
    {"motion", &Needs::motion},
    {"media", &Needs::media},
    {"uv", &Needs::uv},
}};
static_assert(sizeof(Needs) == kEachNeed.size(), "every need is in the table");

/// All features: those of the general kernel.
inline constexpr Needs kAllNeeds = [] {
  Needs all;
  for (const NamedNeed& each : kEachNeed) {
    all.*each.need = true;
  }
  return all;
}();

/// Returns the union of both.
constexpr Needs operator|(Needs a, const Needs& b) {
  for (const NamedNeed& each : kEachNeed) {
    a.*each.need = a.*each.need || b.*each.need;
  }
  return a;
}

}  // namespace bandsaw
