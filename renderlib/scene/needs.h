#pragma once

// The set of features that a scene really uses: what it does not need costs it nothing.

namespace bandsaw {

struct Needs {
  bool lights = false;       ///< anything to ask for light: next-event estimation
  bool background = false;   ///< a background that is not black
  bool environment = false;  ///< images all around: it is asked for light unless it is even
  bool specular = false;     ///< smooth metal or dielectric
  bool image_textures = false;
  bool instances = false;
  bool alpha = false;          ///< surfaces that are not there everywhere
  bool nested_glass = false;   ///< dielectrics with a priority
  bool uv_directions = false;  ///< normal maps
  bool motion = false;         ///< something moves while the shutter is open
  bool media = false;          ///< something between the surfaces
  friend bool operator==(const Needs&, const Needs&) = default;
};

}  // namespace bandsaw
