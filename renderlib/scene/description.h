#pragma once

// A scene as plain values: the result of decoding a package, or written by hand in tests.
// Scene::build validates it and makes it renderable.

#include <optional>
#include <vector>

#include "renderlib/camera/camera.h"
#include "renderlib/camera/pixel_filter.h"
#include "renderlib/geometry/shapes.h"
#include "renderlib/light/background.h"
#include "renderlib/light/delta_light.h"
#include "renderlib/material/material.h"
#include "renderlib/scene/integrator.h"
#include "renderlib/scene/media.h"
#include "renderlib/texture/texture.h"

namespace bandsaw {

struct SceneDescription {
  Camera camera;  ///< the camera; if it moves, its state when the shutter opens
  /// The camera's state when the shutter closes; absent if the camera does not move (camera.h,
  /// validate_motion).
  std::optional<Camera> camera_at_close;
  Background background;
  std::vector<Texture> textures;
  std::vector<Material> materials;
  Geometry geometry;
  Media media;
  PixelFilter filter;
  LocalShading local_shading;
  std::vector<DeltaLight> lights;  ///< delta lights; surfaces emit by their material
};

}  // namespace bandsaw
