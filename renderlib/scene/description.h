#pragma once

// A scene as plain values: what packages decode to and tests write by hand. Scene::build checks it
// and makes it renderable.

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
  Camera camera;
  Background background;
  std::vector<Texture> textures;
  std::vector<Material> materials;
  Geometry geometry;
  Media media;
  PixelFilter filter;
  LocalShading local_shading;
  std::vector<DeltaLight> lights;  ///< those without size; surfaces shine by their material
};

}  // namespace bandsaw
