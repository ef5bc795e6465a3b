#pragma once

// How a model is shown that brings neither camera nor light.

#include <vector>

#include "renderlib/camera/camera.h"
#include "renderlib/geometry/shapes.h"
#include "renderlib/light/background.h"

namespace bandsaw {

/// A camera from the front, a little right of it and above (the front of a model is +z, as glTF has
/// it), that holds all vertices of the instances and is as near as that allows, with a margin of 6
/// % of the picture.
PerspectiveCamera frame(const Geometry& geometry, const std::vector<Instance>& instances,
                        double aspect_ratio);

/// Brighter and bluer from above than from below.
Background default_sky();

}  // namespace bandsaw
