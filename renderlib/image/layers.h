#pragma once

// Layers: additional images (albedo, normals, depth, numbers of samples) that are stored beside the
// main image in one EXR file.

#include <string>
#include <vector>

#include "renderlib/image/image.h"

namespace bandsaw {

struct Layer {
  std::string name;  ///< for "albedo" the channels are albedo.R, albedo.G, albedo.B
  Image image;       ///< MUST have the size of the main image
  /// True if the layer is one number per pixel, which is the red component of `image`. The file
  /// then has one channel for the layer, NAME.Z. This channel is always stored as floats.
  bool is_number = false;
};

using Layers = std::vector<Layer>;

}  // namespace bandsaw
