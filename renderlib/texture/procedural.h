#pragma once

// Procedural textures: checker, noise and ramp. texture.cpp, which evaluates all textures, calls
// these functions.

#include "renderlib/texture/texture.h"

namespace bandsaw {

/// Returns true if the point lies in a cell of texture `even`.
bool is_even(const CheckerTexture& checker, const TextureCoordinates& at);

/// Returns the colour at the point.
Rgb evaluate(const NoiseTexture& noise, const TextureCoordinates& at);

/// Returns how many times the texture itself repeats, as repetitions() in texture.h.
double repetitions(const CheckerTexture& checker, const TextureCoordinates& way);
double repetitions(const NoiseTexture& noise, const TextureCoordinates& way);
/// `ramp.over` MUST NOT be kTexture.
double repetitions(const RampTexture& ramp, const TextureCoordinates& way);

/// Returns the coordinate that the ramp maps to a colour. `ramp.over` MUST NOT be kTexture.
double coordinate(const RampTexture& ramp, const TextureCoordinates& at);
/// Returns the ramp's colour at `value`, which is a float if `ramp.over` is kTexture; NaN maps to
/// the first stop.
Rgb evaluate(const RampTexture& ramp, double value);

}  // namespace bandsaw
