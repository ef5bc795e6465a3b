#pragma once

// The nodes that a film (film.cpp) holds for one strip. A strip is some pixels of a row that always
// have the same samples. The samples are added as in a binary tree, and a node is a sum over an
// aligned range of samples (render/band.h).

#include <cstdint>
#include <vector>

#include "renderlib/render/band.h"
#include "renderlib/render/row_store.h"

namespace bandsaw {

/// Sums of the pixels of a strip over a range of samples.
struct Node {
  SampleRange range;
  RowStore::Slot slot = 0;  ///< where the film's RowStore has the sums
};

/// Nodes in the order of their samples; disjoint.
using StripNodes = std::vector<Node>;

/// Inserts a node that overlaps none of `nodes`, and merges siblings except the two halves that the
/// error estimate needs. Slots that become free are given back to `store`.
void insert_node(const Node& node, StripNodes& nodes, RowStore& store);

/// Returns how many of the first nodes are contiguous from sample 0 on.
std::size_t prefix(const StripNodes& nodes);

/// Returns true if the first two nodes are contiguous from sample 0 and have equally many samples.
bool has_halves(const StripNodes& nodes);

/// Returns the number of samples in the nodes that prefix() counts.
std::uint64_t samples(const StripNodes& nodes);

}  // namespace bandsaw
