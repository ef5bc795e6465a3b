#pragma once

// Parts of a band that need few photon maps each, so that the memory of the maps of a band is
// bounded.

#include <cstdint>
#include <utility>
#include <vector>

#include "renderlib/render/band.h"
#include "renderlib/render/tile_samples.h"

namespace bandsaw {

/// A band and the samples that its half tiles take. The rows of `tiles` are those of the band.
struct BandPart {
  Band band;
  TileSamples tiles;
};

/// Returns the numbers of the maps that the part needs (CausticMaps::number_of), in ascending
/// order, each once.
std::vector<std::uint32_t> maps_of(const BandPart& part);

/// Divides a part that needs more than one map. The sum of a pixel is the sum of that in the first
/// and that in the second part, to the bit.
std::pair<BandPart, BandPart> halves_of(const BandPart& part, std::uint32_t width);

}  // namespace bandsaw
