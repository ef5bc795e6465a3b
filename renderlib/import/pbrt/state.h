#pragma once

// The graphics state of a pbrt scene, which AttributeBegin saves and AttributeEnd restores.

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "proto/scene.pb.h"
#include "renderlib/import/pbrt/parameters.h"
#include "renderlib/math/transform.h"

namespace bandsaw::pbrt {

/// The current transformation at the start and at the end of the motion.
using Transforms = std::array<Transform, 2>;

/// A material before it is combined with a shape's emission and opacity.
struct Surface {
  scene::Material material;  ///< without a name
  std::string label;         ///< the name in our scene begins with it: "Floor"
  bool is_null = false;      ///< "interface": the surface is invisible
  bool transmits = false;    ///< light passes the surface, so the media on its sides matter
  bool is_black = false;     ///< reflects nothing; if it emits, it becomes an Emissive material
};

/// An AreaLightSource directive: the shapes that follow it emit.
struct AreaLight {
  Parameters parameters;
};

struct State {
  Transforms transforms;
  bool is_active[2] = {true, true};  ///< true: directives change this transform (ActiveTransform)
  bool reverse_orientation = false;
  std::shared_ptr<const Surface> surface;  ///< never nullptr
  std::shared_ptr<const AreaLight> area_light;
  std::string inside;   ///< medium; empty: none
  std::string outside;  ///< medium; empty: none
  std::string color_space = "srgb";
  /// Default parameters that Attribute directives have given. Each has a target, the kind of
  /// directive to which it applies: shape, light, material, medium or texture.
  std::shared_ptr<const std::vector<std::pair<std::string, Parameter>>> defaults;
};

}  // namespace bandsaw::pbrt
