#pragma once

// The nodes of the summation tree (render/band.h) that a film has of a strip of pixels.

#include <cstdint>
#include <vector>

#include "renderlib/render/band.h"
#include "renderlib/render/row_store.h"

namespace bandsaw {

struct Node {
  SampleRange range;
  RowStore::Slot slot = 0;
};

/// In order of their samples; none overlap.
using StripNodes = std::vector<Node>;

/// Adds a node that overlaps none, and merges siblings as far as the halves that the error estimate
/// needs allow.
void insert_node(const Node& node, StripNodes& nodes, RowStore& store);

/// How many nodes from the first sample on follow each other without a gap.
std::size_t prefix(const StripNodes& nodes);

/// Whether these begin with two of equally many samples.
bool has_halves(const StripNodes& nodes);

/// How many samples these are.
std::uint64_t samples(const StripNodes& nodes);

}  // namespace bandsaw
