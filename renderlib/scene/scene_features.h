#pragma once

// The features that a scene uses. Unused features cost nothing. If a flag is not set, only work
// that would change nothing is skipped. So a scene has the same pixels, to the bit, with additional
// flags. integrate/NOTES.md has the cost of each feature.

#include <array>

namespace bandsaw {

/// Made by Scene::build (scene.cpp).
struct SceneFeatures {
  bool lights = false;    ///< lights that can be sampled (next-event estimation)
  bool alpha = false;     ///< surfaces that are not fully opaque
  bool motion = false;    ///< instances, meshes or a camera that move during the shutter interval
  bool media = false;     ///< participating media
  bool grids = false;     ///< media that vary in space
  bool uv = false;        ///< textures that use uv coordinates
  bool mixtures = false;  ///< materials that are mixtures
  friend bool operator==(const SceneFeatures&, const SceneFeatures&) = default;
};

struct NamedFeature {
  const char* name;
  bool SceneFeatures::*feature;
};

inline constexpr std::array<NamedFeature, 7> kEachFeature = {{
    {"lights", &SceneFeatures::lights},
    {"alpha", &SceneFeatures::alpha},
    {"motion", &SceneFeatures::motion},
    {"media", &SceneFeatures::media},
    {"grids", &SceneFeatures::grids},
    {"uv", &SceneFeatures::uv},
    {"mixtures", &SceneFeatures::mixtures},
}};
static_assert(sizeof(SceneFeatures) == kEachFeature.size(), "every feature is in the table");

/// All features; tests force them on.
inline constexpr SceneFeatures kAllFeatures = [] {
  SceneFeatures all;
  for (const NamedFeature& each : kEachFeature) {
    all.*each.feature = true;
  }
  return all;
}();

/// Returns the features that are set in `a` or `b`.
constexpr SceneFeatures operator|(SceneFeatures a, const SceneFeatures& b) {
  for (const NamedFeature& each : kEachFeature) {
    a.*each.feature = a.*each.feature || b.*each.feature;
  }
  return a;
}

}  // namespace bandsaw
