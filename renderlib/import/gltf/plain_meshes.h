#pragma once

// Rewrites the meshes of a glTF file so that their arrays lie in one buffer and have one type each:
// attributes are floats, except for joints, which are 16-bit integers; indices are 32-bit.

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "renderlib/import/gltf/draco_mesh.h"
#include "renderlib/import/gltf/gltf_buffers.h"
#include "renderlib/import/gltf/plain_buffer.h"

namespace bandsaw::gltf {

class PlainMeshes {
 public:
  /// All arguments MUST outlive this object. `root` is the JSON of the original file.
  PlainMeshes(const Json& root, Buffers& buffers, PlainBuffer& out)
      : root_(root), buffers_(buffers), out_(out) {}

  /// Adds the arrays of meshes[index] of the file to `out`, and returns the mesh with the numbers
  /// of the new accessors. Omits tangents and attributes that glTF does not define. Returns
  /// INVALID_ARGUMENT if counts or types of attributes do not match, or if an index is not below
  /// the number of vertices.
  absl::StatusOr<Json> mesh(std::size_t index);

  /// Returns 1 + the largest joint to which a vertex of meshes[index] refers with a weight other
  /// than zero. Returns 0 if there is no such joint, or if mesh(index) has not been called.
  std::uint32_t joints_of(std::size_t index) const;

 private:
  /// An accessor of `out`.
  struct Added {
    std::size_t accessor = 0;
    std::size_t count = 0;
    std::uint32_t largest = 0;  ///< largest index, if the accessor holds indices
  };
  /// The decoded Draco stream of a primitive; empty for a primitive that is not compressed.
  struct Stream {
    std::optional<DracoMesh> mesh;
    const Json* attributes = nullptr;  ///< numbers of the stream's attributes, keyed by name
  };

  // Steps of mesh(), described at their definitions. `place` names the primitive in messages.
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
  /// Added accessors, keyed by the file's accessor and by whether it contains colours. They are
  /// kept because primitives share accessors.
  std::map<std::pair<std::size_t, bool>, Added> floats_;
  std::map<std::size_t, Added> indices_;         ///< added indices, keyed by the file's accessor
  std::map<std::size_t, std::uint32_t> joints_;  ///< results of joints_of()
};

}  // namespace bandsaw::gltf
