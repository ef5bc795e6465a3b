#pragma once

// The scenes of the "weekend" books (Shirley, Black and Hollasch, "Ray Tracing in One Weekend",
// "Ray Tracing: The Next Week") that consist of hundreds of shapes at random places, as text. The
// books use random numbers of the C library. These scenes use those of SplitMix64
// (base/split_mix.h), so the small shapes are at other places than in the books.

#include <string>

namespace bandsaw::gallery {

/// Returns the last scene of the first book. If `bouncing` is true, returns the first scene of the
/// second book instead, in which the small diffuse spheres move up while the shutter is open.
std::string many_spheres(bool bouncing);

/// Returns the last scene of the second book.
std::string next_week_final();

}  // namespace bandsaw::gallery
