#pragma once

// Converts shapes of pbrt to triangle meshes, in the shapes' own space.

#include "absl/status/statusor.h"
#include "renderlib/import/convert/ply_mesh.h"
#include "renderlib/import/pbrt/builder.h"

namespace bandsaw::pbrt {

/// Returns the mesh of a shape of kind trianglemesh, loopsubdiv, bilinearmesh, plymesh, or a
/// quadric (sphere, disk, cylinder). The triangles face to the side of pbrt's normals.
/// ReverseOrientation is not applied. Returns std::nullopt, after a warning, if the file is missing
/// or no triangle is left. The error is INVALID_ARGUMENT if the parameters are wrong.
absl::StatusOr<std::optional<PlyMesh>> mesh_of(const std::string& type,
                                               const Parameters& parameters, Builder& builder);

/// Returns Loop's subdivision of a closed or open manifold mesh after `levels` levels, in [0, 8].
/// The vertices lie on the limit surface, to which further levels would converge, and have the
/// normals of the limit surface (Loop 1987; Hoppe et al. 1994, appendix A). The error is
/// INVALID_ARGUMENT for a mesh that is no manifold, and RESOURCE_EXHAUSTED for one that becomes too
/// large.
absl::StatusOr<PlyMesh> subdivided(const std::vector<Vec3>& points,
                                   const std::vector<std::array<std::uint32_t, 3>>& triangles,
                                   int levels);

/// Returns true if each edge has as many triangles that traverse it in one direction as triangles
/// that traverse it in the opposite direction. Vertices at the same position count as one.
bool is_closed(const PlyMesh& mesh);
/// Returns six times the volume that a closed mesh encloses; negative if its triangles face
/// inwards.
double signed_volume(const PlyMesh& mesh);

/// Reverses all triangles and normals, so that the mesh faces the opposite side.
void reverse(PlyMesh& mesh);

}  // namespace bandsaw::pbrt
