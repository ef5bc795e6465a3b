// Compares meshes that deform while the shutter is open with closed forms and with rigid motion.
// Each comparison allows 4 standard errors. The seeds are fixed, so the result is always the same.
// With other seeds, the probability that any comparison of a correct program fails is below 1 %. An
// id such as C9 in a test's name is that of a case in tests/hard_cases/cases.txt.

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "renderlib/render/render_band.h"
#include "tests/statistical/estimate.h"
#include "tests/support/hard_case.h"
#include "tests/support/scenes.h"

namespace bandsaw {
namespace {

using test::Moments;
using test::SceneMaker;
using Positions = std::vector<std::array<float, 3>>;

/// Returns a quad whose corners move from `at_open` to `at_close` while the shutter is open.
Mesh changing_quad(const Positions& at_open, const Positions& at_close) {
  Mesh mesh;
  mesh.positions = at_open;
  mesh.positions_at_close = at_close;
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

/// Returns a scene in which the mesh emits the radiance 1. The camera looks along -z and sees the
/// rectangle from (0, 0) to (width, height), one unit a pixel.
SceneMaker seen_from_above(int width, int height, const Mesh& mesh) {
  SceneMaker maker;
  maker.instance(mesh, {}, maker.lamp(1));
  maker.scene.camera = OrthographicCamera{.position = {width / 2.0, height / 2.0, 5},
                                          .look_at = {width / 2.0, height / 2.0, 0},
                                          .height = static_cast<double>(height),
                                          .shutter = {-1, 3}};
  return maker;
}

/// Returns the moments of each pixel's green channel over 32 seeds.
std::vector<Moments> pixel_means(const SceneMaker& maker, std::uint32_t width, std::uint32_t height,
                                 std::uint64_t samples = 256) {
  const auto scene = maker.build();
  Pool pool(1);
  const std::atomic<bool> stop = false;
  std::vector<Moments> means(std::size_t{width} * height);
  for (std::uint64_t seed = 0; seed < 32; ++seed) {
    const auto band = render_band(*scene, {.width = width, .height = height, .seed = seed},
                                  {{0, samples}, {0, height}}, pool, stop, {});
    EXPECT_TRUE(band.ok());
    for (std::size_t i = 0; i < means.size(); ++i) {
      means[i].add(band->sums[3 * i + 1] / static_cast<double>(samples));
    }
  }
  return means;
}

// The mesh is a half-plane whose edge moves from x = 5 to x = 15. The mesh covers a point while the
// edge is to the right of the point. The expected value of a pixel is the share of the time for
// which the mesh covers a point, averaged over the points of the pixel.
TEST(Deforming, C9_AMovingEdgeIsALinearRamp) {
  constexpr int kWidth = 24;
  const Mesh half = changing_quad({{-100, -9, 0}, {5, -9, 0}, {5, 9, 0}, {-100, 9, 0}},
                                  {{-100, -9, 0}, {15, -9, 0}, {15, 9, 0}, {-100, 9, 0}});
  const std::vector<Moments> found = pixel_means(seen_from_above(kWidth, 1, half), kWidth, 1);
  const auto integral = [](double x) {  // integral of clamp(x, 0, 10) / 10
    return x < 0 ? 0 : x < 10 ? x * x / 20 : x - 5;
  };
  for (int x = 0; x < kWidth; ++x) {
    const double expected = 1 - (integral(x + 1 - 5) - integral(x - 5));
    const Moments& pixel = found[static_cast<std::size_t>(x)];
    EXPECT_NEAR(pixel.mean(), expected, 4 * pixel.standard_error() + 1e-9) << x;
  }
  test::report_hard_case("C9", "mesh with moving vertices: pixels within 4 SE of the linear ramp");
}

// A square grows from a point to 8 x 8 pixels. Let t, from 0 to 1, be the share of the shutter's
// open time that has passed, and (x, y) a point relative to the centre. The square covers the point
// if t is at least max(|x|, |y|) / 4. So the value of a pixel is 1 minus a quarter of the mean of
// max(|x|, |y|) over the pixel.
TEST(Deforming, AGrowingSquareCoversEachPixelForItsShareOfTheTime) {
  const Mesh square = changing_quad({{4, 4, 0}, {4, 4, 0}, {4, 4, 0}, {4, 4, 0}},
                                    {{0, 0, 0}, {8, 0, 0}, {8, 8, 0}, {0, 8, 0}});
  const std::vector<Moments> found = pixel_means(seen_from_above(8, 8, square), 8, 8);
  double sum = 0;
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 8; ++x) {
      const double a = x < 4 ? 3 - x : x - 4;  // distance of the pixel from the centre along x
      const double b = y < 4 ? 3 - y : y - 4;
      // The mean of max(|x|, |y|) over the pixel.
      const double reach = a == b ? a + 2.0 / 3 : std::max(a, b) + 0.5;
      const Moments& pixel = found[static_cast<std::size_t>(8 * y + x)];
      EXPECT_NEAR(pixel.mean(), 1 - reach / 4, 4 * pixel.standard_error() + 1e-9) << x << " " << y;
      sum += pixel.mean();
    }
  }
  EXPECT_NEAR(sum / 64, 1.0 / 3, 1e-3);  // the mean of t^2
}

/// Returns the radiance of a white patch at the origin, averaged over the time that the shutter is
/// open. `lamp`: a scene that has only the lamp above the patch.
Moments under(const SceneMaker& lamp, Technique technique) {
  SceneMaker maker = lamp;
  maker.quad({-0.01, 0, -0.01}, {0, 0, 0.02}, {0.02, 0, 0}, maker.diffuse(1));
  const auto scene = maker.build();
  const Shutter& shutter = shutter_of(scene->camera());
  Moments means;
  for (std::uint64_t seed = 0; seed < 32; ++seed) {
    const PixelSampler sampler(seed, 11, 7);
    double sum = 0;
    PathCounts counts;
    constexpr std::uint64_t kSamples = 2048;
    for (std::uint64_t sample = 0; sample < kSamples; ++sample) {
      const double share = sampler.group(sample, kGroupTime)[0];
      const double time = shutter.open + share * (shutter.close - shutter.open);
      const Ray down{.origin = {0, 1e-3, 0}, .direction = {0, -1, 0}, .time = time};
      sum += path_radiance(*scene, down, sampler, sample, {.max_depth = 1, .technique = technique},
                           counts)
                 .g;
    }
    means.add(sum / kSamples);
  }
  return means;
}

constexpr Technique kAllTechniques[] = {Technique::kBoth, Technique::kLightsOnly,
                                        Technique::kScatteringOnly};

// A small square lamp of radiance L = 100 at height h = 2, whose half side grows from 0 to a. The
// irradiance is the mean over t of L (2 a t)^2 / h^2, with a relative error of at most (a / h)^2.
// The radiance of the white patch is the irradiance divided by pi.
TEST(DeformingLight, EmitsInProportionToItsAreaAtEachTime) {
  constexpr float a = 0.05f;
  SceneMaker maker;
  maker.instance(changing_quad({{0, 2, 0}, {0, 2, 0}, {0, 2, 0}, {0, 2, 0}},
                               {{-a, 2, -a}, {a, 2, -a}, {a, 2, a}, {-a, 2, a}}),
                 {}, maker.lamp(100));
  std::get<PerspectiveCamera>(maker.scene.camera).shutter = {0, 1};
  const double expected = 100 * 4 * a * a / 3 / 4 / kPi;
  for (const Technique technique : {Technique::kBoth, Technique::kLightsOnly}) {
    const Moments found = under(maker, technique);
    EXPECT_NEAR(found.mean(), expected, 4 * found.standard_error() + 2e-3 * expected);
    EXPECT_LE(found.standard_error(), 1e-2 * expected);
  }
}

// A lamp whose vertices move by a translation gives the same light as a lamp whose instance moves
// by this translation.
TEST(DeformingLight, EqualsRigidMotion) {
  const Positions corners = {{-1, 2, -1}, {1, 2, -0.5f}, {0.5f, 2.5f, 1}, {-1, 1.5f, 1}};
  const Vec3 shift = {2, 1, -0.5};
  Positions moved = corners;
  for (auto& p : moved) {
    p = {p[0] + 2, p[1] + 1, p[2] - 0.5f};
  }
  SceneMaker deforming;
  deforming.instance(changing_quad(corners, moved), {}, deforming.lamp(1));
  std::get<PerspectiveCamera>(deforming.scene.camera).shutter = {0, 1};
  SceneMaker rigid;
  rigid.instance(changing_quad(corners, {}), {}, rigid.lamp(1));
  rigid.scene.geometry.frames = {{kNoFrame, {}, {Key(0, {}), Key(1, translation(shift))}}};
  rigid.scene.geometry.instances[0].frame = FrameId{0};
  std::get<PerspectiveCamera>(rigid.scene.camera).shutter = {0, 1};
  for (const Technique technique : kAllTechniques) {
    const Moments a = under(deforming, technique);
    const Moments b = under(rigid, technique);
    // Both scenes take the same samples at the same places, so the means differ only by the
    // rounding to float.
    EXPECT_NEAR(a.mean(), b.mean(), 1e-4 * b.mean());
    EXPECT_LE(b.standard_error(), 0.02 * b.mean());
  }
}

}  // namespace
}  // namespace bandsaw
