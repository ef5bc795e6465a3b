#pragma once

// Builds scenes for tests: SceneMaker needs one short call per material or shape.

#include <memory>

#include "renderlib/base/pool.h"
#include "renderlib/scene/scene.h"

namespace bandsaw::test {

/// Collects the parts of a scene. An id that a call returns is valid only in the scene of the same
/// SceneMaker. A reflectance or radiance that is one number is grey. Angles are in degrees.
class SceneMaker {
 public:
  TextureId texture(Texture texture);
  MaterialId material(Material material);
  MaterialId diffuse(float reflectance);
  MaterialId diffuse(const Rgb& reflectance);
  /// Reflection adds a random point of a ball to the mirror direction. `fuzz`: radius of the ball.
  MaterialId metal(float reflectance, double fuzz);
  MaterialId glass(double index_of_refraction);
  /// `one_sided`: only the side of the normal emits.
  MaterialId lamp(float radiance, bool one_sided = false);

  void sphere(const Vec3& center, double radius, MaterialId material);
  void quad(const Vec3& corner, const Vec3& u, const Vec3& v, MaterialId material);
  /// Adds a square 100 units wide around the z axis, in the plane of this z. Its front faces +z.
  void wall(MaterialId material, double z = 0);
  void triangle(const Vec3& a, const Vec3& b, const Vec3& c, MaterialId material);
  /// Adds the mesh and one instance of it.
  void instance(Mesh mesh, const Transform& to_world, MaterialId material);
  void camera(const Vec3& position, const Vec3& look_at, double vertical_fov);
  void background(const Rgb& bottom, const Rgb& top);

  SceneDescription scene;  ///< for parts that have no call here

  /// Builds the scene, which MUST be valid; otherwise the program is aborted.
  std::shared_ptr<const Scene> build() const;
};

/// The Cornell box, 555 units wide: a quad that emits downwards and two boxes of diffuse quads.
SceneMaker cornell_box();

/// Adds a closed room of 4 x 4 x 4 around the origin with walls of one material, and a camera in
/// this room.
void add_room(SceneMaker& maker, MaterialId wall);

/// Makes the room of add_room with a spherical lamp of radiance 10 in its middle, inside a ball of
/// glass of radius 0.5. `index`: refractive index of the glass; `lamp`: radius of the lamp, below
/// 0.5; `reflectance`: reflectance of the walls.
SceneMaker lamp_in_glass(double index, double lamp, float reflectance = 0.5f);

/// A grid of n x n squares in z = 0 over [-1, 1]^2, two triangles each, normal +z.
Mesh grid(int n);

}  // namespace bandsaw::test
