// Environment maps as lights: their orientation, seams, samples and pdfs. An id such as C10 in a
// test's name is that of a case in tests/hard_cases/cases.txt.

#include "renderlib/light/environment.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "renderlib/light/check_lights.h"
#include "renderlib/light/environment_light.h"
#include "renderlib/math/constants.h"
#include "renderlib/math/elementary.h"
#include "renderlib/math/transform.h"
#include "renderlib/sampling/tent.h"
#include "tests/support/direction_test.h"
#include "tests/support/environments.h"
#include "tests/support/hard_case.h"
#include "tests/support/random.h"

namespace bandsaw {
namespace {

using test::float_image;
using test::Random;

/// An environment with its textures.
struct Sky {
  std::string name;
  std::vector<Texture> textures;
  Environment environment = {};
};

/// Returns a sky of one equirectangular image. `texel(x, y)`: the radiance of a texel.
Sky equirectangular(const std::string& name, std::uint32_t width, std::uint32_t height,
                    absl::FunctionRef<float(std::uint32_t, std::uint32_t)> texel) {
  Sky sky{.name = name, .textures = {float_image(width, height, texel)}};
  sky.environment.images = {TextureId{0}};
  return sky;
}

/// Returns a sky of six square images, one for each side of a cube. `texel(image, x, y)`: the
/// radiance of a texel.
Sky cube(const std::string& name, std::uint32_t side,
         absl::FunctionRef<float(std::uint32_t, std::uint32_t, std::uint32_t)> texel) {
  Sky sky{.name = name, .textures = {}};
  sky.environment.kind = Environment::Kind::kCube;
  for (std::uint32_t i = 0; i < 6; ++i) {
    sky.textures.push_back(
        float_image(side, side, [&](std::uint32_t x, std::uint32_t y) { return texel(i, x, y); }));
    sky.environment.images.push_back(TextureId{i});
  }
  return sky;
}

/// Returns a number between 2^-6 and 2^4, always the same one for the same arguments.
float noise(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  Random random(a * 10007 + b * 101 + c);
  return static_cast<float>(std::exp2(random.uniform(-6, 4)));
}

/// Returns skies with images of many sizes, of both kinds, and with turned and mirrored axes.
std::vector<Sky> skies() {
  std::vector<Sky> all;
  all.push_back(equirectangular("noise", 17, 9, [](auto x, auto y) { return noise(x, y, 1); }));
  all.push_back(equirectangular("one row", 6, 1, [](auto x, auto y) { return noise(x, y, 2); }));
  all.push_back(equirectangular("one column", 1, 7, [](auto x, auto y) { return noise(x, y, 3); }));
  // In the image "L8 one texel", the light of one bright texel reaches across the seam. In the
  // image "L8 pole row", a whole row at a pole is bright, because one texel at a pole would be too
  // narrow for the cells over which the test integrates the pdf.
  all.push_back(equirectangular("L8 one texel", 20, 10,
                                [&](auto x, auto y) { return x == 19 && y == 3 ? 7.0f : 0; }));
  all.push_back(
      equirectangular("L8 pole row", 20, 10, [&](auto, auto y) { return y == 9 ? 7.0f : 0; }));
  all.push_back(cube("cube", 8, [](auto i, auto x, auto y) { return noise(i, x, y); }));
  all.push_back(
      cube("one texel a side", 1, [](auto i, auto, auto) { return static_cast<float>(i); }));
  Sky turned = all.front();
  turned.name = "turned";
  const Transform turn = rotation({1, 2, 3}, 70);
  turned.environment.axes = {turn.direction({1, 0, 0}), turn.direction({0, 1, 0}),
                             turn.direction({0, 0, 1})};
  all.push_back(turned);
  turned.environment.axes.x = -turned.environment.axes.x;
  turned.name = "turned and mirrored";
  all.push_back(turned);
  return all;
}

/// Returns a random direction, uniform over the sphere.
Vec3 any_direction(Random& random) {
  const double z = random.uniform(-1, 1);
  const double r = std::sqrt(1 - z * z);
  const SinCos turn = sincos_turns(random.uniform());
  return {r * turn.cos, r * turn.sin, z};
}

// An EnvironmentPlace is a position in an image of the environment.
TEST(Environment, PlacesInTheImageAndDirectionsConvertBothWays) {
  Random random(1);
  for (const Sky& sky : skies()) {
    for (int i = 0; i < 2000; ++i) {
      const Vec3 d = any_direction(random);
      const EnvironmentPlace place = place_of(sky.environment, sky.textures, d);
      EXPECT_LE(length(direction_of(sky.environment, sky.textures, place) - d), 1e-14) << sky.name;
    }
  }
}

TEST(Environment, C10_TheMiddleOfAnImageIsSeenAlongXAndItsRightHalfAlongZ) {
  const Sky sky = equirectangular("numbered", 4, 2,
                                  [](auto x, auto y) { return static_cast<float>(10 * y + x); });
  const auto seen = [&](double column, double row) {
    // The direction in which the centre of the texel is seen.
    const SinCos around = sincos_turns((column + 0.5) / 4 - 0.5);
    const SinCos down = sincos_turns((row + 0.5) / 4);
    return radiance(sky.environment, sky.textures,
                    {down.sin * around.cos, down.cos, down.sin * around.sin})
        .g;
  };
  EXPECT_FLOAT_EQ(seen(1, 0), 1);
  EXPECT_FLOAT_EQ(seen(3, 1), 13);
  const auto at = [&](const Vec3& d) { return radiance(sky.environment, sky.textures, d).g; };
  EXPECT_NEAR(at({1, 0, 0}), (1 + 2 + 11 + 12) / 4.0, 1e-6);
  EXPECT_NEAR(at({0, 0, 1}), (2 + 3 + 12 + 13) / 4.0, 1e-6);
  EXPECT_NEAR(at({-1, 0, 0}), (3 + 0 + 13 + 10) / 4.0, 1e-6) << "the image must join at its edges";
  EXPECT_NEAR(at({1e-9, 1, 0}), (1 + 2) / 2.0, 1e-6) << "at a pole only the nearest row must count";
}

TEST(Environment, C10_SidesOfACubeMapHaveTheirDirections) {
  const Sky sky = cube("numbered", 2, [](auto i, auto, auto) { return static_cast<float>(i); });
  const Vec3 axes[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  for (std::size_t i = 0; i < 6; ++i) {
    const Vec3 d = normalize(axes[i] + Vec3{0.1, 0.2, -0.15});
    EXPECT_EQ(radiance(sky.environment, sky.textures, d).r, static_cast<float>(i));
  }
}

TEST(Environment, AGradientAcrossACubeMapHasNoSeams) {
  constexpr std::uint32_t kSide = 32;
  Sky sky = cube("gradient", kSide, [](auto, auto, auto) { return 0.0f; });
  // Each texel holds a linear function of its own direction, so neighbours agree across the edges.
  for (std::uint32_t i = 0; i < 6; ++i) {
    sky.textures[i] = float_image(kSide, kSide, [&](std::uint32_t x, std::uint32_t y) {
      const Vec3 d =
          direction_of(sky.environment, sky.textures, EnvironmentPlace{i, x + 0.5, y + 0.5});
      return static_cast<float>(2 + d.y + 0.5 * d.x);
    });
  }
  Random random(9);
  for (int i = 0; i < 20000; ++i) {
    const Vec3 d = any_direction(random);
    ASSERT_NEAR(radiance(sky.environment, sky.textures, d).g, 2 + d.y + 0.5 * d.x, 1.5 / kSide);
  }
}

TEST(EnvironmentLight, DirectionsFollowThePdf) {
  const std::vector<Sky> all = skies();
  for (const Sky& sky : all) {
    const EnvironmentLight light(sky.environment, sky.textures);
    ASSERT_FALSE(light.empty()) << sky.name;
    SCOPED_TRACE(sky.name);
    test::expect_samples_match_density(
        [&](double u, double v) { return light.sample(u, v).direction; },
        [&](const Vec3& d) { return light.pdf(d); }, /*seed=*/5, /*tests=*/all.size());
  }
}

TEST(EnvironmentLight, SamplesHaveThePdfOfTheirDirection) {
  Random random(6);
  for (const Sky& sky : skies()) {
    const EnvironmentLight light(sky.environment, sky.textures);
    for (int i = 0; i < 5000; ++i) {
      const double u = random.uniform();
      const auto sample = light.sample(u, random.uniform());
      ASSERT_GT(sample.pdf, 0);
      // At the border of a texel, rounding decides to which texel a direction belongs.
      ASSERT_NEAR(light.pdf(sample.direction), sample.pdf, 1e-6 * sample.pdf + 1e-9) << sky.name;
    }
  }
}

/// Returns the integral of f over the directions around a texel, by the midpoint rule. Interpolated
/// radiance has kinks at the centres of texels, so the cells of the rule have borders at the
/// centres.
double around_texel(const Sky& sky, std::uint32_t column, std::uint32_t row,
                    absl::FunctionRef<double(const Vec3&)> f) {
  constexpr int kFine = 400;  // cells per texel along a column
  constexpr int kCoarse = 4;  // cells per texel along a row, where radiance is linear
  const auto& image = std::get<ImageTexture>(sky.textures[0]);
  double sum = 0;
  const int rows = static_cast<int>(image.height);
  for (int i = -2 * kFine; i < 2 * kFine; ++i) {
    const double y = row + 0.5 + (i + 0.5) / kFine;
    if (y < 0 || y > rows) {
      continue;
    }
    const double angle = kPi / image.height;
    const double strip = std::cos((y - 0.5 / kFine) * angle) - std::cos((y + 0.5 / kFine) * angle);
    for (int j = -2 * kCoarse; j < 2 * kCoarse; ++j) {
      const double x = column + 0.5 + (j + 0.5) / kCoarse;
      sum += f(direction_of(sky.environment, sky.textures, {0, x, y})) * strip * 2 * kPi /
             (image.width * kCoarse);
    }
  }
  return sum;
}

TEST(EnvironmentLight, L8_OneTexelIsSampledWithEqualWeights) {
  for (const std::uint32_t row : {0u, 1u, 4u, 9u}) {
    const Sky sky = equirectangular("L8", 100, 10,
                                    [&](auto x, auto y) { return x == 30 && y == row ? 5.0f : 0; });
    const EnvironmentLight light(sky.environment, sky.textures);
    EXPECT_NEAR(around_texel(sky, 30, row, [&](const Vec3& d) { return light.pdf(d); }), 1, 1e-6)
        << row;
    // The radiance of the texel times the solid angle over which interpolation spreads the texel.
    const double flux = 5 * latitude_tent_solid_angle(row, 10) / 100;
    Random random(row);
    for (int i = 0; i < 5000; ++i) {
      const double u = random.uniform();
      const auto sample = light.sample(u, random.uniform());
      const Rgb seen = radiance(sky.environment, sky.textures, sample.direction);
      ASSERT_NEAR(seen.g / sample.pdf, flux, 1e-4 * flux) << "row " << row;
    }
  }
  test::report_hard_case("L8", "all sample weights are equal, also at the pole");
}

// EnvironmentLight samples only the light above the mean of all directions. A uniform image has no
// such light.
TEST(EnvironmentLight, TheUniformPartIsNotSampled) {
  for (const float value : {0.0f, 1.0f, 0.3f, 1e30f}) {
    const Sky even = equirectangular("even", 33, 17, [&](auto, auto) { return value; });
    const EnvironmentLight light(even.environment, even.textures);
    EXPECT_TRUE(light.empty()) << value;
    EXPECT_EQ(light.pdf({0, 1, 0}), 0);
    const Sky even_cube = cube("even", 9, [&](auto, auto, auto) { return value; });
    EXPECT_TRUE(EnvironmentLight(even_cube.environment, even_cube.textures).empty()) << value;
  }
  EXPECT_TRUE(EnvironmentLight().empty());
}

TEST(EnvironmentLight, TheExcessIsTheLightAboveTheMean) {
  const Sky sky =
      equirectangular("half", 2, 512, [](auto, auto y) { return y < 256 ? 3.0f : 1.0f; });
  const EnvironmentLight light(sky.environment, sky.textures);
  // The mean is 2, and the upper half of the sphere is brighter than the mean by 1.
  EXPECT_NEAR(light.excess(), 2 * kPi, 1e-4);
}

TEST(Environment, InvalidEnvironmentsAreRefusedWithTheNameOfTheField) {
  const Sky good = skies().front();
  const auto message = [](const Sky& sky) {
    Background background;
    background.environment = sky.environment;
    return std::string(check_lights(background, sky.textures, {}).message());
  };
  EXPECT_EQ(message(good), "");
  Sky sky = good;
  sky.environment.images = {TextureId{3}};
  EXPECT_EQ(message(sky), "background.environment: images[0]: must be below 1, is 3");
  sky = good;
  sky.environment.images.clear();
  EXPECT_EQ(message(sky), "background.environment: images: there must be 1, there are 0");
  sky = good;
  sky.textures[0] = ConstantTexture{{1, 1, 1}};
  EXPECT_EQ(message(sky), "background.environment: images[0]: must be an image");
  sky = good;
  sky.environment.strength = -1;
  EXPECT_EQ(message(sky), "background.environment: strength: must be finite and >= 0, is -1");
  sky = good;
  sky.environment.axes.x = {2, 0, 0};
  EXPECT_NE(message(sky).find("axes: must be three unit vectors"), std::string::npos);
  sky = good;
  sky.environment.strength = 1e30f;
  sky.textures[0] = float_image(1, 1, [](auto, auto) { return 1e30f; });
  EXPECT_NE(message(sky).find("images[0]: its largest value times the strength must be finite"),
            std::string::npos);
  sky = cube("cube", 4, [](auto, auto, auto) { return 1.0f; });
  sky.textures[2] = float_image(4, 3, [](auto, auto) { return 1.0f; });
  EXPECT_EQ(message(sky),
            "background.environment: images[2]: images of a cube map must be square and of one "
            "size; this one has 4 x 3 pixels, the first is 4 wide");
}

}  // namespace
}  // namespace bandsaw
