#pragma once

// The nodes of the summation tree (render/band.h) that a film holds for one strip of pixels.

#include <cstdint>
#include <vector>

#include "renderlib/render/band.h"
#include "renderlib/render/row_store.h"

namespace bandsaw {

struct Node {
  SampleRange range;
  RowStore::Slot slot = 0;
};

/// Nodes in the order of their samples; disjoint.
using StripNodes = std::vector<Node>;

/// Inserts a node that overlaps none, and merges siblings except the two halves that the error
/// estimate needs.
void insert_node(const Node& node, StripNodes& nodes, RowStore& store);

/// Returns the number of nodes, from the first sample on, that are contiguous.
std::size_t prefix(const StripNodes& nodes);

/// Returns true if the first two nodes are contiguous from sample 0 and have equally many samples.
bool has_halves(const StripNodes& nodes);

/// Returns the number of samples in the contiguous nodes.
std::uint64_t samples(const StripNodes& nodes);

}  // namespace bandsaw
