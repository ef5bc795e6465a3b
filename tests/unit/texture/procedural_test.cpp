// Textures by formula: checkers, gradient noise, ramps and mixtures. An id such as TX4 in a test's
// name is that of a case in tests/hard_cases/cases.txt.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "renderlib/render/hash64.h"
#include "renderlib/texture/check_texture.h"
#include "renderlib/texture/noise.h"
#include "renderlib/texture/texture.h"
#include "tests/support/hard_case.h"

namespace bandsaw {
namespace {

using Textures = std::vector<Texture>;

constexpr Rgb kWhite{1, 1, 1};
constexpr Rgb kBlack{0, 0, 0};

TextureId id(std::uint32_t i) { return TextureId{i}; }

/// Evaluates the last of the textures at a point. at_uv() evaluates it at texture coordinates.
Rgb at_point(const Textures& textures, const Vec3& p) {
  return evaluate(textures, id(static_cast<std::uint32_t>(textures.size() - 1)),
                  {.position = p, .object_position = p});
}
Rgb at_uv(const Textures& textures, double u, double v) {
  return evaluate(textures, id(static_cast<std::uint32_t>(textures.size() - 1)), {.uv = {u, v}});
}

/// Returns a white texture, a black texture, and a checker of both, whose even cells are white.
Textures checker(CheckerTexture::Mapping mapping, const Vec3& size) {
  CheckerTexture checker{.even = id(0), .odd = id(1)};
  checker.mapping = mapping;
  checker.size = size;
  return {ConstantTexture{kWhite}, ConstantTexture{kBlack}, checker};
}

TEST(Checker, AlternatesInUvAndInSpace) {
  const Textures squares = checker(CheckerTexture::Mapping::kUv, {0.5, 0.25, 1});
  EXPECT_EQ(at_uv(squares, 0.1, 0.1), kWhite);
  EXPECT_EQ(at_uv(squares, 0.6, 0.1), kBlack);
  EXPECT_EQ(at_uv(squares, 0.6, 0.3), kWhite);
  EXPECT_EQ(at_uv(squares, -0.1, 0.1), kBlack);
  const Textures boxes = checker(CheckerTexture::Mapping::kPosition, {2, 2, 2});
  EXPECT_EQ(at_point(boxes, {1, 1, 1}), kWhite);
  EXPECT_EQ(at_point(boxes, {3, 1, 1}), kBlack);
  EXPECT_EQ(at_point(boxes, {3, 1, -1}), kWhite);
  EXPECT_EQ(at_point(boxes, {3, -1, -1}), kBlack);
}

TEST(Checker, TX4APlaneBetweenTwoLayersHasTheColorOfOneLayer) {
  // The result does not depend on the rounding of the third coordinate, also far away from the
  // origin and for cells whose size is no power of two.
  std::mt19937_64 numbers(7);
  std::uniform_real_distribution<double> noise(-1, 1);
  for (const double size : {1.0, 0.3, 7.1}) {
    const Textures boxes = checker(CheckerTexture::Mapping::kPosition, {size, size, size});
    for (const double layer : {0.0, 3.0, -8.0, 12345.0}) {
      for (int i = 0; i < 2000; ++i) {
        const double z = layer * size;
        const double off = 4 * noise(numbers) * 0x1p-52 * std::max(std::abs(z), 100.0);
        const Vec3 inside{0.5 * size + 0.4 * size * noise(numbers),
                          0.5 * size + 0.4 * size * noise(numbers), z + off};
        ASSERT_EQ(at_point(boxes, inside), std::fmod(layer, 2) == 0 ? kWhite : kBlack)
            << size << " " << layer << " " << off;
      }
    }
  }
  test::report_hard_case("TX4", "all points of the plane have the colour of one side");
}

TEST(Checker, AcceptsAnyCoordinate) {
  const Textures boxes = checker(CheckerTexture::Mapping::kPosition, {1e-3, 1, 1});
  const Textures squares = checker(CheckerTexture::Mapping::kUv, {1e-3, 1, 1});
  for (const double x : {1e308, -1e300, std::numeric_limits<double>::infinity(), std::nan("")}) {
    const Rgb solid = at_point(boxes, {x, 0, -x});
    const Rgb flat = at_uv(squares, x, x);
    EXPECT_TRUE(solid == kWhite || solid == kBlack);
    EXPECT_TRUE(flat == kWhite || flat == kBlack);
  }
}

TEST(Noise, IsZeroAtLatticePointsAndWithinItsBound) {
  std::mt19937_64 numbers(11);
  std::uniform_real_distribution<double> where(-1000, 1000);
  for (int i = 0; i < 100000; ++i) {
    const Vec3 p{where(numbers), where(numbers), where(numbers)};
    ASSERT_LE(std::abs(noise(p)), 0.8661);  // sqrt(3) / 2
    ASSERT_EQ(noise({std::floor(p.x), std::floor(p.y), std::floor(p.z)}), 0);
    const double rough = turbulence(p, 7);
    ASSERT_GE(rough, 0);
    // The bound is twice that of noise(), because each octave is half as large as the one before.
    ASSERT_LE(rough, 1.74);
  }
}

TEST(Noise, HasMeanZeroAndTheVarianceOfUnitGradients) {
  // At the middle of a cell all 8 weights are 1/8. Each product of a gradient with its offset has
  // the variance |offset|^2 / 3 = 1/4. So the weighted sum has the variance 8 (1/8)^2 1/4 = 1/32.
  // There are 2^14 cells. The tolerances are 5 standard errors; the false-alarm rate is 1e-6.
  constexpr int kSide = 16;
  double sum = 0;
  double squares = 0;
  for (int i = 0; i < kSide * kSide * 64; ++i) {
    const double value = noise(
        {2 * (i % kSide) + 0.5, 2 * (i / kSide % kSide) - 7.5, 2 * (i / kSide / kSide) - 99.5});
    sum += value;
    squares += value * value;
  }
  constexpr double kCount = kSide * kSide * 64;
  constexpr double kVariance = 1.0 / 32;
  EXPECT_NEAR(sum / kCount, 0, 5 * std::sqrt(kVariance / kCount));
  EXPECT_NEAR(squares / kCount, kVariance, 5 * kVariance * std::sqrt(2 / kCount));
}

TEST(Noise, IsSmoothAcrossCells) {
  // Gradients have unit length, and the slope of Hermite weights is at most 3/2. So the slope along
  // x is at most 1 + 1.5 * 2 * sqrt(3) < 6.2. The two points are two steps apart, so their values
  // differ by less than 12.4 steps. The test permits 20 steps.
  std::mt19937_64 numbers(3);
  std::uniform_real_distribution<double> where(-10, 10);
  constexpr double kStep = 1e-4;
  for (int i = 0; i < 10000; ++i) {
    const Vec3 p{std::round(where(numbers)), where(numbers), where(numbers)};
    ASSERT_NEAR(noise(p - Vec3{kStep, 0, 0}), noise(p + Vec3{kStep, 0, 0}), 20 * kStep);
  }
}

TEST(Noise, TakesAnyPoint) {
  for (const double x : {1e16, -1e308, std::numeric_limits<double>::infinity(), std::nan("")}) {
    EXPECT_EQ(noise({x, 0.5, 0.5}), 0);
    EXPECT_EQ(turbulence({0.5, x, 0.5}, 16), 0);
  }
}

// The hash is a recorded one. Another value means that images with noise have changed.
TEST(Noise, KeepsItsBits) {
  Hash64 hash;
  for (int i = 0; i < 1000; ++i) {
    const Vec3 p{0.37 * i - 150, 1.21 * (i % 31) - 11, 0.013 * i};
    hash.add(noise(p));
    hash.add(turbulence(p, 7));
  }
  EXPECT_EQ(hash.value(), 757054877607107216u);
}

TEST(NoiseTexture, EvaluatesTheFormulaOfItsKind) {
  const Vec3 p{0.3, -1.7, 4.2};
  NoiseTexture t{.scale = 3, .low = {0.25f, 0, 0}, .high = {0.75f, 1, 2}};
  const auto green = [&] { return at_point({t}, p).g; };
  EXPECT_NEAR(green(), 0.5 * (1 + noise(3.0 * p)), 1e-6);
  EXPECT_NEAR(at_point({t}, p).r, 0.25 + 0.25 * (1 + noise(3.0 * p)), 1e-6);
  t.kind = NoiseTexture::Kind::kTurbulence;
  EXPECT_NEAR(green(), std::min(1.0, turbulence(3.0 * p, 7)), 1e-6);
  t.kind = NoiseTexture::Kind::kMarble;
  EXPECT_NEAR(green(), 0.5 * (1 + std::sin(3 * p.z + 10 * turbulence(p, 7))), 1e-6);
  t.axis = {0, 2, 0};
  t.strength = 1;
  t.turbulence_scale = 0.5;
  t.octaves = 2;
  EXPECT_NEAR(green(), 0.5 * (1 + std::sin(6 * p.y + turbulence(0.5 * p, 2))), 1e-6);
  EXPECT_EQ(max_value(Textures{t}, id(0)), 2);
}

TEST(NoiseTexture, UsesTheCoordinatesOfItsSpace) {
  NoiseTexture t;
  const TextureCoordinates moved{.position = {5.5, 1.2, 3.3}, .object_position = {0.4, 1.2, 3.3}};
  const Textures world{t};
  t.space = Space::kObject;
  const Textures object{t};
  EXPECT_EQ(evaluate(world, id(0), moved), at_point(world, {5.5, 1.2, 3.3}));
  EXPECT_EQ(evaluate(object, id(0), moved), at_point(world, {0.4, 1.2, 3.3}));
}

TEST(Ramp, IsLinearOrConstantBetweenStops) {
  RampTexture ramp;
  ramp.over = RampTexture::Over::kV;
  ramp.stops = {{0, {1, 0, 0}}, {1, {0, 1, 0}}, {3, {0, 1, 8}}};
  const auto at = [&](double v) { return at_uv({ramp}, 0.7, v); };
  EXPECT_EQ(at(-5), (Rgb{1, 0, 0}));
  EXPECT_EQ(at(0.25), (Rgb{0.75f, 0.25f, 0}));
  EXPECT_EQ(at(1), (Rgb{0, 1, 0}));
  EXPECT_EQ(at(2), (Rgb{0, 1, 4}));
  EXPECT_EQ(at(99), (Rgb{0, 1, 8}));
  EXPECT_EQ(at(std::nan("")), (Rgb{1, 0, 0}));
  ramp.steps = true;
  EXPECT_EQ(at(0.99), (Rgb{1, 0, 0}));
  EXPECT_EQ(at(1), (Rgb{0, 1, 0}));
  EXPECT_EQ(at(3), (Rgb{0, 1, 8}));
}

TEST(Ramp, AppliesToATextureAndToEachCoordinate) {
  RampTexture ramp;
  ramp.texture = id(0);
  ramp.stops = {{0, {0, 0, 0}}, {10, {10, 10, 10}}};
  // A ramp over a texture uses the texture's luminance, which is 0.7152 for green.
  EXPECT_NEAR(at_uv({ConstantTexture{{0, 1, 0}}, ramp}, 0, 0).r, 0.7152, 1e-6);
  const TextureCoordinates at{.uv = {1, 2}, .uv2 = {8, 9}, .position = {3, 4, 5}};
  using Over = RampTexture::Over;
  float expected = 1;
  for (const Over over : {Over::kU, Over::kV, Over::kX, Over::kY, Over::kZ}) {
    ramp.over = over;
    EXPECT_EQ(evaluate(Textures{ramp}, id(0), at).g, expected);
    ++expected;
  }
  ramp.over = Over::kU;
  ramp.uv_set = UvSet::kSecond;
  EXPECT_EQ(evaluate(Textures{ramp}, id(0), at).g, 8);
}

// Stops are doubles, and greys are floats. The grey nearest to a stop gets the colour of the stop,
// both as a constant and as a texel of 8 bits. The next smaller float does not get it.
TEST(Ramp, StepsAtAGreyThatEqualsTheStop) {
  RampTexture ramp;
  ramp.texture = id(0);
  ramp.steps = true;
  // Returns true if the ramp gives `grey` the colour of the stop.
  const auto steps_at = [&](double stop, const Texture& grey) {
    ramp.stops = {{-1, {1, 0, 0}}, {stop, {0, 1, 0}}};
    return at_uv({grey, ramp}, 0.5, 0.5) == Rgb{0, 1, 0};
  };
  const auto expect_step = [&](double stop) {
    const auto nearest = static_cast<float>(stop);
    EXPECT_TRUE(steps_at(stop, ConstantTexture{gray(nearest)})) << stop;
    EXPECT_FALSE(steps_at(stop, ConstantTexture{gray(std::nextafter(nearest, -1.0f))})) << stop;
  };
  for (int k = 0; k <= 10; ++k) {
    expect_step(k / 10.0);
  }
  for (unsigned k = 0; k <= 255; ++k) {
    expect_step(k / 255.0);
    ImageTexture image;
    image.width = 1;
    image.height = 1;
    image.format = ImageTexture::Format::kLinear8;
    image.texels = std::vector<std::byte>(3, std::byte(k));
    EXPECT_TRUE(steps_at(k / 255.0, image)) << k;
  }
}

TEST(Ramp, StepsOverACoordinateAreNotRoundedToFloats) {
  RampTexture ramp;
  ramp.over = RampTexture::Over::kX;
  ramp.steps = true;
  ramp.stops = {{1e6, {1, 0, 0}}, {1e6 + 0.01, {0, 1, 0}}};
  EXPECT_EQ(at_point({ramp}, {1e6 + 0.005, 0, 0}), (Rgb{1, 0, 0}));
  EXPECT_EQ(at_point({ramp}, {1e6 + 0.015, 0, 0}), (Rgb{0, 1, 0}));
}

TEST(Mix, InterpolatesBetweenTwoTextures) {
  const Textures parts{ConstantTexture{{1, 2, 3}}, ConstantTexture{{3, 2, 1}},
                       ConstantTexture{{0.25f, 0.25f, 0.25f}}, ConstantTexture{{7, 7, 7}}};
  const auto mixed = [&](std::uint32_t amount) {
    Textures textures = parts;
    textures.push_back(MixTexture{id(0), id(1), id(amount)});
    return at_uv(textures, 0, 0);
  };
  EXPECT_NEAR(mixed(2).r, 1.5, 1e-6);
  EXPECT_NEAR(mixed(2).b, 2.5, 1e-6);
  EXPECT_EQ(mixed(3), (Rgb{3, 2, 1}));
}

TEST(Textures, TexturesOfOneColorAreThatColorToTheBit) {
  const Rgb color{0.1f, 0.7f, 0.3f};
  Textures textures{ConstantTexture{color}};
  RampTexture ramp;
  ramp.texture = id(0);
  ramp.stops = {{0, color}, {1, color}};
  textures.insert(textures.end(), {CheckerTexture{.even = id(0), .odd = id(0)},
                                   NoiseTexture{.low = color, .high = color}, ramp});
  textures.push_back(MixTexture{id(1), id(2), id(3)});
  for (double x = -3; x < 3; x += 0.0171) {
    for (std::uint32_t i = 0; i < textures.size(); ++i) {
      const TextureCoordinates at{.uv = {x, -2 * x}, .position = {x, 2 * x, 5 - x}};
      ASSERT_EQ(evaluate(textures, id(i), at), color) << i;
    }
  }
}

TEST(Textures, BoundTheirValuesAndAreNotBlackOnAverage) {
  const Textures textures{ConstantTexture{{0.5f, 0, 0}}, NoiseTexture{.high = {0, 2, 0}},
                          CheckerTexture{.even = id(0), .odd = id(1)}, ProductTexture{id(2), id(1)},
                          MixTexture{id(0), id(3), id(1)}};
  EXPECT_EQ(max_value(textures, id(2)), 2);
  EXPECT_EQ(max_value(textures, id(3)), 4);
  EXPECT_EQ(max_value(textures, id(4)), 4);
  EXPECT_EQ(mean(textures, id(2)), (Rgb{0.25f, 0.5f, 0}));
  for (std::uint32_t i = 0; i < textures.size(); ++i) {
    EXPECT_FALSE(is_black(mean(textures, id(i)))) << i;
  }
}

// A repetition is a whole image, a cell of a checker or of noise, a vein of marble, or the length
// of a ramp over a coordinate. A texture of other textures has the largest number of repetitions
// among them and itself.
TEST(Textures, CountTheirRepetitions) {
  RampTexture ramp;
  ramp.over = RampTexture::Over::kV;
  ramp.stops = {{1, {}}, {1.5, kWhite}};
  ImageTexture turned;
  turned.uv_transform.m = {0, -40, 7, 30, 0, 7};
  NoiseTexture marble{.kind = NoiseTexture::Kind::kMarble, .scale = 6, .strength = 3};
  marble.turbulence_scale = 0.25;
  const Textures textures{ConstantTexture{},
                          CheckerTexture{.even = id(0), .odd = id(0), .size = {0.5, 0.25, 1}},
                          CheckerTexture{.even = id(1),
                                         .odd = id(0),
                                         .mapping = CheckerTexture::Mapping::kPosition,
                                         .size = {1, 1, 0.125}},
                          NoiseTexture{.space = Space::kObject, .scale = -12},
                          ramp,
                          turned,
                          marble,
                          MixTexture{id(4), id(0), id(3)},
                          ProductTexture{id(1), id(5)},
                          RampTexture{.texture = id(5), .stops = {{0, {}}}}};
  // Returns the repetitions of each texture between two points whose coordinates differ by `way`.
  const auto along = [&](const TextureCoordinates& way) {
    std::vector<double> counts;
    for (std::uint32_t i = 0; i < textures.size(); ++i) {
      counts.push_back(repetitions(textures, id(i), way));
    }
    return counts;
  };
  using Counts = std::vector<double>;
  EXPECT_EQ(along({.uv = {-1, 0}}), (Counts{0, 2, 2, 0, 0, 30, 0, 0, 30, 30}));
  EXPECT_EQ(along({.uv = {0, 1}}), (Counts{0, 4, 4, 0, 2, 40, 0, 2, 40, 40}));
  EXPECT_EQ(along({.object_position = {0, 2, 1}}), (Counts{0, 0, 0, 24, 0, 0, 0, 24, 0, 0}));
  const Counts in_space = along({.position = {0, 0, 8}});
  EXPECT_EQ(in_space[2], 64);
  // The phase of the marble grows by 6 * 8 along its axis, and by about 3 for each of the 2 cells
  // of its turbulence.
  EXPECT_NEAR(in_space[6], 54 / (2 * 3.14159265358979), 1e-9);
  EXPECT_EQ(along({.position = {8, 0, 0}})[6], 2);
}

/// Returns the message of the first fault in the textures; empty: none.
std::string fault(const Textures& textures) {
  std::vector<std::uint64_t> cost;
  for (std::size_t i = 0; i < textures.size(); ++i) {
    if (const absl::Status status = check_parts(textures, i, cost); !status.ok()) {
      return std::string(status.message());
    }
  }
  return "";
}

TEST(CheckParts, RefusesCyclesAndInvalidNumbers) {
  EXPECT_EQ(fault({CheckerTexture{}}),
            "checker.even: must be below 0, the index of this texture; it is 0");
  EXPECT_EQ(fault({ConstantTexture{}, MixTexture{id(0), id(0), id(1)}}),
            "mix.amount: must be below 1, the index of this texture; it is 1");
  EXPECT_EQ(fault({ConstantTexture{}, CheckerTexture{.size = {1, 0, 1}}}),
            "checker.size: must be finite and > 0, is 0");
  EXPECT_EQ(fault({NoiseTexture{.octaves = 17}}), "noise.octaves: must lie in [1, 16], is 17");
  EXPECT_EQ(fault({NoiseTexture{.scale = std::numeric_limits<double>::infinity()}}),
            "noise.scale: must be finite, is inf");
  RampTexture ramp;
  ramp.over = RampTexture::Over::kU;
  EXPECT_EQ(fault({ramp}), "ramp.stop: must have 1 to 256 stops; it has 0");
  ramp.stops = {{1, {}}, {1, {}}};
  EXPECT_EQ(fault({ramp}),
            "ramp.stop[1].at: must be above 1, the position of the stop before; it is 1");
}

// Each product has the texture before it as both factors. So a look-up of texture n evaluates
// 2^(n + 1) - 1 textures.
TEST(CheckParts, RefusesALookUpThatTakesTooLong) {
  Textures textures{ConstantTexture{}};
  for (std::uint32_t i = 0; i < 7; ++i) {
    textures.push_back(ProductTexture{id(i), id(i)});
  }
  EXPECT_EQ(fault(textures), "");
  textures.push_back(ProductTexture{id(7), id(7)});
  EXPECT_EQ(fault(textures), "look-up: must evaluate at most 256 textures; it evaluates 511");
}

}  // namespace
}  // namespace bandsaw
