// Counts the open edges of a mesh. Each triangle passes its edges in the order of its vertices. An
// edge is open if the triangles do not pass it equally often in both directions. Vertices at the
// same position count as one.

#include "renderlib/geometry/closed.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "renderlib/geometry/deforming_mesh.h"

namespace bandsaw {
namespace {

/// Returns a representative for each vertex: the vertex of lowest index among those that have the
/// same position at all times.
std::vector<std::uint32_t> welded(const Mesh& mesh) {
  const auto place = [&](std::uint32_t vertex) {
    return std::pair(mesh.positions[vertex],
                     deforms(mesh) ? mesh.positions_at_close[vertex] : std::array<float, 3>{});
  };
  std::vector<std::uint32_t> order(mesh.positions.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(place(a), a) < std::pair(place(b), b);
  });
  std::vector<std::uint32_t> representative(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && place(order[i]) == place(order[i - 1]);
    representative[order[i]] = same ? representative[order[i - 1]] : order[i];
  }
  return representative;
}

struct Edge {
  std::uint32_t low;
  std::uint32_t high;
  int upwards;  ///< +1 from low to high, -1 in the other direction
};

bool same_place(const Edge& a, const Edge& b) { return a.low == b.low && a.high == b.high; }

}  // namespace

std::size_t open_edges(const Mesh& mesh) {
  const std::vector<std::uint32_t> representative = welded(mesh);
  std::vector<Edge> edges;
  edges.reserve(mesh.triangles.size() * 3);
  for (const std::array<std::uint32_t, 3>& triangle : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t from = representative[triangle[i]];
      const std::uint32_t to = representative[triangle[(i + 1) % 3]];
      if (from != to) {
        edges.push_back({std::min(from, to), std::max(from, to), from < to ? 1 : -1});
      }
    }
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return a.low != b.low ? a.low < b.low : a.high < b.high;
  });
  std::size_t open = 0;
  for (std::size_t i = 0; i < edges.size();) {
    int sum = 0;
    std::size_t next = i;
    for (; next < edges.size() && same_place(edges[i], edges[next]); ++next) {
      sum += edges[next].upwards;
    }
    open += sum != 0 ? 1 : 0;
    i = next;
  }
  return open;
}

}  // namespace bandsaw
