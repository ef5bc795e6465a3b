// Inside a sphere each point of the wall illuminates all other points equally. So for any albedo
// texture, a light of flux Phi at the wall gives the irradiance Phi / (4 pi R^2 (1 - mean albedo))
// everywhere. This tests texture lookups by the sphere's uvs, light sampling and BSDF sampling. The
// measured means must lie within 4 standard errors.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "renderlib/math/constants.h"
#include "tests/statistical/estimate.h"
#include "tests/statistical/path_reuse_estimate.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

namespace bandsaw {
namespace {

constexpr std::uint32_t kColumns = 8;
constexpr std::uint32_t kRows = 6;

/// Random albedos, rows from the top.
std::vector<float> albedos() {
  test::Random random(77);
  std::vector<float> values(kColumns * kRows);
  for (float& value : values) {
    value = static_cast<float>(0.05 + 0.9 * random.uniform());
  }
  return values;
}

ImageTexture image_of(const std::vector<float>& values) {
  ImageTexture image;
  image.width = kColumns;
  image.height = kRows;
  image.channels = 1;
  image.format = ImageTexture::Format::kFloat32;
  image.filter = ImageTexture::Filter::kNearest;
  const auto* bytes = reinterpret_cast<const std::byte*>(values.data());
  image.texels = std::vector<std::byte>(bytes, bytes + values.size() * sizeof(float));
  return image;
}

/// Returns the mean albedo over the area of the sphere. The rows of the texture have equal angles
/// but not equal areas.
double area_mean(const std::vector<float>& values) {
  double sum = 0;
  for (std::uint32_t y = 0; y < kRows; ++y) {
    const double share = (std::cos(kPi * y / kRows) - std::cos(kPi * (y + 1) / kRows)) / 2;
    for (std::uint32_t x = 0; x < kColumns; ++x) {
      sum += share / kColumns * double{values[y * kColumns + x]};
    }
  }
  return sum;
}

/// A sphere whose wall has given albedos, with a light, and the irradiance that is expected
/// everywhere. The light is close to the wall, faces the middle, and is so small that it occludes
/// practically nothing.
struct LitSphere {
  std::shared_ptr<const Scene> scene;
  double irradiance = 0;
};

LitSphere lit_sphere(const std::vector<float>& values) {
  test::SceneMaker maker;
  maker.sphere({0, 0, 0}, 1, maker.diffuse(1));
  maker.scene.materials.back() = Diffuse{maker.texture(image_of(values))};
  const double side = 0.004;
  const float radiance = 1e5f;
  maker.quad({-side / 2, -1 + side * side, -side / 2}, {0, 0, side}, {side, 0, 0},
             maker.lamp(radiance, true));
  const double flux = kPi * double{radiance} * side * side;
  return {maker.build(), flux / (4 * kPi * (1 - area_mean(values)))};
}

/// Returns the ray from the middle of the sphere to the centre of texel (x, y). The texture's u
/// begins at -x and turns towards +z, as geometry/surface.h defines.
Ray toward_texel(std::uint32_t x, std::uint32_t y) {
  const double theta = kPi * (y + 0.5) / kRows;
  const double phi = 2 * kPi * (x + 0.5) / kColumns;
  return {.origin = {0, 0, 0},
          .direction = {-std::sin(theta) * std::cos(phi), std::cos(theta),
                        std::sin(theta) * std::sin(phi)}};
}

/// Expects that the mean is `expected` within 4 standard errors. The standard error may be at most
/// 1e-3 of `expected`.
void expect_mean(const test::Moments& seen, double expected) {
  EXPECT_LE(std::abs(seen.z(expected)), 4)
      << seen.mean() << " +- " << seen.standard_error() << ", expected " << expected;
  EXPECT_LE(seen.standard_error(), 1e-3 * expected);
}

TEST(IntegratingSphere, OfAnyTextureHasTheIrradianceOfItsMeanAlbedo) {
  const std::vector<float> values = albedos();
  const LitSphere lit = lit_sphere(values);
  for (const auto& [x, y] : {std::pair(1u, 1u), std::pair(5u, 2u)}) {
    expect_mean(test::radiance_along(*lit.scene, toward_texel(x, y), {.max_depth = 1000}, 8192),
                double{values[y * kColumns + x]} * lit.irradiance / kPi);
  }
}

// With path reuse, pixels share the second vertices of their paths. Six pixels see neighbouring
// texels, and two pixels see the opposite side of the sphere. So the balance-heuristic weights of
// the shared vertices are unequal.
TEST(IntegratingSphere, HasTheSameIrradianceWithPathReuse) {
  const std::vector<float> values = albedos();
  const LitSphere lit = lit_sphere(values);
  ASSERT_TRUE(lit.scene->reuses_paths());
  const std::array<std::pair<std::uint32_t, std::uint32_t>, kMaxReusePixels> texels = {
      {{1, 1}, {2, 1}, {1, 2}, {2, 2}, {1, 3}, {2, 3}, {5, 2}, {6, 4}}};
  std::array<Ray, kMaxReusePixels> rays;
  for (std::size_t i = 0; i < texels.size(); ++i) {
    rays[i] = toward_texel(texels[i].first, texels[i].second);
  }
  const auto seen = test::radiance_with_reuse_along(*lit.scene, rays, {.max_depth = 1000}, 2048);
  for (std::size_t i = 0; i < texels.size(); ++i) {
    SCOPED_TRACE(i);
    const double albedo = values[texels[i].second * kColumns + texels[i].first];
    expect_mean(seen[i], albedo * lit.irradiance / kPi);
  }
}

}  // namespace
}  // namespace bandsaw
