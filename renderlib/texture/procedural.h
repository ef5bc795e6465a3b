#pragma once

// Procedural textures: checker, noise and ramp. texture.cpp, which evaluates all textures, calls
// these functions.

#include "renderlib/texture/texture.h"

namespace bandsaw {

/// Returns true if the point lies in a cell that has the texture `checker.even`.
bool is_even(const CheckerTexture& checker, const TextureCoordinates& at);

/// Returns the colour at the point.
Rgb evaluate(const NoiseTexture& noise, const TextureCoordinates& at);

/// Returns how many times the texture itself repeats between two points whose coordinates differ by
/// `change`. Textures that it refers to do not count. (repetitions() in texture.h adds those.)
double repetitions(const CheckerTexture& checker, const TextureCoordinates& change);
double repetitions(const NoiseTexture& noise, const TextureCoordinates& change);
/// `ramp.over` MUST NOT be kTexture.
double repetitions(const RampTexture& ramp, const TextureCoordinates& change);

/// Returns the coordinate that the ramp maps to a colour. `ramp.over` MUST NOT be kTexture.
double coordinate(const RampTexture& ramp, const TextureCoordinates& at);
/// Returns the ramp's colour at `value`; NaN maps to the first stop. The values of textures are
/// floats. So if `ramp.over` is kTexture, the stops of a stepped ramp are rounded to floats before
/// `value` is compared with them.
Rgb evaluate(const RampTexture& ramp, double value);

}  // namespace bandsaw
