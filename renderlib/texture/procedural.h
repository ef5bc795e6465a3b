#pragma once

// Textures that are computed, but for those they are made of.

#include "renderlib/texture/texture.h"

namespace bandsaw {

/// Whether the point lies in a cell of `even`.
bool is_even(const CheckerTexture& checker, const TextureCoordinates& at);

Rgb evaluate(const NoiseTexture& noise, const TextureCoordinates& at);

/// The coordinate that a ramp goes over; not of kTexture.
double coordinate(const RampTexture& ramp, const TextureCoordinates& at);
/// NaN counts as the first stop.
Rgb evaluate(const RampTexture& ramp, double value);

}  // namespace bandsaw
