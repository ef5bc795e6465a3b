#pragma once

// Converts the directives that describe the image: Camera, Film, PixelFilter and Integrator.

#include "renderlib/import/pbrt/builder.h"

namespace bandsaw::pbrt {

/// The directives before WorldBegin that describe the image: the type and the parameters of each;
/// std::nullopt for a directive that is absent.
struct ViewSource {
  std::optional<std::pair<std::string, Parameters>> camera;
  std::optional<std::pair<std::string, Parameters>> film;
  std::optional<std::pair<std::string, Parameters>> filter;
  std::optional<std::pair<std::string, Parameters>> integrator;
  Transforms to_camera;  ///< from the world to the camera, at the start and end of the motion
  std::string medium;    ///< medium around the camera; empty: none
  Place medium_place;
};

/// Sets the camera (with its shutter times), the image and the integrator of the scene. Also sets
/// Builder::light_factor, by which all light is multiplied.
absl::Status set_view(const ViewSource& view, Builder& builder);

}  // namespace bandsaw::pbrt
