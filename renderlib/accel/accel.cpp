#include "renderlib/accel/accel.h"

#include <utility>
#include <vector>

#include "renderlib/accel/disable_culling.h"
#include "renderlib/accel/query.h"
#include "renderlib/accel/top_tree.h"
#include "renderlib/accel/trace.h"
#include "renderlib/accel/trace_moving.h"

namespace bandsaw {
namespace {

/// Larger meshes are built one after another by all threads, smaller ones in parallel, each by one
/// thread.
constexpr std::size_t kLargeMesh = std::size_t{1} << 15;

std::vector<MeshTree> build_meshes(const std::vector<Mesh>& meshes, Pool& pool) {
  std::vector<MeshTree> trees(meshes.size());
  pool.parallel_for(static_cast<std::int64_t>(meshes.size()), [&](std::int64_t i) {
    const auto mesh = static_cast<std::size_t>(i);
    if (meshes[mesh].triangles.size() < kLargeMesh) {
      trees[mesh] = build_mesh_tree(meshes[mesh], nullptr);
    }
  });
  for (std::size_t mesh = 0; mesh < meshes.size(); ++mesh) {
    if (meshes[mesh].triangles.size() >= kLargeMesh) {
      trees[mesh] = build_mesh_tree(meshes[mesh], &pool);
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

  void disable_culling() {
    for (MeshTree& mesh : prototypes.meshes) {
      bandsaw::disable_culling(mesh.tree);
    }
    for (ShapesTree& group : prototypes.groups) {
      bandsaw::disable_culling(group.tree);
    }
    bandsaw::disable_culling(top.tree);
    bandsaw::disable_culling(moving);
  }
};

Accel::Accel(std::unique_ptr<Trees> trees) : trees_(std::move(trees)) {}
Accel::Accel(Accel&&) noexcept = default;
Accel& Accel::operator=(Accel&&) noexcept = default;
Accel::~Accel() = default;

Accel Accel::build(const Geometry& geometry, Pool& pool, const Interval& interval,
                   Traversal traversal) {
  auto trees = std::make_unique<Trees>();
  trees->geometry = &geometry;
  Prototypes& prototypes = trees->prototypes;
  prototypes.meshes = build_meshes(geometry.meshes, pool);
  prototypes.groups = build_groups(geometry.groups, pool);
  trees->top = build_top_tree(geometry, prototypes, &pool);
  trees->moving = build_moving_tree(geometry, prototypes, interval, &pool);
  if (traversal == Traversal::kBruteForce) {
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
  for (const MeshTree& mesh : trees_->prototypes.meshes) {
    sum += mesh.bytes();
  }
  for (const ShapesTree& group : trees_->prototypes.groups) {
    sum += group.bytes();
  }
  return sum;
}

}  // namespace bandsaw
