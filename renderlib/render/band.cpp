// Divides ranges of samples into nodes, and checks bands.
//
// The samples of a pixel are counted in blocks of kBlockSamples. A node is a range of 2^k blocks
// that starts at a multiple of 2^k; a leaf is a node of one block. The last block of a job may be
// cut short. A band is the unit of work: one node of samples for some rows of pixels.

#include "renderlib/render/band.h"

#include <bit>
#include <tuple>

#include "absl/strings/str_cat.h"
#include "renderlib/base/check.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw {

bool is_node(const SampleRange& range) {
  // The upper bound prevents overflow in blocks(); no job comes near it.
  if (range.first >= range.last || range.last > (std::uint64_t{1} << 62)) {
    return false;
  }
  return range.first % kBlockSamples == 0 && std::has_single_bit(range.blocks()) &&
         range.first_block() % range.blocks() == 0;
}

std::vector<SampleRange> maximal_nodes(std::uint64_t samples) {
  std::vector<SampleRange> nodes;
  std::uint64_t first = 0;
  while (first < samples) {
    // All nodes before `first` are longer, and their numbers of blocks are powers of two. So
    // `first` is a multiple of the length of the largest node that fits, and this node is aligned.
    const std::uint64_t blocks = std::bit_floor(SampleRange{first, samples}.blocks());
    const std::uint64_t last = std::min(first + blocks * kBlockSamples, samples);
    nodes.push_back({first, last});
    first = last;
  }
  return nodes;
}

Halves split(const SampleRange& node) {
  BANDSAW_CHECK(is_node(node) && node.blocks() >= 2, "only nodes above the leaves have halves");
  // The truncation lies in the last block, so the right half is never empty.
  const std::uint64_t middle = node.first + node.blocks() / 2 * kBlockSamples;
  return {{node.first, middle}, {middle, node.last}};
}

absl::Status validate(const Band& band, const RenderSettings& settings) {
  RETURN_IF_ERROR(validate(settings));
  if (band.rows.first >= band.rows.last || band.rows.last > settings.height) {
    return absl::InvalidArgumentError(absl::StrCat("rows: must be a range within [0, ",
                                                   settings.height, "), are [", band.rows.first,
                                                   ", ", band.rows.last, ")"));
  }
  if (!is_node(band.samples) || band.samples.last > kMaxSamples) {
    return absl::InvalidArgumentError(
        absl::StrCat("samples: must be an aligned range of 2^k blocks of ", kBlockSamples,
                     " samples that ends at or before ", kMaxSamples, ", are [", band.samples.first,
                     ", ", band.samples.last, ")"));
  }
  return absl::OkStatus();
}

void Counters::add(const Counters& other) {
  rays += other.rays;
  const auto place = [](const Counters& c) { return std::tie(c.bad_y, c.bad_x, c.bad_sample); };
  if (other.bad_samples > 0 && (bad_samples == 0 || place(other) < place(*this))) {
    bad_x = other.bad_x;
    bad_y = other.bad_y;
    bad_sample = other.bad_sample;
  }
  bad_samples += other.bad_samples;
  negative_samples += other.negative_samples;
  truncated_paths += other.truncated_paths;
  dropped_primitives = std::max(dropped_primitives, other.dropped_primitives);
  techniques |= other.techniques;
  training_rays = std::max(training_rays, other.training_rays);
}

}  // namespace bandsaw
