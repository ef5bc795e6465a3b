#pragma once

// Decodes primitives of KHR_draco_mesh_compression with libdraco.

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
  /// Decodes the stream `bytes`. Messages begin with `place`, the path of the primitive in the
  /// file. Returns INVALID_ARGUMENT if the stream is damaged or is not a mesh.
  static absl::StatusOr<DracoMesh> decode(absl::string_view bytes, std::string place);
  DracoMesh(DracoMesh&&) noexcept;
  DracoMesh& operator=(DracoMesh&&) noexcept;
  ~DracoMesh();

  /// Returns the number of vertices, which all attributes share.
  std::size_t vertices() const;
  /// Returns three indices for each triangle, each below vertices().
  std::vector<std::uint32_t> indices() const;
  /// Returns the values of the attribute with the number `id` in the stream, `shape.components`
  /// floats for each vertex. Integers are normalised as `shape` says. Returns INVALID_ARGUMENT if
  /// there is no such attribute, if it has fewer components than `shape`, or if the count of
  /// `shape` is not vertices().
  absl::StatusOr<std::vector<float>> floats(std::size_t id, const AccessorShape& shape) const;
  /// Does the same as floats() for an attribute of integers, and clamps the values to
  /// [0, 2^32 - 1]. Returns INVALID_ARGUMENT also for an attribute of floats.
  absl::StatusOr<std::vector<std::uint32_t>> whole_numbers(std::size_t id,
                                                           const AccessorShape& shape) const;

 private:
  DracoMesh(std::unique_ptr<draco::Mesh> mesh, std::string place);
  /// Returns the attribute with the number `id`. Returns INVALID_ARGUMENT if there is none, if it
  /// has not 1 to 4 components, or if the count of `shape` is not vertices().
  absl::StatusOr<const draco::PointAttribute*> attribute(std::size_t id,
                                                         const AccessorShape& shape) const;

  std::unique_ptr<draco::Mesh> mesh_;
  std::string place_;  ///< begins messages
};

}  // namespace bandsaw::gltf
