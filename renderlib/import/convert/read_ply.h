#pragma once

// Reads PLY files, as text or binary of either byte order, for the converters of other renderers'
// scenes.

#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "renderlib/import/convert/ply_mesh.h"

namespace bandsaw {

struct PlyFile {
  PlyMesh mesh;  ///< without colours
  std::vector<MeshAttribute> attributes;
};

/// Reads positions (x, y, z), normals (nx, ny, nz), uvs (u, v or s, t, also with the prefix
/// "texture_"; unchanged) and faces, which are divided into fans of triangles. Other numbers of
/// vertices and faces become attributes. Numbers whose names differ only after the last "_" form
/// one attribute ("color_0", "color_1", "color_2"), and so do "r", "g", "b" and "red", "green",
/// "blue". A group of two, or of more than three numbers, is skipped. In attributes, unsigned bytes
/// are divided by 255. Elements that are neither vertices nor faces are skipped. The error is
/// INVALID_ARGUMENT if the file is damaged, lacks elements that its header announces, has no face,
/// has a face whose index names no vertex, or has a vertex with a number that is not finite.
absl::StatusOr<PlyFile> read_ply(absl::string_view bytes);

}  // namespace bandsaw
