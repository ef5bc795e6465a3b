#pragma once

// Reads PLY files: text, and binary of either byte order.

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "renderlib/import/convert/ply_mesh.h"

namespace bandsaw {

/// Reads positions, normals (nx, ny, nz), uvs (u, v or s, t) and faces, which are divided into fans
/// of triangles. Other properties and elements are skipped. INVALID_ARGUMENT: it is broken, claims
/// more than it holds, has an index of no vertex, a position that is not finite, or no face.
absl::StatusOr<PlyMesh> read_ply(absl::string_view bytes);

}  // namespace bandsaw
