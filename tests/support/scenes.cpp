// Builds scenes for tests: the Cornell box, and SceneMaker with its short calls for each kind of
// shape and material.

#include "tests/support/scenes.h"

#include <utility>

#include "renderlib/base/check.h"

namespace bandsaw::test {
namespace {

/// Appends the value to the list and returns its index as an id.
template <class Id, class T>
Id append(std::vector<T>& list, T value) {
  list.push_back(std::move(value));
  return Id{static_cast<std::uint32_t>(list.size() - 1)};
}

/// Adds the sides and the top of a box, without its floor. `corner`: a corner of the floor; `u`,
/// `v`: the edges of the floor from this corner, both horizontal.
void add_block(SceneMaker& maker, const Vec3& corner, const Vec3& u, const Vec3& v, double height,
               MaterialId material) {
  const Vec3 up{0, height, 0};
  maker.quad(corner + up, u, v, material);
  maker.quad(corner, u, up, material);
  maker.quad(corner, v, up, material);
  maker.quad(corner + u, v, up, material);
  maker.quad(corner + v, u, up, material);
}

}  // namespace

TextureId SceneMaker::texture(Texture texture) {
  return append<TextureId>(scene.textures, std::move(texture));
}
MaterialId SceneMaker::material(Material material) {
  return append<MaterialId>(scene.materials, std::move(material));
}
MaterialId SceneMaker::diffuse(float reflectance) { return diffuse(gray(reflectance)); }
MaterialId SceneMaker::diffuse(const Rgb& reflectance) {
  return material(Diffuse{texture(ConstantTexture{reflectance})});
}
MaterialId SceneMaker::metal(float reflectance, double fuzz) {
  return material(Metal{texture(ConstantTexture{gray(reflectance)}), fuzz});
}
MaterialId SceneMaker::glass(double index_of_refraction) {
  return material(Dielectric{index_of_refraction});
}
MaterialId SceneMaker::lamp(float radiance, bool one_sided) {
  return material(Emissive{texture(ConstantTexture{gray(radiance)}), one_sided});
}

void SceneMaker::sphere(const Vec3& center, double radius, MaterialId material) {
  scene.geometry.spheres.push_back({center, radius, material});
}
void SceneMaker::quad(const Vec3& corner, const Vec3& u, const Vec3& v, MaterialId material) {
  scene.geometry.quads.push_back({corner, u, v, material});
}
void SceneMaker::wall(MaterialId material, double z) {
  quad({-50, -50, z}, {100, 0, 0}, {0, 100, 0}, material);
}

void SceneMaker::triangle(const Vec3& a, const Vec3& b, const Vec3& c, MaterialId material) {
  scene.geometry.triangles.push_back({a, b, c, material});
}
void SceneMaker::instance(Mesh mesh, const Transform& to_world, MaterialId material) {
  scene.geometry.meshes.push_back(std::move(mesh));
  const MeshId id{static_cast<std::uint32_t>(scene.geometry.meshes.size() - 1)};
  scene.geometry.instances.push_back({id, material, to_world});
}
void SceneMaker::camera(const Vec3& position, const Vec3& look_at, double vertical_fov) {
  PerspectiveCamera camera{.position = position, .look_at = look_at};
  camera.vertical_fov = vertical_fov;
  scene.camera = camera;
}
void SceneMaker::background(const Rgb& bottom, const Rgb& top) { scene.background = {bottom, top}; }

std::shared_ptr<const Scene> SceneMaker::build() const {
  Pool pool(1);
  auto built = Scene::build(scene, pool);
  BANDSAW_CHECK(built.ok(), built.status().ToString().c_str());
  return *std::move(built);
}

SceneMaker cornell_box() {
  SceneMaker maker;
  const MaterialId white = maker.diffuse(0.73f);
  const MaterialId red = maker.diffuse({0.65f, 0.05f, 0.05f});
  const MaterialId green = maker.diffuse({0.12f, 0.45f, 0.15f});
  const MaterialId lamp = maker.lamp(15, true);
  maker.quad({343, 554, 332}, {-130, 0, 0}, {0, 0, -105}, lamp);
  maker.quad({555, 0, 0}, {0, 555, 0}, {0, 0, 555}, green);
  maker.quad({0, 0, 0}, {0, 555, 0}, {0, 0, 555}, red);
  maker.quad({0, 0, 0}, {555, 0, 0}, {0, 0, 555}, white);
  maker.quad({555, 555, 555}, {-555, 0, 0}, {0, 0, -555}, white);
  maker.quad({0, 0, 555}, {555, 0, 0}, {0, 555, 0}, white);
  add_block(maker, {265, 0, 295}, {158, 0, 49}, {-49, 0, 160}, 330, white);
  add_block(maker, {130, 0, 65}, {158, 0, -47}, {47, 0, 158}, 165, white);
  maker.camera({278, 278, -800}, {278, 278, 0}, 40);
  return maker;
}

void add_room(SceneMaker& maker, MaterialId wall) {
  maker.quad({-2, -2, -2}, {4, 0, 0}, {0, 4, 0}, wall);
  maker.quad({-2, -2, 2}, {0, 4, 0}, {4, 0, 0}, wall);
  maker.quad({-2, -2, -2}, {0, 4, 0}, {0, 0, 4}, wall);
  maker.quad({2, -2, -2}, {0, 0, 4}, {0, 4, 0}, wall);
  maker.quad({-2, -2, -2}, {0, 0, 4}, {4, 0, 0}, wall);
  maker.quad({-2, 2, -2}, {4, 0, 0}, {0, 0, 4}, wall);
  maker.camera({0, 0, 1.9}, {0, 0, -1}, 60);
}

SceneMaker lamp_in_glass(double index, double lamp, float reflectance) {
  SceneMaker maker;
  add_room(maker, maker.diffuse(reflectance));
  maker.sphere({0, 0, 0}, lamp, maker.lamp(10));
  maker.sphere({0, 0, 0}, 0.5, maker.glass(index));
  return maker;
}

Mesh grid(int n) {
  Mesh mesh;
  for (int y = 0; y <= n; ++y) {
    for (int x = 0; x <= n; ++x) {
      const auto at = [n](int i) { return static_cast<float>(2.0 * i / n - 1); };
      mesh.positions.push_back({at(x), at(y), 0});
      mesh.uvs.push_back({static_cast<float>(x) / static_cast<float>(n),
                          static_cast<float>(y) / static_cast<float>(n)});
    }
  }
  const auto row = static_cast<std::uint32_t>(n + 1);
  for (std::uint32_t y = 0; y + 1 < row; ++y) {
    for (std::uint32_t x = 0; x + 1 < row; ++x) {
      const std::uint32_t corner = y * row + x;
      mesh.triangles.push_back({corner, corner + 1, corner + row});
      mesh.triangles.push_back({corner + 1, corner + row + 1, corner + row});
    }
  }
  return mesh;
}

}  // namespace bandsaw::test
