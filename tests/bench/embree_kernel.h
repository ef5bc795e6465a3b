#pragma once

// Gives Embree the same two ray queries as Accel, the renderer's own BVHs, so that their speeds can
// be compared. A build without BANDSAW_EMBREE has no Embree.

#include <memory>

#include "renderlib/geometry/ray.h"
#include "renderlib/geometry/shapes.h"

namespace bandsaw::bench {

/// One mesh in Embree. kernel_bench traces the same rays through it and through Accel.
class EmbreeKernel {
 public:
  /// Builds the BVH. Returns nullptr if built without Embree. `robust`: Embree's flag for tests
  /// without gaps between triangles. `config` configures the device: "isa=avx2,threads=2".
  static std::unique_ptr<EmbreeKernel> create(const Mesh& mesh, bool robust, const char* config);
  ~EmbreeKernel();

  /// Both functions return whether the ray hits the mesh. `closest` searches for the closest hit,
  /// and `occluded` for any hit.
  bool closest(const Ray& ray) const;
  bool occluded(const Ray& ray) const;
  double build_seconds() const;  ///< wall clock
  long long bytes() const;       ///< memory that the build has allocated and kept

 private:
  struct State;
  explicit EmbreeKernel(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace bandsaw::bench
