#pragma once

// The meshes of a glTF file rewritten for a plain one.

#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "absl/status/statusor.h"
#include "renderlib/import/gltf/draco_mesh.h"
#include "renderlib/import/gltf/gltf_buffers.h"
#include "renderlib/import/gltf/plain_buffer.h"

namespace bandsaw::gltf {

class PlainMeshes {
 public:
  /// All outlive this. `root` is that of the file as it came.
  PlainMeshes(const Json& root, Buffers& buffers, PlainBuffer& out)
      : root_(root), buffers_(buffers), out_(out) {}

  /// meshes[index] with accessors of `out`. Attributes that glTF does not define and tangents are
  /// left out. INVALID_ARGUMENT: counts or types of attributes do not fit, an index is not below
  /// the number of vertices.
  absl::StatusOr<Json> mesh(std::size_t index);

  /// The joints that the vertices of meshes[index] name with a weight that is not zero are below
  /// this number; 0 of a mesh that mesh() has not been called for.
  std::uint32_t joints_of(std::size_t index) const;

 private:
  /// An accessor of `out`.
  struct Added {
    std::size_t accessor = 0;
    std::size_t count = 0;
    std::uint32_t largest = 0;  ///< of indices
  };
  /// A Draco stream and the numbers of its attributes; nothing of another primitive.
  struct Stream {
    std::optional<DracoMesh> mesh;
    const Json* attributes = nullptr;
  };

  absl::StatusOr<Json> primitive(const Json& from, const std::string& place, std::uint32_t& joints);
  absl::StatusOr<Stream> stream_of(const Json& primitive, const std::string& place);
  absl::StatusOr<Json> attributes(const Json& from, const Stream& stream, const std::string& place,
                                  std::optional<std::size_t>& vertices, std::uint32_t& joints);
  absl::StatusOr<Added> floats(const std::string& name, std::size_t accessor, const Stream& stream,
                               const std::string& place);
  absl::StatusOr<Added> joints_with_weight(const Json& attributes, const std::string& name,
                                           const Stream& stream, const std::string& place,
                                           std::uint32_t& joints);
  absl::StatusOr<Added> indices(std::size_t accessor, const std::string& place);
  absl::StatusOr<std::vector<float>> float_values(const std::string& name, std::size_t accessor,
                                                  const AccessorShape& shape, const Stream& stream);

  const Json& root_;
  Buffers& buffers_;
  PlainBuffer& out_;
  /// What has been added, by the file's accessor and whether it is of colours: primitives share
  /// accessors.
  std::map<std::pair<std::size_t, bool>, Added> floats_;
  std::map<std::size_t, Added> indices_;
  std::map<std::size_t, std::uint32_t> joints_;
};

}  // namespace bandsaw::gltf
