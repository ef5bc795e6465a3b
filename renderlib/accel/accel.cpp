// The BVHs have two levels. Each mesh and each group of shapes has a BVH (top_tree.h, Prototype).
// Above them, one tree contains the loose shapes (those of no mesh and no group) and the instances
// that rest, and another tree the instances that move. A query (query.h) traces the tree of the
// loose shapes, and then, if there are moving instances, the tree of these instances.

#include "renderlib/accel/accel.h"

#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "renderlib/accel/disable_culling.h"
#include "renderlib/accel/moving_tree.h"
#include "renderlib/accel/query.h"
#include "renderlib/accel/top_tree.h"
#include "renderlib/accel/trace.h"
#include "renderlib/geometry/placement.h"

namespace bandsaw {
namespace {

/// Places the instance at the ray's time and traces the ray through it. Returns true if the query
/// is finished.
template <class Query>
bool trace_moving_instance(const MovingInstance& moving, const Geometry& geometry, const Ray& ray,
                           Query& query) {
  const Instance& instance = geometry.instances[moving.instance - 1];
  const Transform to_world = to_world_at(geometry, instance, ray.time);
  if (moving.slides) {
    // The instance is only translated, so the linear part of its inverse is known. The result has
    // the same bits as that of inverse().
    Transform to_object = moving.to_object;
    const Vec3 back = -to_object.direction({to_world.m[0][3], to_world.m[1][3], to_world.m[2][3]});
    to_object.m[0][3] = back.x;
    to_object.m[1][3] = back.y;
    to_object.m[2][3] = back.z;
    return trace_placed(moving.prototype, to_object, geometry.shutter, ray, moving.instance, query);
  }
  const std::optional<Transform> to_object = inverse(to_world);
  return to_object &&
         trace_placed(moving.prototype, *to_object, geometry.shutter, ray, moving.instance, query);
}

/// Traces the ray through the moving instances at the ray's time. Returns true if the query is
/// finished. The function is not inlined, so that scenes without motion run the same machine code
/// as if motion were not supported.
template <class Query>
[[gnu::noinline]] bool trace_moving(const MovingTree& tree, const Geometry& geometry,
                                    const Ray& ray, Query& query) {
  if (!is_traceable(ray)) {
    return false;
  }
  const FloatRay floats(trace_setup(ray.origin, ray.direction, ray.t_max), tree.tree.reach);
  float bound = floats.above(query.bound());
  const float share = ShutterTime(geometry.shutter, ray.time).share;
  const auto enter = [&](std::uint32_t node, Float8& at) {
    return enter_moving_children(tree.tree, tree.changes, node, share, floats, bound, at);
  };
  return traverse<!Query::kAny>(tree.tree, bound, enter, [&](ChildRef leaf) {
    const bool stop = trace_moving_instance(tree.moving[leaf.leaf_index()], geometry, ray, query);
    bound = floats.above(query.bound());
    return stop;
  });
}

/// BVHs of meshes with at least this many triangles are built one after another, each by all
/// threads. BVHs of smaller meshes are built in parallel, each by one thread. The trees do not
/// depend on this number.
constexpr std::size_t kLargeMesh = std::size_t{1} << 15;

/// BVHs of meshes, keyed by the mesh.
using KnownTrees = std::map<const Mesh*, std::shared_ptr<const MeshTree>>;

/// Builds the BVH of a mesh. If `culls` is false, rays will test all primitives
/// (disable_culling.h).
MeshTree build_tree_of(const Mesh& mesh, bool culls, Pool* pool) {
  MeshTree tree = build_mesh_tree(mesh, pool);
  if (!culls) {
    disable_culling(tree.tree, tree.changes);
  }
  return tree;
}

/// Returns the BVH of each mesh: the one in `known` if there is one, otherwise a new one.
std::vector<std::shared_ptr<const MeshTree>> build_meshes(const MeshList& meshes,
                                                          const KnownTrees& known, bool culls,
                                                          Pool& pool) {
  std::vector<std::shared_ptr<const MeshTree>> trees(meshes.size());
  const auto build = [&](std::size_t mesh, Pool* threads) {
    trees[mesh] = std::make_shared<const MeshTree>(build_tree_of(meshes[mesh], culls, threads));
  };
  pool.parallel_for(static_cast<std::int64_t>(meshes.size()), [&](std::int64_t i) {
    const auto mesh = static_cast<std::size_t>(i);
    if (const auto found = known.find(&meshes[mesh]); found != known.end()) {
      trees[mesh] = found->second;
    } else if (meshes[mesh].triangles.size() < kLargeMesh) {
      build(mesh, nullptr);
    }
  });
  for (std::size_t mesh = 0; mesh < meshes.size(); ++mesh) {
    if (trees[mesh] == nullptr) {
      build(mesh, &pool);
    }
  }
  return trees;
}

std::vector<ShapesTree> build_groups(const std::vector<Shapes>& groups, Pool& pool) {
  std::vector<ShapesTree> trees(groups.size());
  pool.parallel_for(static_cast<std::int64_t>(groups.size()), [&](std::int64_t i) {
    const auto group = static_cast<std::size_t>(i);
    trees[group] = build_shapes_tree(groups[group], nullptr);
  });
  return trees;
}

}  // namespace

struct Accel::Trees {
  const Geometry* geometry = nullptr;
  Prototypes prototypes;
  TopTree top;
  MovingTree moving;

  /// Returns true if the query is finished.
  template <class Query>
  bool intersect(const Ray& ray, Query& query) const {
    return trace(top, *geometry, ray, query) ||
           (!moving.tree.empty && trace_moving(moving, *geometry, ray, query));
  }

  void add_trees_to(KnownTrees& known) const {
    for (std::size_t mesh = 0; mesh < prototypes.meshes.size(); ++mesh) {
      known.emplace(&geometry->meshes[mesh], prototypes.meshes[mesh]);
    }
  }

  /// Disables culling in the BVHs of groups and of the top level. build_meshes() has done so in the
  /// BVHs of meshes.
  void disable_culling() {
    for (ShapesTree& group : prototypes.groups) {
      bandsaw::disable_culling(group.tree);
    }
    bandsaw::disable_culling(top.tree);
    bandsaw::disable_culling(moving.tree, moving.changes);
  }
};

Accel::Accel(std::unique_ptr<Trees> trees) : trees_(std::move(trees)) {}
Accel::Accel(Accel&&) noexcept = default;
Accel& Accel::operator=(Accel&&) noexcept = default;
Accel::~Accel() = default;

Accel Accel::build(const Geometry& geometry, Pool& pool, Traversal traversal,
                   absl::Span<const Accel* const> earlier) {
  const bool culls = traversal == Traversal::kBvh;
  KnownTrees known;
  for (const Accel* accel : culls ? earlier : absl::Span<const Accel* const>()) {
    accel->trees_->add_trees_to(known);
  }
  auto trees = std::make_unique<Trees>();
  trees->geometry = &geometry;
  Prototypes& prototypes = trees->prototypes;
  prototypes.meshes = build_meshes(geometry.meshes, known, culls, pool);
  prototypes.groups = build_groups(geometry.groups, pool);
  trees->top = build_top_tree(geometry, prototypes, &pool);
  trees->moving = build_moving_tree(geometry, prototypes, &pool);
  if (!culls) {
    trees->disable_culling();
  }
  return Accel(std::move(trees));
}

Hit Accel::closest(const Ray& ray) const {
  ClosestQuery query(ray);
  trees_->intersect(ray, query);
  return query.result();
}

Hit Accel::closest_after(const Ray& ray, const Hit& after) const {
  AfterQuery query(ray, after);
  trees_->intersect(ray, query);
  return query.result();
}

bool Accel::occluded(const Ray& ray) const {
  AnyQuery query(ray);
  return trees_->intersect(ray, query);
}

std::size_t Accel::bytes() const {
  std::size_t sum = trees_->top.bytes() + trees_->moving.bytes();
  for (const std::shared_ptr<const MeshTree>& mesh : trees_->prototypes.meshes) {
    sum += mesh->bytes();
  }
  for (const ShapesTree& group : trees_->prototypes.groups) {
    sum += group.bytes();
  }
  return sum;
}

}  // namespace bandsaw
