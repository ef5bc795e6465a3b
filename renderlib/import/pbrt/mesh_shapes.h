#pragma once

// Shapes of pbrt as triangle meshes, in their own space.

#include "absl/status/statusor.h"
#include "renderlib/import/convert/ply_mesh.h"
#include "renderlib/import/pbrt/builder.h"

namespace bandsaw::pbrt {

/// Returns the mesh of a shape of kind trianglemesh, loopsubdiv, bilinearmesh, plymesh, or a
/// quadric (sphere, disk, cylinder). Its triangles are oriented as pbrt's normals are without
/// ReverseOrientation. INVALID_ARGUMENT: its parameters are wrong; std::nullopt after a warning:
/// the file is missing, or no triangle is left.
absl::StatusOr<std::optional<PlyMesh>> mesh_of(const std::string& type,
                                               const Parameters& parameters, Builder& builder);

/// Returns Loop's subdivision of a closed or open manifold mesh, its vertices at their limits and
/// with limit normals (Loop 1987; Hoppe et al. 1994, appendix A). `levels` in [0, 8].
/// INVALID_ARGUMENT: an edge with more than two triangles. RESOURCE_EXHAUSTED: it becomes too
/// large.
absl::StatusOr<PlyMesh> subdivided(const std::vector<Vec3>& points,
                                   const std::vector<std::array<std::uint32_t, 3>>& triangles,
                                   int levels);

/// Returns true if each edge belongs to two triangles that run along it in opposite directions.
/// Points at the same position count as one.
bool is_closed(const PlyMesh& mesh);
/// Returns six times the volume that a closed mesh encloses; negative if its triangles face
/// inwards.
double signed_volume(const PlyMesh& mesh);

/// Makes all triangles face the other way.
void reverse(PlyMesh& mesh);

}  // namespace bandsaw::pbrt
