// A strip is some pixels of a row of a film that always have the same samples. It keeps the nodes
// that have arrived: sums over aligned ranges of samples, which form a binary tree. Two nodes that
// are siblings in the tree are merged, except the two halves that the error estimate needs.

#include "renderlib/render/strip_nodes.h"

#include <algorithm>

namespace bandsaw {
namespace {

/// Returns false if the last block of the range is truncated.
bool whole(const SampleRange& range) { return range.samples() == range.blocks() * kBlockSamples; }

/// Returns true if the two nodes are the halves of one node of the tree.
bool siblings(const SampleRange& left, const SampleRange& right) {
  return left.last == right.first && left.blocks() == right.blocks() &&
         left.first_block() % (2 * left.blocks()) == 0;
}

/// Returns true if nodes i and i + 1 are to be merged. The first two nodes of a strip are the
/// halves of the error estimate. They stay separate until the third node is present and has as many
/// samples as both halves together. Then the two halves are merged into the new first half, and the
/// third node becomes the new second half. The sum of all nodes from left to right has the same
/// bits before and after the merge.
bool should_merge(const StripNodes& nodes, std::size_t i) {
  if (!siblings(nodes[i].range, nodes[i + 1].range)) {
    return false;
  }
  if (nodes[i].range.first != 0) {
    return true;
  }
  const SampleRange both{0, nodes[i + 1].range.last};
  return nodes.size() > i + 2 && whole(both) && whole(nodes[i + 2].range) &&
         siblings(both, nodes[i + 2].range);
}

void merge_into(Node& left, const Node& right, RowStore& store) {
  const absl::Span<double> sums = store.row(left.slot);
  const absl::Span<const double> more = store.row(right.slot);
  for (std::size_t k = 0; k < sums.size(); ++k) {
    sums[k] += more[k];
  }
  store.give_back(right.slot);
  left.range.last = right.range.last;
}

void merge_all(StripNodes& nodes, RowStore& store) {
  std::size_t i = 0;
  while (i + 1 < nodes.size()) {
    if (!should_merge(nodes, i)) {
      ++i;
      continue;
    }
    merge_into(nodes[i], nodes[i + 1], store);
    nodes.erase(nodes.begin() + static_cast<std::ptrdiff_t>(i) + 1);
    // A merge can create a sibling of the previous node. It can also create the third node that the
    // first two nodes wait for (should_merge).
    i = i >= 2 ? i - 2 : 0;
  }
}

}  // namespace

void insert_node(const Node& node, StripNodes& nodes, RowStore& store) {
  const auto after = std::find_if(nodes.begin(), nodes.end(), [&](const Node& other) {
    return other.range.first > node.range.first;
  });
  nodes.insert(after, node);
  merge_all(nodes, store);
}

std::size_t prefix(const StripNodes& nodes) {
  std::size_t count = 0;
  std::uint64_t at = 0;
  while (count < nodes.size() && nodes[count].range.first == at) {
    at = nodes[count].range.last;
    ++count;
  }
  return count;
}

bool has_halves(const StripNodes& nodes) {
  return prefix(nodes) >= 2 && nodes[0].range.samples() == nodes[1].range.samples();
}

std::uint64_t samples(const StripNodes& nodes) {
  const std::size_t count = prefix(nodes);
  return count == 0 ? 0 : nodes[count - 1].range.last;
}

}  // namespace bandsaw
