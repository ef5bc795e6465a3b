#pragma once

// The set of features that a scene really uses: what it does not need costs it nothing. A need only
// ever leaves out work that would change nothing: with more needs than its own a scene has the same
// pixels to the bit. What a need gains stands in integrate/README.md.

#include <array>

namespace bandsaw {

struct Needs {
  bool lights = false;  ///< anything to ask for light: next-event estimation
  bool alpha = false;   ///< surfaces that are not there everywhere
  bool motion = false;  ///< something moves while the shutter is open
  bool media = false;   ///< something between the surfaces
  bool uv = false;      ///< textures that are looked up by it
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

/// The general kernel's.
inline constexpr Needs kAllNeeds = [] {
  Needs all;
  for (const NamedNeed& each : kEachNeed) {
    all.*each.need = true;
  }
  return all;
}();

/// What either needs.
constexpr Needs operator|(Needs a, const Needs& b) {
  for (const NamedNeed& each : kEachNeed) {
    a.*each.need = a.*each.need || b.*each.need;
  }
  return a;
}

}  // namespace bandsaw
