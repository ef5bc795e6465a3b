// Lists the photon maps that a part of a band needs, and divides a part in two. Each photon map
// serves a range of samples of all pixels.
//
// A half tile is half of the pixels of a tile. In adaptive sampling, each half tile takes a node of
// samples: an aligned range of 2^k blocks of 8 samples (band.h). halves_of() divides each node of
// several blocks into its two halves. If no half tile takes more than one block, halves_of()
// divides the half tiles by the numbers of their photon maps instead.

#include "renderlib/render/band_parts.h"

#include <algorithm>
#include <utility>

#include "renderlib/base/check.h"
#include "renderlib/integrate/caustics.h"

namespace bandsaw {
namespace {

/// The samples of half tile `i` in the result of TileSamples::numbers().
SampleRange range_at(const std::vector<std::uint32_t>& numbers, std::size_t i) {
  return {numbers[2 * i], std::uint64_t{numbers[2 * i]} + numbers[2 * i + 1]};
}

/// Returns a part with the band of `part` in which the half tiles take the samples `numbers`
/// (TileSamples::numbers).
BandPart with_numbers(const BandPart& part, const std::vector<std::uint32_t>& numbers,
                      std::uint32_t width) {
  auto tiles = TileSamples::from_numbers(numbers, width, part.band.rows);
  BANDSAW_CHECK(tiles.ok(), "halves of nodes are nodes");
  return {part.band, *std::move(tiles)};
}

}  // namespace

std::vector<std::uint32_t> maps_of(const BandPart& part) {
  std::vector<std::uint32_t> maps;
  const auto add = [&](const SampleRange& samples) {
    if (samples.samples() == 0) {
      return;
    }
    const std::uint32_t last = PhotonMaps::number_of(samples.last - 1);
    for (std::uint32_t map = PhotonMaps::number_of(samples.first); map <= last; ++map) {
      maps.push_back(map);
    }
  };
  if (part.tiles.whole()) {
    add(part.band.samples);
    return maps;
  }
  const std::vector<std::uint32_t> numbers = part.tiles.numbers();
  for (std::size_t i = 0; 2 * i < numbers.size(); ++i) {
    add(range_at(numbers, i));
  }
  std::sort(maps.begin(), maps.end());
  maps.erase(std::unique(maps.begin(), maps.end()), maps.end());
  return maps;
}

std::pair<BandPart, BandPart> halves_of(const BandPart& part, std::uint32_t width) {
  if (part.tiles.whole()) {
    const Halves halves = split(part.band.samples);
    return {{{halves.left, part.band.rows}, {}}, {{halves.right, part.band.rows}, {}}};
  }
  const std::vector<std::uint32_t> numbers = part.tiles.numbers();
  bool single = true;  // no half tile takes more than one block
  for (std::size_t i = 0; 2 * i < numbers.size(); ++i) {
    single = single && range_at(numbers, i).blocks() <= 1;
  }
  const std::vector<std::uint32_t> maps = maps_of(part);
  const std::uint32_t middle = maps[maps.size() / 2];
  std::vector<std::uint32_t> left(numbers.size());
  std::vector<std::uint32_t> right(numbers.size());
  for (std::size_t i = 0; 2 * i < numbers.size(); ++i) {
    const SampleRange all = range_at(numbers, i);
    // The samples of a half tile with several blocks are halved. A half tile with one block goes to
    // the left. But if no half tile has several blocks, each half tile goes to the left or to the
    // right by the number of its photon map.
    Halves halves{all, {}};
    if (all.blocks() > 1) {
      halves = split(all);
    } else if (single && PhotonMaps::number_of(all.first) >= middle) {
      halves = {{}, all};
    }
    left[2 * i] = static_cast<std::uint32_t>(halves.left.first);
    left[2 * i + 1] = static_cast<std::uint32_t>(halves.left.samples());
    right[2 * i] = static_cast<std::uint32_t>(halves.right.first);
    right[2 * i + 1] = static_cast<std::uint32_t>(halves.right.samples());
  }
  return {with_numbers(part, left, width), with_numbers(part, right, width)};
}

}  // namespace bandsaw
