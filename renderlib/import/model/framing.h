#pragma once

// Makes a camera for a model that has none, and a background for a model without lights.

#include <vector>

#include "renderlib/camera/camera.h"
#include "renderlib/geometry/shapes.h"
#include "renderlib/light/background.h"

namespace bandsaw {

/// Returns a camera in front of the model (+z, as in glTF), a little to the right and above. The
/// camera sees all vertices of the instances of meshes; instances of groups are ignored. It is as
/// close as possible with a margin of 6 % of the image. Without instances, returns the default
/// camera. `aspect_ratio` is width / height.
PerspectiveCamera frame(const Geometry& geometry, const std::vector<Instance>& instances,
                        double aspect_ratio);

/// Returns a sky that is brighter and bluer above than below.
Background default_sky();

}  // namespace bandsaw
