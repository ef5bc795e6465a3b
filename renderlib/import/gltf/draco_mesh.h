#pragma once

// A primitive of KHR_draco_mesh_compression, decoded by libdraco.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "renderlib/import/gltf/gltf_accessor.h"

namespace draco {
class Mesh;
class PointAttribute;
}  // namespace draco

namespace bandsaw::gltf {

class DracoMesh {
 public:
  /// `place` begins its messages. INVALID_ARGUMENT: not a mesh, or damaged.
  static absl::StatusOr<DracoMesh> decode(absl::string_view bytes, std::string place);
  DracoMesh(DracoMesh&&) noexcept;
  DracoMesh& operator=(DracoMesh&&) noexcept;
  ~DracoMesh();

  /// How many vertices every attribute has.
  std::size_t vertices() const;
  /// Three for each triangle, each below vertices().
  std::vector<std::uint32_t> indices() const;
  /// The attribute that the stream numbers `id`, as many components of it as `shape` has; integers
  /// as `shape` says they are normalised. INVALID_ARGUMENT: there is no such attribute, it has
  /// fewer components, or its count is not that of `shape`.
  absl::StatusOr<std::vector<float>> floats(std::size_t id, const AccessorShape& shape) const;
  /// The same for integers that are not negative.
  absl::StatusOr<std::vector<std::uint32_t>> whole_numbers(std::size_t id,
                                                           const AccessorShape& shape) const;

 private:
  DracoMesh(std::unique_ptr<draco::Mesh> mesh, std::string place);
  absl::StatusOr<const draco::PointAttribute*> attribute(std::size_t id,
                                                         const AccessorShape& shape) const;

  std::unique_ptr<draco::Mesh> mesh_;
  std::string place_;
};

}  // namespace bandsaw::gltf
