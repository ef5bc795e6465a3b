// Compares caustics from photon maps with closed forms, and checks that maps and path tracing
// divide the light exactly between them. Photons are traced from lamps to casters, the surfaces of
// metal and glass, and arrive at receivers, the surfaces with wide lobes. The light of these
// photons is estimated from the maps, and path tracing leaves it out.

#include "renderlib/integrate/caustics.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <functional>
#include <vector>

#include "renderlib/integrate/guiding_training.h"
#include "renderlib/integrate/make_photon_maps.h"
#include "renderlib/integrate/path.h"
#include "renderlib/integrate/photon_sources.h"
#include "renderlib/integrate/trace_photons.h"
#include "tests/support/environments.h"
#include "tests/support/media.h"
#include "tests/support/scenes.h"
#include "tests/support/statistics.h"
#include "tests/unit/integrate/same_mean.h"

namespace bandsaw {
namespace {

using test::add_room;
using test::lamp_in_glass;
using test::SceneMaker;

/// The stop flag of a computation that is not stopped.
const std::atomic<bool> kGoOn = false;

/// Makes the map with this number. The maps of an image have different photons.
std::shared_ptr<const TracedMaps> map_of(const Scene& scene, const Casters& casters,
                                         std::uint32_t number, std::uint64_t photons,
                                         int threads = 2) {
  Pool pool(threads);
  return make_photon_maps(scene, {casters}, {.seed = 3, .number = number, .photons = photons},
                          {pool, kGoOn});
}

/// The radiance that a surface of reflectance 1/2 should scatter from this point to the eye.
struct Expected {
  Vec3 point;
  double radiance;
};

/// Estimates the radiance that arrives at `eye` from each point after at most two scatterings, with
/// 48 maps that have different seeds. Expects that the mean of the estimates is the expected
/// radiance within 4 standard errors plus 2 % for bias. `time`: of the rays.
void expect_radiance(const Scene& scene, const Vec3& eye, const std::vector<Expected>& expected,
                     double time = 0) {
  const Casters casters(scene);
  Pool pool(2);
  std::vector<test::Moments> moments(expected.size());
  for (std::uint64_t seed = 0; seed < 48; ++seed) {
    const auto map =
        make_photon_maps(scene, {casters}, {.seed = seed, .photons = 1 << 15}, {pool, kGoOn});
    PhotonMaps caustics(casters);
    caustics.use_for_all(*map);
    const PathOptions options{.max_depth = 2, .maps = &caustics};
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const Ray ray{.origin = eye, .direction = normalize(expected[i].point - eye), .time = time};
      PathCounts counts;
      moments[i].add(path_radiance(scene, ray, PixelSampler(5, 0, 0), seed, options, counts).g);
    }
  }
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const double radiance = expected[i].radiance;
    EXPECT_LE(std::abs(moments[i].mean() - radiance),
              4 * moments[i].standard_error() + 0.02 * radiance)
        << i << ": " << moments[i].mean() << " and " << radiance;
    EXPECT_LT(moments[i].standard_error(), 0.15 * radiance) << i;
  }
}

/// The points of a wall in the plane x = 4, above a mirror of reflectance 0.8 that lies at z =
/// `height`, with their expected radiances. A small lamp at (0, 0, 2) gives a surface that faces it
/// at distance 1 the irradiance `intensity`.
std::vector<Expected> wall_above_mirror(double intensity, double height = 0) {
  std::vector<Expected> expected;
  for (const Vec3& to : {Vec3{4, 0, 2.5}, {4, 1, 4}, {4, -2, 0.5}}) {
    const double own = length(to - Vec3{0, 0, 2});
    const double mirrored = length(to - Vec3{0, 0, 2 * height - 2});
    expected.push_back(
        {to, 0.5 * kInvPi * intensity *
                 (to.x / (own * own * own) + 0.8 * to.x / (mirrored * mirrored * mirrored))});
  }
  return expected;
}

// Glass that hardly refracts stops shadow rays, but the lamp lights the wall as if the lamp were
// bare. A sphere of radius r and radiance L at distance d, wholly on one side of a surface's plane,
// gives the surface the irradiance pi L (r / d)^2 cos.
TEST(Caustics, MeetTheClosedFormOfALampInGlassThatDoesNotRefract) {
  const auto scene = lamp_in_glass(1.00001, 0.2).build();
  std::vector<Expected> expected;
  for (const Vec3& to : {Vec3{2, 0, 0}, {2, 1.2, 0.9}, {2, -1.2, -1.4}}) {
    const double distance = length(to);
    expected.push_back({to, 0.5 * 10 * 0.04 / (distance * distance) * (to.x / distance)});
  }
  expect_radiance(*scene, {0, 0, 1.9}, expected);
}

// If a wall sees a whole lamp in a mirror on the floor, the mirror lights the wall like a second
// lamp below the floor.
TEST(Caustics, MeetTheClosedFormOfALampAboveAMirror) {
  SceneMaker maker;
  const MaterialId wall = maker.diffuse(0.5f);
  maker.quad({-5, -5, 0}, {9, 0, 0}, {0, 10, 0}, maker.metal(0.8f, 0));
  maker.quad({4, -5, 0}, {0, 10, 0}, {0, 0, 10}, wall);
  maker.sphere({0, 0, 2}, 0.2, maker.lamp(10));
  maker.camera({-3, 0, 3}, {4, 0, 3}, 60);
  const auto scene = maker.build();
  expect_radiance(*scene, {-3, -1, 3}, wall_above_mirror(kPi * 10 * 0.04));
}

// Path tracing never finds the light of a lamp without size in a mirror: no shadow ray leaves the
// mirror, and no path hits the lamp. Photons find it, and the mirror lights the wall like a second
// lamp below the floor.
TEST(Caustics, MeetTheClosedFormOfALampWithoutSizeAboveAMirror) {
  SceneMaker room;
  const MaterialId wall = room.diffuse(0.5f);
  room.quad({-5, -5, 0}, {9, 0, 0}, {0, 10, 0}, room.metal(0.8f, 0));
  room.quad({4, -5, 0}, {0, 10, 0}, {0, 0, 10}, wall);
  room.camera({-3, 0, 3}, {4, 0, 3}, 60);

  SceneMaker with_point = room;
  with_point.scene.lights.push_back(PointLight{{0, 0, 2}, gray(7)});
  SceneMaker with_spot = room;
  SpotLight spot{.position = {0, 0, 2}, .direction = {1, 0, 0}, .intensity = gray(7)};
  spot.cos_inner = std::cos(1.4);
  spot.cos_outer = std::cos(1.5);
  with_spot.scene.lights.push_back(spot);
  const std::vector<Expected> of_point = wall_above_mirror(7);
  expect_radiance(*with_point.build(), {-3, -1, 3}, of_point);
  expect_radiance(*with_spot.build(), {-3, -1, 3}, of_point);

  SceneMaker with_sun = room;
  with_sun.scene.lights.push_back(DirectionalLight{normalize(Vec3{1, 0, -1}), gray(3)});
  std::vector<Expected> of_sun = of_point;
  for (Expected& expected : of_sun) {
    expected.radiance = 0.5 * kInvPi * 3 * std::sqrt(0.5) * 1.8;
  }
  expect_radiance(*with_sun.build(), {-3, -1, 3}, of_sun);
}

/// Adds shapes that sink by 1/2 along z while the shutter is open, from time 0 to 1.
void add_sinking(SceneMaker& maker, const Shapes& shapes) {
  std::get<PerspectiveCamera>(maker.scene.camera).shutter = {0, 1};
  Geometry& geometry = maker.scene.geometry;
  geometry.groups = {shapes};
  geometry.frames = {{kNoFrame, {}, {Key(0, {}), Key(1, translation({0, 0, -0.5}))}}};
  geometry.instances.push_back(
      {.material = kOwnMaterial, .to_world = {}, .group = GroupId{0}, .frame = FrameId{0}});
}

// The mirror sinks from z = 0 to z = -1/2 while the shutter is open. A path must be lit only by
// photons that met the mirror at about the time of the path. The times are in the middle of a part
// of the shutter interval (TracedMaps::parts), where the mean over the part is nearly the value.
TEST(Caustics, MeetTheClosedFormOfAMovingMirrorAtEachTime) {
  SceneMaker maker;
  maker.quad({4, -5, -1}, {0, 10, 0}, {0, 0, 11}, maker.diffuse(0.5f));
  maker.scene.lights.push_back(PointLight{{0, 0, 2}, gray(7)});
  maker.camera({-3, 0, 3}, {4, 0, 3}, 60);
  Shapes sinking;
  sinking.quads.push_back({{-5, -5, 0}, {9, 0, 0}, {0, 10, 0}, maker.metal(0.8f, 0)});
  add_sinking(maker, sinking);
  const auto scene = maker.build();
  EXPECT_TRUE(can_have_caustic_maps(*scene, Casters(*scene)));
  for (const double time : {1.0 / 16, 9.0 / 16, 15.0 / 16}) {
    SCOPED_TRACE(time);
    expect_radiance(*scene, {-3, -1, 3}, wall_above_mirror(7, -time / 2), time);
  }
}

// Photons arrive at the place where a surface was at another time, so a moving surface is no
// receiver. A caster may move.
TEST(Caustics, MovingSurfacesAreNoReceivers) {
  SceneMaker maker;
  const MaterialId gray_wall = maker.diffuse(0.5f);
  const MaterialId mirror = maker.metal(0.8f, 0);
  maker.sphere({0, 0, 0}, 1, gray_wall);
  Shapes sinking;
  sinking.spheres.push_back({{3, 0, 0}, 1, gray_wall});
  add_sinking(maker, sinking);
  const auto scene = maker.build();
  const Casters casters(*scene);
  const Vec3 up{0, 0, 1};
  const DiffuseBsdf diffuse{{up, up}, gray(0.5f)};
  SurfacePoint still;
  still.id = {.instance = 0, .primitive = 0};
  SurfacePoint moving;
  moving.id = {.instance = 1, .primitive = 0};
  EXPECT_EQ(caustic_role(casters, still, gray_wall, diffuse), CausticRole::kReceiver);
  EXPECT_EQ(caustic_role(casters, moving, gray_wall, diffuse), CausticRole::kOther);
  EXPECT_EQ(caustic_role(casters, moving, mirror, MirrorBsdf{}), CausticRole::kCaster);
}

// All light of a small lamp in the middle of a ball meets the glass at right angles. The glass
// reflects 4 % of it back to the lamp. The rest of the power arrives at the walls. The power of the
// lamp is pi times its radiance times its area.
TEST(Caustics, TheWallsReceiveThePowerOfTheLampInGlass) {
  const auto scene = lamp_in_glass(1.5, 0.02).build();
  const Casters casters(*scene);
  test::Moments power;
  constexpr std::uint64_t kPhotons = 1 << 12;
  for (std::uint32_t i = 0; i < 64; ++i) {
    const TracedPhotons traced = trace_photons(
        *scene, casters, {.seed = 1, .map = i, .photons = kPhotons, .first = 0, .last = kPhotons});
    power.add(traced.power);
    // The solid angle of the lamp, seen from the glass at the distance 0.5.
    EXPECT_NEAR(traced.power_by_angle / traced.power, kPi * 0.02 * 0.02 / 0.25, 1e-3);
  }
  const double expected = 0.96 * 10 * kPi * 4 * kPi * 0.02 * 0.02;
  EXPECT_LE(std::abs(power.z(expected)), 4) << power.mean() << " and " << expected;
  EXPECT_LT(power.standard_error(), 0.01 * expected);
}

// A partly transparent surface is present for a part of the paths, and only these paths look up the
// photons on the surface. So a map must hold all light that arrives at the walls, whether the walls
// are opaque, partly transparent, or a mixture with a part that receives no caustics.
TEST(Caustics, APartlyTransparentWallReceivesThePowerOfAnOpaqueOne) {
  for (const bool mixture : {false, true}) {
    SCOPED_TRACE(mixture);
    SceneMaker maker = lamp_in_glass(1.5, 0.02);
    const MaterialId wall = std::as_const(maker.scene.geometry).quads.front().material;
    Material half = Diffuse{maker.texture(ConstantTexture{gray(0.5f)})};
    half.alpha = {AlphaMode::kBlend, {maker.texture(ConstantTexture{gray(1)}), 0.4}};
    const MaterialId other = mixture ? maker.metal(0.9f, 0.9) : wall;
    MaterialId of_walls = maker.material(half);
    if (mixture) {
      of_walls = maker.material(Mix{other, of_walls, maker.texture(ConstantTexture{gray(0.7f)})});
    }
    for (Quad& quad : maker.scene.geometry.quads) {
      quad.material = of_walls;
    }
    const auto scene = maker.build();
    const Casters casters(*scene);
    test::Moments power;
    constexpr std::uint64_t kPhotons = 1 << 12;
    for (std::uint32_t i = 0; i < 64; ++i) {
      power.add(trace_photons(*scene, casters,
                              {.seed = 1, .map = i, .photons = kPhotons, .last = kPhotons})
                    .power);
    }
    const double expected = 0.96 * 10 * kPi * 4 * kPi * 0.02 * 0.02;
    EXPECT_LE(std::abs(power.z(expected)), 4) << power.mean() << " and " << expected;
    EXPECT_LT(power.standard_error(), 0.02 * expected);
  }
}

/// Moves the quads, the spheres and the camera of a scene.
void move(SceneMaker& maker, const Vec3& offset) {
  for (Quad& quad : maker.scene.geometry.quads) {
    quad.corner = quad.corner + offset;
  }
  for (Sphere& sphere : maker.scene.geometry.spheres) {
    sphere.center = sphere.center + offset;
  }
  auto& camera = std::get<PerspectiveCamera>(maker.scene.camera);
  camera.position = camera.position + offset;
  camera.look_at = camera.look_at + offset;
}

// Near an edge of the room, a part of a photon's disk lies beyond the surface. The map corrects the
// power of such photons, so together the disks on a surface have the power that arrived at the
// surface. Far from the origin of the world, the map must be as precise as near the origin.
void expect_no_power_is_lost_at_edges(const Vec3& offset) {
  SceneMaker maker = lamp_in_glass(1.5, 0.02);
  move(maker, offset);
  const auto scene = maker.build();
  const Casters casters(*scene);
  const auto map = map_of(*scene, casters, 0, 1 << 14);
  // The power on the floor: the irradiance at the midpoints of a grid, times their areas.
  constexpr int kSteps = 400;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      const Vec3 at{-2 + 4 * (i + 0.5) / kSteps, -2 + 4 * (j + 0.5) / kSteps, -2};
      map->caustics.visit(offset + at, {0, 0, 1}, [&](const StoredPhoton& photon, float density) {
        sum += photon.power.g * density * 16 / (kSteps * kSteps);
      });
    }
  }
  // A sixth of the lamp's power. The bound is about 4 standard errors of the number of photons that
  // arrive at the floor.
  const double expected = 0.96 * 10 * kPi * 4 * kPi * 0.02 * 0.02 / 6;
  EXPECT_NEAR(sum, expected, 0.05 * expected);
  // share_on_surface() is the share of a photon's disk that lies on surfaces. The map has divided
  // the power of each photon by this share.
  double raw = 0;
  double lost = 0;
  for (const StoredPhoton& photon : map->caustics.photons()) {
    const bool on_floor = photon.normal[2] > 0.5f;
    raw += on_floor ? photon.power.g * share_on_surface(*scene, photon, map->caustics.origin()) : 0;
    lost += on_floor
                ? photon.power.g * (1 - share_on_surface(*scene, photon, map->caustics.origin()))
                : 0;
  }
  EXPECT_NEAR(sum, raw, 0.01 * raw);
  EXPECT_GT(lost, 0.02 * raw);  // the power that would be lost without the correction
}

TEST(Caustics, NoPowerIsLostAtEdges) { expect_no_power_is_lost_at_edges({}); }
TEST(Caustics, NoPowerIsLostFarFromTheOrigin) {
  expect_no_power_is_lost_at_edges({3e8, -1e9, 2e7});
}

// The fog is so dense that no light arrives. A photon without power must not replace other photons.
TEST(Caustics, PhotonsWithoutPowerAreNotStored) {
  SceneMaker maker = lamp_in_glass(1.5, 0.02);
  maker.scene.media.fog = test::add(maker, test::medium(100, 0));
  const auto scene = maker.build();
  const TracedPhotons traced =
      trace_photons(*scene, Casters(*scene), {.seed = 1, .photons = 2000, .last = 2000});
  for (const StoredPhoton& photon : traced.photons) {
    ASSERT_GT(photon.power.g, 0);
  }
}

TEST(Caustics, TheShareOnTheSurfaceIsOneHalfAtAnEdge) {
  SceneMaker maker;
  const MaterialId wall = maker.diffuse(0.5f);
  maker.quad({0, 0, 0}, {4, 0, 0}, {0, 4, 0}, wall);
  maker.quad({0, 0, 0}, {0, 4, 0}, {0, 0, 4}, wall);  // a wall at x = 0; the other edges are free
  maker.camera({3, 3, 3}, {0, 0, 0}, 60);
  const auto scene = maker.build();
  StoredPhoton photon{.position = {2, 2, 0}, .radius = 0.5f, .normal = {0, 0, 1}};
  EXPECT_EQ(share_on_surface(*scene, photon, {}), 1);
  photon.position = {0.001f, 2, 0};
  EXPECT_NEAR(share_on_surface(*scene, photon, {}), 0.5, 0.1);
  photon.position = {3.999f, 2, 0};
  EXPECT_NEAR(share_on_surface(*scene, photon, {}), 0.5, 0.1);
  photon.position = {3.999f, 0.001f, 0};
  EXPECT_NEAR(share_on_surface(*scene, photon, {}), 0.25, 0.1);
}

// The photons are at all distances up to the radius from a straight edge. Let f(x) be the integral
// of the kernel along a line at the distance x from the centre, 8 / (3 pi) (1 - x^2)^(3/2). The
// mean share is 1 minus the integral of x f(x) over [0, 1]. That integral is 8 / (15 pi).
TEST(Caustics, TheMeanShareOnTheSurfaceMeetsTheClosedFormNearAnEdge) {
  SceneMaker maker;
  maker.quad({0, 0, 0}, {4, 0, 0}, {0, 4, 0}, maker.diffuse(0.5f));
  maker.camera({3, 3, 3}, {0, 0, 0}, 60);
  const auto scene = maker.build();
  constexpr int kPhotons = 20'000;
  constexpr double kGolden = 0.618033988749895;
  double sum = 0;
  for (int i = 0; i < kPhotons; ++i) {
    const double along = 1 + 2 * (i * kGolden - std::floor(i * kGolden));
    const StoredPhoton photon{.position = float3(Vec3{4 - 0.5 * (i + 0.5) / kPhotons, along, 0}),
                              .radius = 0.5f,
                              .normal = {0, 0, 1}};
    sum += share_on_surface(*scene, photon, {});
  }
  // The standard deviation of a share is below 0.07, so the tolerance is at least 4 standard
  // errors.
  EXPECT_NEAR(sum / kPhotons, 1 - 8 / (15 * kPi), 0.002);
}

TEST(Caustics, TheShareOnTheSurfaceIgnoresTransparentSurfaces) {
  SceneMaker maker;
  maker.quad({0, 0, 0}, {4, 0, 0}, {0, 4, 0}, maker.diffuse(0.5f));
  Material hole = MetallicRoughness{};
  hole.alpha = {AlphaMode::kMask, {TextureId{0}, 0}};
  maker.quad({1.9, 0, -1}, {0, 4, 0}, {0, 0, 4}, maker.material(hole));
  maker.camera({3, 3, 3}, {0, 0, 0}, 60);
  const StoredPhoton photon{.position = {2, 2, 0}, .radius = 0.5f, .normal = {0, 0, 1}};
  EXPECT_EQ(share_on_surface(*maker.build(), photon, {}), 1);
}

// With an empty map, paths find only the light that is not left to the photons. In a room whose
// lamp is in glass no light remains, because all light passes the glass before it meets a surface
// of the room.
TEST(Caustics, PathsLeaveOutJustTheLightOfThePhotons) {
  const auto scene = lamp_in_glass(1.5, 0.2).build();
  const Casters casters(*scene);
  const TracedMaps empty;
  PhotonMaps caustics(casters);
  caustics.use_for_all(empty);
  const Ray ray{.origin = {0, 0, 1.9}, .direction = normalize(Vec3{1.2, 1.0, -1.5})};
  const Ray to_lamp{.origin = {0, 0, 1.9}, .direction = {0, 0, -1}};
  PathCounts counts;
  double plain = 0;
  for (std::uint32_t i = 0; i < 5000; ++i) {
    const PixelSampler sampler(5, i, 0);
    const PathOptions options{.max_depth = 12, .maps = &caustics};
    ASSERT_EQ(path_radiance(*scene, ray, sampler, 0, options, counts), Rgb{});
    plain += path_radiance(*scene, ray, sampler, 0, {.max_depth = 12}, counts).g;
    // The camera sees the lamp itself as without maps.
    ASSERT_EQ(
        path_radiance(*scene, to_lamp, sampler, 0, {.max_depth = 2, .maps = &caustics}, counts),
        path_radiance(*scene, to_lamp, sampler, 0, {.max_depth = 2}, counts));
  }
  EXPECT_GT(plain, 0);
}

// The maps of an image are for consecutive, aligned ranges of samples, and the length of each range
// is a power of two. The number of maps grows with the root of the number of samples.
TEST(PhotonMaps, TakeAlignedRangesOfSamples) {
  constexpr std::uint64_t kStep = PhotonMaps::kMinSamplesOfMap;
  std::uint64_t first = 0;
  for (std::uint64_t sample = 1; sample <= 1 << 16; ++sample) {
    const std::uint32_t before = PhotonMaps::number_of(sample - 1);
    const std::uint32_t number = PhotonMaps::number_of(sample);
    if (number == before) {
      continue;
    }
    ASSERT_EQ(number, before + 1);
    const std::uint64_t length = sample - first;
    ASSERT_TRUE(std::has_single_bit(length)) << first;
    ASSERT_GE(length, kStep) << first;
    ASSERT_EQ(first % length, 0u) << first;
    first = sample;
  }
  // The first four maps are for kStep samples each. Map 4 begins at sample 4 kStep, map 10 at
  // sample 16 kStep, map 22 at sample 64 kStep, and so on.
  EXPECT_EQ(PhotonMaps::number_of(4 * kStep - 1), 3u);
  for (std::uint64_t samples = 4 * kStep; samples <= 1 << 17; samples *= 4) {
    const double root = std::sqrt(static_cast<double>(samples / kStep));
    EXPECT_EQ(PhotonMaps::number_of(samples), 3 * root - 2) << samples;
  }
}

/// Expects paths with caustics from maps to have the same mean as paths without maps.
void expect_same_mean(const Scene& scene, const Ray& ray, std::uint32_t max_depth) {
  test::expect_same_mean(scene, {Casters(scene)}, ray,
                         {.max_depth = max_depth,
                          .maps = 32,
                          .paths = 1000,
                          .photons = 1 << 14,
                          .max_deviation = 0.06});
}

TEST(Caustics, ChangeNoMean) {
  const auto scene = lamp_in_glass(1.5, 0.2).build();
  const Ray ray{.origin = {0, 0, 1.9}, .direction = normalize(Vec3{1.2, 1.0, -1.5})};
  for (const std::uint32_t max_depth : {2u, 3u, 8u}) {
    SCOPED_TRACE(max_depth);
    expect_same_mean(*scene, ray, max_depth);
  }
}

/// Expects the same mean with and without maps in a room with a ball of fuzzy metal or rough glass.
/// `add_lamp` adds the lamp. At such casters, whose directions have a pdf, light sampling finds the
/// lamp as well. Photons take the place of this light sampling.
void expect_same_mean_at_rough_casters(const std::function<void(SceneMaker&)>& add_lamp) {
  for (const bool glass : {false, true}) {
    SCOPED_TRACE(glass);
    SceneMaker maker;
    add_room(maker, maker.diffuse(0.5f));
    add_lamp(maker);
    MaterialId caster = maker.metal(0.9f, 0.2);
    if (glass) {
      caster = maker.material(Dielectric{.index_of_refraction = 1.5, .roughness = 0.4});
    }
    maker.sphere({0, 0, -0.8}, 0.7, caster);
    const auto scene = maker.build();
    const Ray ray{.origin = {0, 0, 1.9}, .direction = normalize(Vec3{0.95, 0.4, -3.9})};
    for (const std::uint32_t max_depth : {2u, 6u}) {
      expect_same_mean(*scene, ray, max_depth);
    }
  }
}

TEST(Caustics, ChangeNoMeanWithFuzzyMetalAndRoughGlass) {
  expect_same_mean_at_rough_casters([](SceneMaker& maker) {
    maker.sphere({0.5, 0.6, 1}, 0.25, maker.lamp(10));
  });
}

TEST(Caustics, ChangeNoMeanOfALampWithoutSizeAtFuzzyMetalAndRoughGlass) {
  expect_same_mean_at_rough_casters([](SceneMaker& maker) {
    maker.scene.lights.push_back(PointLight{{0.5, 0.6, 1}, gray(2)});
  });
}

/// A floor under a sky that is uniform except for one bright texel, and a ball of this material.
std::shared_ptr<const Scene> ball_under_sun(SceneMaker maker, MaterialId ball) {
  maker.scene.background.environment = Environment{
      .images = {maker.texture({test::float_image(32, 16, [](std::uint32_t x, std::uint32_t y) {
        return x == 5 && y == 3 ? 300.0f : 1.0f;
      })})}};
  maker.quad({-20, 0, -20}, {0, 0, 40}, {40, 0, 0}, maker.diffuse(0.5f));
  maker.sphere({0, 0.7, 0}, 0.7, ball);
  maker.camera({0, 2, 4}, {0, 0, 0}, 40);
  return maker.build();
}

// Photons carry the light of the bright texel, and paths find that of the rest of the sky. At fuzzy
// metal and rough glass, light sampling finds the bright texel too.
TEST(Caustics, ChangeNoMeanUnderAnEnvironmentWithASun) {
  const auto expect = [](const Scene& scene) {
    EXPECT_TRUE(can_have_caustic_maps(scene, Casters(scene)));
    for (const Vec3& to : {Vec3{0.5, 0, 0.9}, {1.3, 0, 0.2}, {-0.7, 0, 0.8}}) {
      const Ray ray{.origin = {0, 2, 4}, .direction = normalize(to - Vec3{0, 2, 4})};
      expect_same_mean(scene, ray, 6);
    }
  };
  SceneMaker maker;
  expect(*ball_under_sun(maker, maker.glass(1.5)));
  maker = SceneMaker();
  expect(*ball_under_sun(maker, maker.metal(0.9f, 0.3)));
  maker = SceneMaker();
  expect(*ball_under_sun(maker,
                         maker.material(Dielectric{.index_of_refraction = 1.5, .roughness = 0.4})));
}

TEST(Caustics, PhotonsCarryTheSunAndNotTheSky) {
  SceneMaker maker;
  const auto scene = ball_under_sun(maker, maker.glass(1.5));
  const Environment& sky = *scene->background().environment;
  const Vec3 sun = direction_of(sky, scene->textures(), {0, 5.5, 3.5});
  const Vec3 beside = direction_of(sky, scene->textures(), {0, 15.5, 3.5});
  EXPECT_TRUE(photons_carry(scene->lights(), sun));
  EXPECT_FALSE(photons_carry(scene->lights(), beside));
}

/// Materials with a diffuse part and a lobe that is not wide: glTF's and plastic. The lobes of the
/// last two are so narrow that paths find their light.
std::array<Material, 4> polished_materials(SceneMaker& maker) {
  const TextureId color = maker.texture(ConstantTexture{gray(0.5f)});
  const auto gltf = [&](double roughness) {
    MetallicRoughness material;
    material.base_color.texture = color;
    material.metallic.factor = 0;
    material.roughness.factor = roughness;
    return Material{material};
  };
  const auto plastic = [&](double alpha) {
    Plastic material;
    material.reflectance = color;
    material.surface.alpha_u = alpha;
    material.surface.alpha_v = alpha;
    return Material{material};
  };
  return {gltf(0.4), plastic(0.15), gltf(0.25), plastic(0.07)};
}

// Photons light the diffuse part of a polished surface, and paths find the light of its narrow
// lobe. The lamp is in glass, so without maps BSDF sampling alone finds it. The camera sees its
// reflection in the floor, so a large part of the light comes from the narrow lobe.
TEST(Caustics, ChangeNoMeanOnPolishedSurfaces) {
  for (std::size_t which = 0; which < 4; ++which) {
    SCOPED_TRACE(which);
    SceneMaker maker;
    add_room(maker, maker.material(polished_materials(maker)[which]));
    maker.sphere({0, 0, 0}, 0.3, maker.lamp(10));
    maker.sphere({0, 0, 0}, 0.5, maker.glass(1.5));
    const auto scene = maker.build();
    const Ray ray{.origin = {1.8, -1, 0}, .direction = normalize(Vec3{-1.8, -3, 0})};
    for (const std::uint32_t max_depth : {3u, 8u}) {
      expect_same_mean(*scene, ray, max_depth);
    }
  }
}

// The camera sees the reflection of fuzzy metal in the floor. Light sampling at the metal finds the
// lamp too.
TEST(Caustics, ChangeNoMeanWhereAPolishedFloorShowsFuzzyMetal) {
  for (std::size_t which = 0; which < 4; ++which) {
    SCOPED_TRACE(which);
    SceneMaker maker;
    add_room(maker, maker.material(polished_materials(maker)[which]));
    maker.sphere({1.2, -0.5, 0}, 0.25, maker.lamp(10));
    maker.sphere({0, 0, 0}, 0.5, maker.metal(0.9f, 0.2));
    const auto scene = maker.build();
    const Ray ray{.origin = {1.8, -1, 0}, .direction = normalize(Vec3{-1.8, -3, 0})};
    for (const std::uint32_t max_depth : {2u, 6u}) {
      expect_same_mean(*scene, ray, max_depth);
    }
  }
}

TEST(Caustics, MapsDependNeitherOnThreadsNorOnChunks) {
  const auto scene = lamp_in_glass(1.5, 0.2).build();
  const Casters casters(*scene);
  const auto one = map_of(*scene, casters, 2, 1 << 12, 1);
  const auto three = map_of(*scene, casters, 2, 1 << 12, 3);
  ASSERT_EQ(one->caustics.size(), three->caustics.size());
  ASSERT_GT(one->caustics.size(), 100u);
  for (std::size_t i = 0; i < one->caustics.size(); ++i) {
    const StoredPhoton& a = one->caustics.photons()[i];
    const StoredPhoton& b = three->caustics.photons()[i];
    ASSERT_TRUE(a.position == b.position && a.radius == b.radius && a.power == b.power);
  }
  const auto trace = [&](std::uint64_t first, std::uint64_t last) {
    return trace_photons(*scene, casters,
                         {.seed = 3, .map = 2, .photons = 1000, .first = first, .last = last})
        .photons;
  };
  const auto whole = trace(0, 1000);
  auto parts = trace(0, 333);
  for (const StoredPhoton& photon : trace(333, 1000)) {
    parts.push_back(photon);
  }
  ASSERT_EQ(whole.size(), parts.size());
  for (std::size_t i = 0; i < whole.size(); ++i) {
    ASSERT_TRUE(whole[i].position == parts[i].position && whole[i].power == parts[i].power);
  }
}

TEST(Caustics, MapsOfOtherSeedsAndNumbersDiffer) {
  const auto scene = lamp_in_glass(1.5, 0.2).build();
  const Casters casters(*scene);
  const auto first = [&](std::uint64_t seed, std::uint32_t map) {
    return trace_photons(*scene, casters,
                         {.seed = seed, .map = map, .photons = 100, .first = 0, .last = 100})
        .photons[0]
        .position;
  };
  EXPECT_NE(first(1, 0), first(2, 0));
  EXPECT_NE(first(1, 0), first(1, 1));
}

// train_guiding() traces a few paths, the pilot. Caustics come from photon maps only if the pilot
// shows that the maps are worth their cost.
TEST(Caustics, ComeFromMapsForSmallLampsOnly) {
  Pool pool(1);
  const auto come_from_maps = [&](const Scene& scene) {
    const auto trained = train_guiding(scene, {16, 16, 8}, {pool, kGoOn}, /*photon_maps=*/true);
    return trained->sources != nullptr && !trained->sources->casters.empty();
  };
  EXPECT_TRUE(come_from_maps(*lamp_in_glass(1.5, 0.05).build()));
  EXPECT_FALSE(come_from_maps(*lamp_in_glass(1.5, 0.4).build()));
  EXPECT_FALSE(come_from_maps(*test::cornell_box().build()));
  // Paths never find the light of a lamp without size in glass, so maps are used although the other
  // lamp is large.
  SceneMaker with_point = lamp_in_glass(1.5, 0.4);
  with_point.scene.lights.push_back(PointLight{{1.5, 1.5, 1.5}, gray(2)});
  EXPECT_TRUE(come_from_maps(*with_point.build()));
  EXPECT_EQ(train_guiding(*lamp_in_glass(1.5, 0.05).build(), {16, 16, 8}, {pool, kGoOn})->sources,
            nullptr);
}

TEST(Caustics, HaveNoMapsWithoutCastersOrWithNestedGlassOrHiddenLamps) {
  const auto possible = [](SceneMaker maker) {
    const auto scene = maker.build();
    return can_have_caustic_maps(*scene, Casters(*scene));
  };
  EXPECT_TRUE(possible(lamp_in_glass(1.5, 0.05)));
  EXPECT_FALSE(possible(test::cornell_box()));
  SceneMaker nested = lamp_in_glass(1.5, 0.05);
  nested.scene.materials.push_back(Material{Dielectric{.priority = 1}});
  EXPECT_FALSE(possible(nested));
  SceneMaker moving_camera = lamp_in_glass(1.5, 0.05);
  moving_camera.scene.camera_at_close = moving_camera.scene.camera;
  std::get<PerspectiveCamera>(*moving_camera.scene.camera_at_close).position.x += 0.1;
  EXPECT_TRUE(possible(moving_camera));
  SceneMaker hidden = lamp_in_glass(1.5, 0.05);
  hidden.scene.materials.push_back(
      Material{Emissive{.radiance = hidden.texture(ConstantTexture{{1, 1, 1}}), .hidden = true}});
  EXPECT_FALSE(possible(hidden));
}

TEST(Caustics, ReceiversHaveAWideLobe) {
  const Vec3 up{0, 0, 1};
  const SidedNormals normal{up, up};
  EXPECT_EQ(role_of_receiver(DiffuseBsdf{normal, gray(0.5f)}), CausticRole::kReceiver);
  EXPECT_EQ(role_of_receiver(MirrorBsdf{}), CausticRole::kOther);
  EXPECT_EQ(role_of_receiver(BlackBsdf{}), CausticRole::kOther);
  EXPECT_EQ(role_of_receiver(FuzzyMetalBsdf{normal, gray(0.5f), up, 1}), CausticRole::kOther);
  MetallicRoughnessBsdf gltf{};
  gltf.base = gray(0.5f);
  gltf.surface = {0.5, 0.25};
  EXPECT_EQ(role_of_receiver(gltf), CausticRole::kReceiver);
  gltf.surface = {0.4, 0.16};
  EXPECT_EQ(role_of_receiver(gltf), CausticRole::kPolishedReceiver);
  gltf.metallic = 1;
  EXPECT_EQ(role_of_receiver(gltf), CausticRole::kOther);
  gltf.metallic = 0;
  gltf.transmission = 0.5;
  gltf.chances[3] = 0.5;
  EXPECT_EQ(role_of_receiver(gltf), CausticRole::kOther);
  gltf = {};
  gltf.base = gray(0.5f);
  gltf.surface = {0.5, 0.25};
  gltf.coat = 1;
  gltf.coating = {0.1, 0.01};
  EXPECT_EQ(role_of_receiver(gltf), CausticRole::kPolishedReceiver);
  PlasticBsdf plastic{};
  plastic.diffuse = gray(0.5f);
  EXPECT_EQ(role_of_receiver(plastic), CausticRole::kReceiver);
  plastic.facets = Facets{};
  plastic.facets->alpha_u = 0.1;
  EXPECT_EQ(role_of_receiver(plastic), CausticRole::kPolishedReceiver);
  plastic.diffuse = {};
  EXPECT_EQ(role_of_receiver(plastic), CausticRole::kOther);
}

}  // namespace
}  // namespace bandsaw
