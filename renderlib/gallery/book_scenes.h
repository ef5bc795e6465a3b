#pragma once

// The scenes of the "weekend" books (Shirley, Black and Hollasch, "Ray Tracing in One Weekend",
// "Ray Tracing: The Next Week") that are made of hundreds of shapes at random places, as text. The
// books draw their numbers from the C library; these are ours, so that each small thing lies
// elsewhere.

#include <string>

namespace bandsaw::gallery {

/// The last scene of the first book, or with `bouncing` the first of the second, whose diffuse
/// spheres move up while the shutter is open.
std::string many_spheres(bool bouncing);

/// The last scene of the second book.
std::string next_week_final();

}  // namespace bandsaw::gallery
