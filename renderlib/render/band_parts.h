#pragma once

// Divides the samples of a band into parts. Each photon map serves a range of samples
// (integrate/caustics.h), so a part with a few samples needs few photon maps. The division bounds
// the memory of the maps. render_band.cpp renders the parts one after the other.

#include <cstdint>
#include <utility>
#include <vector>

#include "renderlib/render/band.h"
#include "renderlib/render/tile_samples.h"

namespace bandsaw {

/// A band and the samples that its half tiles take. A half tile is half of the pixels of a tile,
/// and the unit of adaptive sampling (tile_samples.h). If `tiles` is whole(), all pixels take the
/// samples of the band. Otherwise `tiles` has the rows of the band.
struct BandPart {
  Band band;
  TileSamples tiles;
};

/// Returns the numbers of the maps that the part needs (PhotonMaps::number_of), in ascending
/// order, each once.
std::vector<std::uint32_t> maps_of(const BandPart& part);

/// Divides the samples of a part that needs more than one map. Both results have all rows of the
/// part. A pixel's sum is, to the bit, its sum in the first result plus its sum in the second.
/// `width` is the width of the image in pixels.
std::pair<BandPart, BandPart> halves_of(const BandPart& part, std::uint32_t width);

}  // namespace bandsaw
