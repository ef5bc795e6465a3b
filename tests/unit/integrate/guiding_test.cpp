// Path guiding samples the directions from which training paths found much light. Tests the
// training, and that guiding changes no expected value. The training also traces photons by way
// of casters, the surfaces of metal and glass that may cast caustics.

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "renderlib/integrate/guided_bsdf.h"
#include "renderlib/integrate/guiding_training.h"
#include "renderlib/integrate/path.h"
#include "renderlib/integrate/path_reuse.h"
#include "tests/support/scenes.h"
#include "tests/support/statistics.h"

namespace bandsaw {
namespace {

using test::lamp_in_glass;
using test::SceneMaker;

/// Trains guiding for an image of 64 x 64 pixels and paths of at most 8 scatterings.
std::shared_ptr<const TrainedGuiding> trained(const Scene& scene, int threads = 1) {
  Pool pool(threads);
  const std::atomic<bool> stop = false;
  return train_guiding(scene, {64, 64, 8}, {pool, stop});
}

/// Returns the moments of the radiance along `ray` over `count` pixels, with one sample in each.
/// `field`: guides the paths; nullptr means no guiding.
test::Moments moments_of(const Scene& scene, const Ray& ray, const GuidingField* field,
                         std::uint32_t count, std::uint32_t max_depth = 8) {
  test::Moments moments;
  PathCounts counts;
  const PathOptions options{.max_depth = max_depth, .guiding = field};
  for (std::uint32_t i = 0; i < count; ++i) {
    moments.add(path_radiance(scene, ray, PixelSampler(5, i, 0), 0, options, counts).g);
  }
  return moments;
}

/// Expects that the means agree within 4 standard errors of their difference.
void expect_equal_means(const test::Moments& a, const test::Moments& b) {
  const double deviation = std::hypot(a.standard_error(), b.standard_error());
  EXPECT_LE(std::abs(a.mean() - b.mean()), 4 * deviation) << a.mean() << " and " << b.mean();
}

const Ray kToCorner{.origin = {0, 0, 1.9}, .direction = normalize(Vec3{1.2, 1.0, -1.5})};

TEST(Guiding, ChangesNoMeanAndFindsTheLampInGlass) {
  const auto scene = lamp_in_glass(1.5, 0.2, 0.5f).build();
  const auto guiding = trained(*scene);
  ASSERT_NE(guiding, nullptr);
  EXPECT_GT(guiding->photons, 0u);
  const test::Moments with = moments_of(*scene, kToCorner, &guiding->field, 30'000);
  const test::Moments without = moments_of(*scene, kToCorner, nullptr, 60'000);
  expect_equal_means(with, without);
  EXPECT_LT(with.variance(), without.variance() / 8);
}

// Glass that hardly refracts stops shadow rays all the same, but the lamp lights the wall as if the
// lamp were bare. A sphere of radius r and radiance L at distance d, wholly on one side of a
// surface's plane, gives the surface the irradiance pi L (r / d)^2 cos.
TEST(Guiding, MeetsTheClosedFormOfALampInGlassThatDoesNotRefract) {
  SceneMaker maker = lamp_in_glass(1.00001, 0.2, 0.5f);
  const auto scene = maker.build();
  const auto guiding = trained(*scene);
  const test::Moments with =
      moments_of(*scene, kToCorner, &guiding->field, 60'000, /*max_depth=*/2);
  // The camera ray meets the wall x = 2. The two scatterings are at the wall and at the glass, so
  // there is no indirect light.
  const Vec3 at = kToCorner.origin + kToCorner.direction * (2 / kToCorner.direction.x);
  const double distance = length(at);
  const double cosine = at.x / distance;
  const double direct = 0.5 * 10 * 0.2 * 0.2 / (distance * distance) * cosine;
  EXPECT_LE(std::abs(with.z(direct)), 4) << with.mean() << " and " << direct;
  EXPECT_LT(with.standard_error(), 0.02 * direct);
}

// In a closed room of uniform emission and reflectance the radiance is Le / (1 - rho) everywhere,
// minus the small part that max_depth cuts off.
TEST(Guiding, KeepsTheRadianceOfAFurnace) {
  SceneMaker maker;
  Material wall{Diffuse{maker.texture(ConstantTexture{{0.5f, 0.5f, 0.5f}})}};
  wall.emission.radiance = {maker.texture(ConstantTexture{{1, 1, 1}}), {1, 1, 1}};
  maker.sphere({0, 0, 0}, 2, maker.material(wall));
  maker.sphere({0.5, 0, 0}, 0.6, maker.glass(1.5));
  maker.camera({-1.5, 0, 0}, {1, 0, 0}, 60);
  const auto scene = maker.build();
  Pool pool(1);
  const std::atomic<bool> stop = false;
  const auto guiding = train_guiding(*scene, {64, 64, 64}, {pool, stop});
  const Ray ray{.origin = {-1.5, 0, 0}, .direction = normalize(Vec3{1, 1.5, 0.2})};
  const test::Moments with = moments_of(*scene, ray, &guiding->field, 20'000, /*max_depth=*/64);
  EXPECT_LE(std::abs(with.z(2)), 4) << with.mean();
}

TEST(Guiding, ChangesNoMeanWithPathReuse) {
  const auto scene = lamp_in_glass(1.5, 0.2, 0.7f).build();
  ASSERT_TRUE(scene->reuses_paths());
  const auto guiding = trained(*scene);
  std::array<test::Moments, 2> moments;
  for (const bool guided : {false, true}) {
    const PathOptions options{.max_depth = 8, .guiding = guided ? &guiding->field : nullptr};
    for (std::uint32_t group = 0; group < 6000; ++group) {
      std::vector<ReusePixel> pixels;
      for (std::uint32_t i = 0; i < kMaxReusePixels; ++i) {
        const Vec3 to{1.2 + 0.05 * i, 1.0, -1.5};
        pixels.push_back({.sampler = PixelSampler(3, 8 * group + i, 1),
                          .camera_ray = Ray{.origin = {0, 0, 1.9}, .direction = normalize(to)}});
      }
      radiance_with_reuse(*scene, absl::MakeSpan(pixels), 0, options);
      double sum = 0;
      for (const ReusePixel& pixel : pixels) {
        sum += pixel.radiance.g;
      }
      moments[guided ? 1 : 0].add(sum);
    }
  }
  expect_equal_means(moments[0], moments[1]);
  EXPECT_LT(moments[1].variance(), moments[0].variance() / 4);
}

TEST(Guiding, TheFieldIsTheSameForAnyNumberOfThreads) {
  const auto scene = lamp_in_glass(1.5, 0.2, 0.5f).build();
  const auto one = trained(*scene, 1);
  const auto three = trained(*scene, 3);
  EXPECT_EQ(one->rays, three->rays);
  EXPECT_EQ(one->field.bytes(), three->field.bytes());
  PathCounts counts;
  for (std::uint32_t i = 0; i < 200; ++i) {
    const PixelSampler sampler(5, i, 0);
    EXPECT_EQ(path_radiance(*scene, kToCorner, sampler, 0, {.guiding = &one->field}, counts),
              path_radiance(*scene, kToCorner, sampler, 0, {.guiding = &three->field}, counts));
  }
}

TEST(Guiding, StoppedTrainingReturnsNothing) {
  const auto scene = lamp_in_glass(1.5, 0.2, 0.5f).build();
  Pool pool(1);
  const std::atomic<bool> stop = true;
  EXPECT_EQ(train_guiding(*scene, {64, 64, 8}, {pool, stop}), nullptr);
}

TEST(Guiding, WithoutCastersThereAreNoPhotons) {
  const auto scene = test::cornell_box().build();
  const auto guiding = trained(*scene);
  EXPECT_EQ(guiding->photons, 0u);
  EXPECT_GT(guiding->field.cells(), 0u);
}

// Guided directions are sampled by the BSDF or in one of several cones. In both cases the weight of
// a sample is value / pdf.
TEST(GuidedBsdf, SamplesAgreeWithTheirEvaluation) {
  const auto scene = lamp_in_glass(1.5, 0.2, 0.5f).build();
  const auto guiding = trained(*scene);
  const Vec3 normal{-1, 0, 0};
  const Bsdf bsdf = DiffuseBsdf{{normal, normal}, {0.5f, 0.4f, 0.3f}};
  const GuidingCones cones(guiding->field.find({2, 0.3, 0.2}, normal), {2, 0.3, 0.2}, normal);
  ASSERT_GT(cones.share(), 0);
  const PixelSampler sampler(1, 2, 3);
  test::Moments albedo;
  for (std::uint64_t i = 0; i < 20'000; ++i) {
    const Sample4 numbers = sampler.group(i, 0);
    const auto sampled = sample(bsdf, cones, numbers[0], numbers[1], numbers[2]);
    albedo.add(sampled ? sampled->next.weight.r : 0);
    if (sampled) {
      const BsdfValue value = evaluate(bsdf, cones, sampled->next.wi);
      ASSERT_NEAR(sampled->next.pdf, value.pdf, 1e-9 * value.pdf);
      ASSERT_NEAR(sampled->next.weight.r * value.pdf, value.value.r, 1e-5 * value.value.r);
    }
  }
  EXPECT_LE(std::abs(albedo.z(0.5)), 4) << albedo.mean();
}

}  // namespace
}  // namespace bandsaw
