#pragma once

// Reads triangle meshes of Mitsuba's formats, with the normals and uvs that Mitsuba gives them.

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "renderlib/import/convert/ply_mesh.h"

namespace bandsaw::mitsuba {

struct SourceMesh {
  /// With Mitsuba's uv coordinates: v = 0 is the top row of an image. No normals if the file has
  /// none.
  PlyMesh mesh;
  std::vector<MeshAttribute> attributes;  ///< for mesh_attribute textures
  bool faceted = false;                   ///< the file requests flat triangles (face normals)
};

/// Maximum size of a mesh file, and of a mesh in memory, in bytes.
inline constexpr std::uint64_t kMaxMeshBytes = std::uint64_t{4} << 30;

/// Reads a Wavefront OBJ: vertices, normals, uvs and polygons; materials and groups are ignored.
/// If `flip_v` is set, v = 0 is the bottom row in the file, as is usual in OBJ files, and each v
/// becomes 1 - v. An error is INVALID_ARGUMENT and names the line.
absl::StatusOr<SourceMesh> read_obj(absl::string_view bytes, bool flip_v);
/// Reads a PLY (convert/read_ply.h). `flip_v` means the same as in read_obj(). Returns
/// INVALID_ARGUMENT if the file is damaged.
absl::StatusOr<SourceMesh> read_ply(absl::string_view bytes, bool flip_v);
/// Reads the mesh number `index`, counted from 0, of a *.serialized file of Mitsuba. `flip_v` means
/// the same as in read_obj(). Returns INVALID_ARGUMENT if the file is damaged or has no such mesh.
absl::StatusOr<SourceMesh> read_serialized(absl::string_view bytes, std::int64_t index,
                                           bool flip_v);

/// Sets the normal of each vertex to the mean of the normals of its triangles, weighted by their
/// angles at the vertex (Thürmer and Wüthrich 1998).
void add_smooth_normals(PlyMesh& mesh);
/// Turns each triangle whose geometric normal is opposite to the normals of its vertices.
void orient_by_normals(PlyMesh& mesh);
/// Turns all triangles and normals to the other side.
void turn_over(PlyMesh& mesh);
/// Returns true if u, v and the normal are a left-handed system on more than half of the surface.
bool has_left_handed_uvs(const PlyMesh& mesh);

}  // namespace bandsaw::mitsuba
