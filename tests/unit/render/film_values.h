#pragma once

// Sample values for the tests of Film (which adds the sums of bands to an image). The sums of the
// values are computed here by the definition of the summation tree (render/band.h). A node of this
// tree is a range of samples. The sum of a node is the sum of its two halves. In a node of one
// block of 8 samples, the samples are added in order. `y` is a row of the image, and `k` = 3 x + c
// is channel c of the pixel in column x.

#include <cmath>
#include <vector>

#include "renderlib/render/band.h"
#include "tests/support/random.h"

namespace bandsaw {

using test::Random;

/// Returns a sample's value. Values differ everywhere and their sums are rounded, so that another
/// order of summation is detected.
inline double value(std::uint32_t y, std::size_t k, std::uint64_t sample) {
  Random random(y * 1000003u + k * 4099u + sample * 77777777u);
  return static_cast<float>(random.uniform() * std::exp2(random.uniform(-20, 20)));
}

/// Returns the sum of a node according to the definition of the tree.
inline double node_sum(std::uint32_t y, std::size_t k, const SampleRange& node) {
  if (node.blocks() > 1) {
    const Halves halves = split(node);
    return node_sum(y, k, halves.left) + node_sum(y, k, halves.right);
  }
  double sum = 0;
  for (std::uint64_t sample = node.first; sample < node.last; ++sample) {
    sum += value(y, k, sample);
  }
  return sum;
}

/// Returns the sums of a band of an image that is `width` pixels wide.
inline BandPixels band_pixels(const Band& band, std::uint32_t width) {
  BandPixels pixels{.band = band, .width = width, .sums = {}, .counters = {}};
  for (std::uint32_t y = band.rows.first; y < band.rows.last; ++y) {
    for (std::size_t k = 0; k < std::size_t{width} * 3; ++k) {
      pixels.sums.push_back(node_sum(y, k, band.samples));
    }
  }
  return pixels;
}

/// Returns nodes that tile [0, samples). At random, the maximal nodes are split into halves, and
/// the halves are split again.
inline std::vector<SampleRange> random_nodes(std::uint64_t samples, Random& random) {
  std::vector<SampleRange> open = maximal_nodes(samples);
  std::vector<SampleRange> nodes;
  while (!open.empty()) {
    const SampleRange node = open.back();
    open.pop_back();
    if (node.blocks() > 1 && random.below(3) != 0) {
      const Halves halves = split(node);
      open.push_back(halves.left);
      open.push_back(halves.right);
    } else {
      nodes.push_back(node);
    }
  }
  return nodes;
}

}  // namespace bandsaw
