#pragma once

// Pictures that stand beside the image in one EXR file.

#include <string>
#include <vector>

#include "renderlib/image/image.h"

namespace bandsaw {

struct Layer {
  std::string name;  ///< "albedo": its channels are albedo.R, albedo.G, albedo.B
  Image image;       ///< as large as the image that it stands beside
  /// A number a pixel, in the red channel, named name.Z and kept as floats whatever the file holds.
  bool is_number = false;
};

using Layers = std::vector<Layer>;

}  // namespace bandsaw
