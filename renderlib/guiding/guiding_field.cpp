// Builds a binary tree over the records (light that arrived at points of surfaces). The box around
// a range of records is halved at its longest side, until each range has few enough records. In
// each leaf the records are divided into up to six cells, by the axis direction that is closest to
// their normal. Then the light of each cell's records comes from a few regions, and fit_cell()
// encloses each of them in a ball.

#include "renderlib/guiding/guiding_field.h"

#include <algorithm>
#include <limits>
#include <optional>

namespace bandsaw {
namespace {

/// Bounds the recursion where many records are at nearly the same point.
constexpr int kMaxTreeDepth = 40;

/// The longest side of a box.
struct Extent {
  int axis = 0;
  float low = 0;
  float high = 0;
};

/// Returns the longest side of the box around the records.
Extent longest_extent(absl::Span<const GuidingRecord> records) {
  Extent longest;
  float most = -1;
  for (int axis = 0; axis < 3; ++axis) {
    float low = std::numeric_limits<float>::max();
    float high = std::numeric_limits<float>::lowest();
    for (const GuidingRecord& record : records) {
      low = std::min(low, record.position[static_cast<std::size_t>(axis)]);
      high = std::max(high, record.position[static_cast<std::size_t>(axis)]);
    }
    if (high - low > most) {
      most = high - low;
      longest = {axis, low, high};
    }
  }
  return longest;
}

/// Returns the effective number of the records, (sum of the weights)^2 / sum of the squared
/// weights. It is the number of the records if all weights are equal, otherwise it is smaller.
double effective_count(absl::Span<const GuidingRecord> records) {
  double sum = 0;
  double squares = 0;
  for (const GuidingRecord& record : records) {
    const double weight = record.weight;
    sum += weight;
    squares += weight * weight;
  }
  return squares > 0 ? sum * sum / squares : 0;
}

}  // namespace

GuidingTree::GuidingTree(std::vector<GuidingRecord> records, Pool& pool) {
  if (records.empty()) {
    return;
  }
  std::vector<std::size_t> starts;
  split(records, 0, records.size(), /*depth=*/0, starts);
  starts.push_back(records.size());
  // A leaf's records are sorted by side, and each side becomes a cell.
  std::vector<std::array<std::optional<GuidingCell>, 6>> fitted(leaves_.size());
  pool.parallel_for(static_cast<std::int64_t>(leaves_.size()), [&](std::int64_t number) {
    const auto leaf = static_cast<std::size_t>(number);
    const auto begin = records.begin();
    const auto side = [](const GuidingRecord& record) { return side_of(vec3(record.normal)); };
    auto from = begin + static_cast<std::ptrdiff_t>(starts[leaf]);
    const auto to = begin + static_cast<std::ptrdiff_t>(starts[leaf + 1]);
    for (std::uint32_t i = 0; i < 6; ++i) {
      const auto next = std::stable_partition(
          from, to, [&](const GuidingRecord& record) { return side(record) == i; });
      const auto count = static_cast<std::size_t>(next - from);
      if (count > 0) {
        fitted[leaf][i] = fit_cell({&*from, count});
      }
      from = next;
    }
  });
  for (std::size_t leaf = 0; leaf < leaves_.size(); ++leaf) {
    for (std::size_t side = 0; side < 6; ++side) {
      leaves_[leaf][side] = kNoCell;
      if (fitted[leaf][side]) {
        leaves_[leaf][side] = static_cast<std::uint32_t>(cells_.size());
        cells_.push_back(*fitted[leaf][side]);
      }
    }
  }
}

void GuidingTree::split(std::vector<GuidingRecord>& records, std::size_t first, std::size_t last,
                        int depth, std::vector<std::size_t>& starts) {
  const absl::Span<const GuidingRecord> own{records.data() + first, last - first};
  const Extent extent = longest_extent(own);
  const double effective_records = effective_count(own);
  const float at = extent.low / 2 + extent.high / 2;
  const std::size_t number = nodes_.size();
  if (effective_records <= kRecordsOfLeaf || depth >= kMaxTreeDepth || !(at > extent.low)) {
    nodes_.push_back({.next = static_cast<std::uint32_t>(leaves_.size())});
    leaves_.emplace_back();
    starts.push_back(first);
    return;
  }
  nodes_.push_back({.split = at, .axis = extent.axis});
  const auto axis = static_cast<std::size_t>(extent.axis);
  const auto middle = static_cast<std::size_t>(
      std::stable_partition(
          records.begin() + static_cast<std::ptrdiff_t>(first),
          records.begin() + static_cast<std::ptrdiff_t>(last),
          [&](const GuidingRecord& record) { return record.position[axis] < at; }) -
      records.begin());
  split(records, first, middle, depth + 1, starts);
  nodes_[number].next = static_cast<std::uint32_t>(nodes_.size());
  split(records, middle, last, depth + 1, starts);
}

std::size_t GuidingTree::bytes() const {
  return nodes_.size() * sizeof(Node) + leaves_.size() * sizeof(Leaf) +
         cells_.size() * sizeof(GuidingCell);
}

GuidingField::GuidingField(absl::Span<const GuidingRecord> records, Pool& pool) {
  const auto of_kind = [&](GuidingRecord::Kind kind) {
    std::vector<GuidingRecord> out;
    std::copy_if(records.begin(), records.end(), std::back_inserter(out),
                 [&](const GuidingRecord& record) { return record.kind == kind; });
    return out;
  };
  paths_ = GuidingTree(of_kind(GuidingRecord::Kind::kPath), pool);
  photons_ = GuidingTree(of_kind(GuidingRecord::Kind::kPhoton), pool);
}

}  // namespace bandsaw
