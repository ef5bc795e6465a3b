// Families of scenes for growth_bench: in each, one quantity grows (triangles, spheres, instances,
// lights, texels, pixels or the depth of paths) and everything else stays the same.

#include "tests/bench/growth_scenes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tests/support/meshes.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

namespace bandsaw::bench {
namespace {

using test::Random;
using test::SceneMaker;

constexpr std::uint32_t kSide = 128;  // width and height of the images, pixels

GrownScene grown(SceneMaker maker, std::uint32_t max_depth = 8) {
  return {.scene = std::move(maker.scene),
          .settings = {.width = kSide, .height = kSide, .max_depth = max_depth}};
}

/// A camera above the scene and a constant sky, so that the rays are similar at every size.
SceneMaker outdoors() {
  SceneMaker maker;
  maker.background(gray(1), gray(1));
  maker.camera({0, -2.2, 1.6}, {0, 0, 0}, 45);
  return maker;
}

/// A height field of about this many triangles.
GrownScene hills(double triangles) {
  Mesh mesh = test::grid(std::max(1, static_cast<int>(std::lround(std::sqrt(triangles / 2)))));
  mesh.uvs.clear();
  for (auto& at : mesh.positions) {
    at[2] = static_cast<float>(0.15 * std::sin(9.0 * at[0]) * std::cos(7.0 * at[1]));
  }
  SceneMaker maker = outdoors();
  maker.instance(std::move(mesh), {}, maker.diffuse(0.7f));
  return grown(std::move(maker));
}

/// Returns a radius for `count` spheres (or instances of one mesh) in a cube. With this radius they
/// fill the cube with the same density at every count.
double radius_of(double count) { return 0.6 / std::cbrt(count); }

GrownScene spheres(double count) {
  SceneMaker maker = outdoors();
  const MaterialId white = maker.diffuse(0.7f);
  Random random(1);
  for (int i = 0; i < static_cast<int>(count); ++i) {
    maker.sphere(test::random_point(random), radius_of(count), white);
  }
  return grown(std::move(maker));
}

GrownScene instances(double count) {
  SceneMaker maker = outdoors();
  const MaterialId white = maker.diffuse(0.7f);
  maker.instance(test::icosphere(3), {}, white);
  Instance one = maker.scene.geometry.instances.back();
  maker.scene.geometry.instances.clear();
  Random random(2);
  const double radius = radius_of(count);
  for (int i = 0; i < static_cast<int>(count); ++i) {
    one.to_world = translation(test::random_point(random)) * scaling({radius, radius, radius});
    maker.scene.geometry.instances.push_back(one);
  }
  return grown(std::move(maker));
}

/// Lights over a plane, with the same total power at every count.
GrownScene lamps(double count) {
  SceneMaker maker = outdoors();
  maker.background(gray(0), gray(0));
  maker.quad({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, maker.diffuse(0.7f));
  const double radius = 0.02 / std::sqrt(count);
  const MaterialId lamp = maker.lamp(2000);
  Random random(3);
  for (int i = 0; i < static_cast<int>(count); ++i) {
    const Vec3 at = test::random_point(random);
    maker.sphere({at.x, at.y, 0.3 + 0.1 * at.z}, radius, lamp);
  }
  return grown(std::move(maker), /*max_depth=*/2);
}

/// A floor with an image of this many texels.
GrownScene textured(double texels) {
  const auto side = static_cast<std::uint32_t>(std::lround(std::sqrt(texels)));
  std::vector<std::byte> bytes(std::size_t{3} * side * side);
  Random random(4);
  for (std::byte& byte : bytes) {
    byte = static_cast<std::byte>(random.bits() & 0xFFU);
  }
  SceneMaker maker = outdoors();
  ImageTexture image;
  image.width = image.height = side;
  image.texels = SharedBytes(std::move(bytes));
  const MaterialId floor = maker.material(Diffuse{maker.texture(std::move(image))});
  maker.quad({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, floor);
  return grown(std::move(maker));
}

/// A Cornell box of this many pixels. The total number of samples is the same at every resolution,
/// except that each pixel has at least one sample.
GrownScene pixels(double count) {
  GrownScene out = grown(test::cornell_box());
  const auto side = static_cast<std::uint32_t>(std::lround(std::sqrt(count)));
  out.settings.width = out.settings.height = side;
  out.samples = std::max<std::uint64_t>(1, std::uint64_t{kSide} * kSide * 16 / (side * side));
  return out;
}

/// A Cornell box with paths of at most `depth` scatterings.
GrownScene deep(double depth) {
  return grown(test::cornell_box(), static_cast<std::uint32_t>(depth));
}

/// Returns base^first, …, base^last.
std::vector<double> powers(double base, int first, int last) {
  std::vector<double> out;
  for (int power = first; power <= last; ++power) {
    out.push_back(std::pow(base, power));
  }
  return out;
}

}  // namespace

std::vector<Family> families(bool quick) {
  const int less = quick ? 1 : 0;
  return {{"triangles", powers(10, 3, 7 - less), hills},
          {"spheres", powers(10, 1, 6 - less), spheres},
          {"instances", powers(10, 0, 5 - less), instances},
          {"lamps", powers(10, 0, 5 - less), lamps},
          {"texels", powers(4, 6, 13 - less), textured},
          {"pixels", powers(4, 5, 11 - less), pixels},
          {"depth", powers(2, 0, 6), deep}};
}

}  // namespace bandsaw::bench
