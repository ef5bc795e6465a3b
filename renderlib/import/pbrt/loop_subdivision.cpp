// Computes Loop's subdivision surfaces, for pbrt's shape loopsubdiv. Each level splits every
// triangle into four. An old vertex moves to a weighted mean of itself and its neighbours. A new
// vertex is a weighted mean of the ends of an edge and of the two vertices opposite to the edge.
// After the last level, the vertices move to their limits, at which the normal is the cross product
// of two tangents. The weights are from Loop 1987. The weights on boundaries and for limits are
// from Hoppe et al. 1994, "Piecewise Smooth Surface Reconstruction", appendix A.

#include <algorithm>
#include <cmath>
#include <map>

#include "absl/strings/str_cat.h"
#include "renderlib/import/pbrt/mesh_shapes.h"
#include "renderlib/math/elementary.h"
#include "renderlib/math/float3.h"

namespace bandsaw::pbrt {
namespace {

using Triangle = std::array<std::uint32_t, 3>;
constexpr std::size_t kMaxTriangles = 50'000'000;

/// An edge between the vertices with the indices a < b, and the vertices opposite to the edge.
struct Edge {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  std::uint32_t opposite[2] = {};
  int triangles = 0;  ///< number of triangles with this edge
};

/// Which vertices of a mesh are neighbours, and which are on a boundary.
struct Topology {
  std::map<std::pair<std::uint32_t, std::uint32_t>, Edge> edges;
  /// The neighbours of each vertex, in order around it. The ring of a vertex on the boundary is
  /// open: it runs from one neighbour on the boundary to the other.
  std::vector<std::vector<std::uint32_t>> rings;
  std::vector<bool> is_boundary;
};

/// Returns the key of an edge in Topology::edges.
std::pair<std::uint32_t, std::uint32_t> key_of(std::uint32_t a, std::uint32_t b) {
  return {std::min(a, b), std::max(a, b)};
}

/// Lists the neighbours of a vertex in order around it. For each triangle of the vertex, `next`
/// maps the corner after the vertex to the corner before it. Sets `is_open` to true if the vertex
/// is on the boundary. Returns false if the triangles do not form a single ring.
bool walk_ring(const std::map<std::uint32_t, std::uint32_t>& next, std::vector<std::uint32_t>& ring,
               bool& is_open) {
  std::map<std::uint32_t, bool> has_predecessor;
  for (const auto& [from, to] : next) {
    has_predecessor[to] = true;
  }
  std::uint32_t at = next.begin()->first;
  is_open = false;
  for (const auto& [from, to] : next) {
    if (!has_predecessor.count(from)) {
      at = from;
      is_open = true;
      break;
    }
  }
  for (std::size_t i = 0; i < next.size(); ++i) {
    ring.push_back(at);
    const auto found = next.find(at);
    if (found == next.end()) {
      return false;
    }
    at = found->second;
  }
  if (is_open) {
    ring.push_back(at);
  }
  return is_open || at == ring.front();
}

/// Returns the edges and rings of a mesh with `points` vertices. Returns INVALID_ARGUMENT if the
/// mesh is not a manifold.
absl::StatusOr<Topology> topology_of(std::size_t points, const std::vector<Triangle>& triangles) {
  Topology out;
  std::vector<std::map<std::uint32_t, std::uint32_t>> next(points);
  for (const Triangle& t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k];
      const std::uint32_t b = t[(k + 1) % 3];
      const std::uint32_t c = t[(k + 2) % 3];
      Edge& edge = out.edges[key_of(a, b)];
      edge.a = std::min(a, b);
      edge.b = std::max(a, b);
      if (edge.triangles == 2 || a == b || !next[a].emplace(b, c).second) {
        return absl::InvalidArgumentError("the mesh is not a manifold: it cannot be subdivided");
      }
      edge.opposite[edge.triangles++] = c;
    }
  }
  out.rings.resize(points);
  out.is_boundary.resize(points);
  for (std::size_t v = 0; v < points; ++v) {
    bool is_open = true;
    if (!next[v].empty() && !walk_ring(next[v], out.rings[v], is_open)) {
      return absl::InvalidArgumentError("the mesh is not a manifold: it cannot be subdivided");
    }
    out.is_boundary[v] = is_open;
  }
  return out;
}

/// Returns Loop's weight of each neighbour of an inner vertex with `valence` neighbours.
double weight_of(std::size_t valence) {
  return valence == 3 ? 3.0 / 16 : 3.0 / (8.0 * static_cast<double>(valence));
}

/// Returns the weighted mean of vertex `v` and its neighbours. For an inner vertex p with n
/// neighbours it is (1 - n w) p + w (sum of the neighbours), where w is `inner_weight`. On the
/// boundary it is (1 - 2 w) p + w (sum of both ends of the ring), where w is `boundary_weight`.
Vec3 averaged(const std::vector<Vec3>& points, const Topology& topology, std::size_t v,
              double inner_weight, double boundary_weight) {
  const auto& ring = topology.rings[v];
  if (ring.empty()) {
    return points[v];
  }
  if (topology.is_boundary[v]) {
    return points[v] * (1 - 2 * boundary_weight) +
           (points[ring.front()] + points[ring.back()]) * boundary_weight;
  }
  Vec3 sum = points[v] * (1 - static_cast<double>(ring.size()) * inner_weight);
  for (const std::uint32_t neighbour : ring) {
    sum = sum + points[neighbour] * inner_weight;
  }
  return sum;
}

/// Replaces the mesh by the next level, in which each triangle is split into four.
void subdivide(std::vector<Vec3>& points, std::vector<Triangle>& triangles,
               const Topology& topology) {
  std::vector<Vec3> finer;
  for (std::size_t v = 0; v < points.size(); ++v) {
    const std::size_t valence = std::max<std::size_t>(topology.rings[v].size(), 1);
    finer.push_back(averaged(points, topology, v, weight_of(valence), 1.0 / 8));
  }
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
  for (const auto& [key, edge] : topology.edges) {
    const Vec3 ends = points[edge.a] + points[edge.b];
    middles[key] = static_cast<std::uint32_t>(finer.size());
    finer.push_back(edge.triangles == 1
                        ? ends * 0.5
                        : ends * (3.0 / 8) +
                              (points[edge.opposite[0]] + points[edge.opposite[1]]) * (1.0 / 8));
  }
  std::vector<Triangle> split;
  for (const Triangle& t : triangles) {
    const std::uint32_t m[3] = {middles[key_of(t[0], t[1])], middles[key_of(t[1], t[2])],
                                middles[key_of(t[2], t[0])]};
    split.insert(split.end(), {Triangle{t[0], m[0], m[2]}, Triangle{m[0], t[1], m[1]},
                               Triangle{m[2], m[1], t[2]}, Triangle{m[0], m[1], m[2]}});
  }
  points = std::move(finer);
  triangles = std::move(split);
}

/// Returns the normal of the limit surface at vertex `v`, not normalized: the cross product of two
/// tangents. `points` are the limits of the vertices.
Vec3 limit_normal(const std::vector<Vec3>& points, const Topology& topology, std::size_t v) {
  const auto& ring = topology.rings[v];
  Vec3 s;
  Vec3 t;
  const std::size_t n = ring.size();
  if (!topology.is_boundary[v]) {
    for (std::size_t i = 0; i < n; ++i) {
      const SinCos at = sincos_turns(static_cast<double>(i) / static_cast<double>(n));
      s = s + points[ring[i]] * at.cos;
      t = t + points[ring[i]] * at.sin;
    }
    return cross(s, t);
  }
  s = points[ring.front()] - points[ring.back()];
  if (n == 2) {
    t = points[ring[0]] + points[ring[1]] - points[v] * 2;
  } else if (n == 3) {
    t = points[ring[1]] - points[v];
  } else if (n == 4) {
    t = points[ring[0]] * -1 + points[ring[1]] * 2 + points[ring[2]] * 2 + points[ring[3]] * -1 -
        points[v] * 2;
  } else {
    const double turns = 0.5 / static_cast<double>(n - 1);
    const SinCos one = sincos_turns(turns);
    t = (points[ring.front()] + points[ring.back()]) * one.sin;
    for (std::size_t i = 1; i + 1 < n; ++i) {
      const double sine = sincos_turns(static_cast<double>(i) * turns).sin;
      t = t + points[ring[i]] * ((2 * one.cos - 2) * sine);
    }
    t = -t;
  }
  return cross(s, t);
}

}  // namespace

absl::StatusOr<PlyMesh> subdivided(const std::vector<Vec3>& points,
                                   const std::vector<Triangle>& triangles, int levels) {
  std::vector<Vec3> p = points;
  std::vector<Triangle> t = triangles;
  for (int level = 0; level <= levels; ++level) {
    auto topology = topology_of(p.size(), t);
    if (!topology.ok()) {
      return topology.status();
    }
    if (level < levels) {
      if (t.size() > kMaxTriangles / 4) {
        return absl::ResourceExhaustedError(
            absl::StrCat("subdivision makes more than ", kMaxTriangles, " triangles"));
      }
      subdivide(p, t, *topology);
      continue;
    }
    std::vector<Vec3> limit;
    for (std::size_t v = 0; v < p.size(); ++v) {
      const std::size_t valence = std::max<std::size_t>(topology->rings[v].size(), 1);
      const double gamma = 1 / (static_cast<double>(valence) + 3 / (8 * weight_of(valence)));
      limit.push_back(averaged(p, *topology, v, gamma, 1.0 / 5));
    }
    PlyMesh mesh;
    mesh.triangles = t;
    for (std::size_t v = 0; v < p.size(); ++v) {
      Vec3 normal{0, 0, 1};
      if (!topology->rings[v].empty()) {
        const Vec3 n = limit_normal(limit, *topology, v);
        normal = length(n) > 0 ? normalize(n) : normal;
      }
      mesh.positions.push_back(float3(limit[v]));
      mesh.normals.push_back(float3(normal));
    }
    return mesh;
  }
  return absl::InternalError("unreachable");
}

}  // namespace bandsaw::pbrt
