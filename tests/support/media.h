#pragma once

// Adds media (fog, smoke) to the scenes of tests.

#include "tests/support/scenes.h"

namespace bandsaw::test {

/// Returns a grey medium. `absorption`, `scattering`: coefficients per unit of length. `g`: the
/// parameter of the phase function of Henyey and Greenstein.
inline Medium medium(float absorption, float scattering, double g = 0) {
  return {.absorption = gray(absorption), .scattering = gray(scattering), .g = g};
}

/// Adds the medium to the scene and returns its id.
inline MediumId add(SceneMaker& maker, const Medium& medium) {
  maker.scene.media.media.push_back(medium);
  return MediumId{static_cast<std::uint32_t>(maker.scene.media.media.size() - 1)};
}

/// Fills all space that is in no other medium.
inline void fog(SceneMaker& maker, const Medium& medium) {
  maker.scene.media.fog = add(maker, medium);
}

/// Adds a sphere of medium with an invisible surface.
inline void fill_sphere(SceneMaker& maker, const Vec3& center, double radius, MediumId inside) {
  maker.scene.media.boundaries.spheres.push_back({center, radius, filled_with(inside)});
}

/// Fills a mesh, which MUST be closed, with the medium `inside`. The surface of the mesh is
/// invisible.
inline void fill_mesh(SceneMaker& maker, Mesh mesh, const Transform& to_world, MediumId inside) {
  Geometry& boundaries = maker.scene.media.boundaries;
  const MeshId id{static_cast<std::uint32_t>(boundaries.meshes.size())};
  boundaries.meshes.push_back(std::move(mesh));
  boundaries.instances.push_back({id, filled_with(inside), to_world});
}

/// Fills the box from `low` to `high` with the medium `inside`. The surface of the box is
/// invisible.
inline void fill_box(SceneMaker& maker, const Vec3& low, const Vec3& high, MediumId inside) {
  fill_mesh(maker, unit_cube(), translation(low) * scaling(high - low), inside);
}

}  // namespace bandsaw::test
