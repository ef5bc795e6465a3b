// Compares indirect light from photon maps with a closed form, and checks that paths with maps have
// the same expected value as paths without. A receiver is a surface with wide lobes. At the second
// receiver of a path, the light that arrives from other receivers is estimated from photons. So the
// path goes on from there only for light that no receiver scatters on its way to the second one,
// and it ends at the third receiver.

#include "renderlib/integrate/indirect_photons.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <string>
#include <vector>

#include "renderlib/integrate/guiding_training.h"
#include "renderlib/integrate/make_photon_maps.h"
#include "renderlib/integrate/path.h"
#include "renderlib/math/constants.h"
#include "renderlib/render/render_band.h"
#include "tests/support/scenes.h"
#include "tests/support/statistics.h"
#include "tests/unit/integrate/same_mean.h"

namespace bandsaw {
namespace {

using test::add_room;
using test::SceneMaker;

/// The stop flag of a computation that is not stopped.
const std::atomic<bool> kGoOn = false;

/// Returns the sources of photon maps of indirect light and, where possible, of caustics.
PhotonSources sources_of(const Scene& scene, std::uint32_t max_depth) {
  const Casters all(scene);
  const Casters casters = can_have_caustic_maps(scene, all) ? all : Casters::none(scene);
  return {casters, surfaces_of_indirect_light(scene, casters), {}, max_depth};
}

/// Makes the photon maps of these sources. `photons`: photons that are started for caustics.
std::shared_ptr<const TracedMaps> maps_of(const Scene& scene, const PhotonSources& sources,
                                          std::uint64_t seed, std::uint64_t photons,
                                          int threads = 2) {
  Pool pool(threads);
  return make_photon_maps(scene, sources, {.seed = seed, .photons = photons}, {pool, kGoOn});
}

// Inside a ball of radius R and reflectance r, a point light of intensity I in the middle gives the
// irradiance E = I / R^2 everywhere. After all scatterings, the radiance is r E / (pi (1 - r)).
// With maps of the light of the second and later scatterings, hardly any noise is left.
TEST(IndirectPhotons, MeetTheClosedFormOfALampInABall) {
  for (const float reflectance : {0.3f, 0.8f}) {
    SceneMaker maker;
    maker.sphere({0, 0, 0}, 2, maker.diffuse(reflectance));
    maker.scene.lights.push_back(PointLight{.position = {0, 0, 0}, .intensity = {4, 4, 4}});
    maker.camera({0.5, 0, 0}, {0, 0, -1}, 60);
    const auto scene = maker.build();
    constexpr std::uint32_t kDepth = 60;
    const PhotonSources sources = sources_of(*scene, kDepth);
    test::Moments moments;
    for (std::uint64_t seed = 0; seed < 24; ++seed) {
      const auto traced = maps_of(*scene, sources, seed, 1 << 14);
      EXPECT_GT(traced->gather_distance, 0);
      EXPECT_LT(traced->gather_distance, 2);
      PhotonMaps maps(sources.casters);
      maps.use_for_all(*traced);
      const PathOptions options{.max_depth = kDepth, .maps = &maps};
      test::Moments of_map;
      PathCounts counts;
      for (std::uint32_t i = 0; i < 200; ++i) {
        const Vec3 to{std::cos(0.1 * i), std::sin(0.1 * i), 0.01 * i - 1};
        const Ray ray{.origin = {0.5, 0, 0}, .direction = normalize(to)};
        of_map.add(path_radiance(*scene, ray, PixelSampler(5, i, 0), seed, options, counts).g);
      }
      moments.add(of_map.mean());
    }
    const double expected = reflectance * 1.0 / (kPi * (1 - reflectance));
    EXPECT_LE(std::abs(moments.mean() - expected), 4 * moments.standard_error() + 0.005 * expected)
        << moments.mean() << " and " << expected;
    EXPECT_LT(moments.standard_error(), 0.01 * expected);
  }
}

/// A room with a lamp in a bowl that is open to the top, so that the ceiling lights the room. The
/// first material is that of the walls, and the first texture is its reflectance.
SceneMaker uplit_room() {
  SceneMaker maker;
  add_room(maker, maker.diffuse(0.6f));
  const MaterialId bowl = maker.diffuse(0.3f);
  maker.quad({-0.5, -0.5, -0.3}, {1, 0, 0}, {0, 1, 0}, bowl);
  maker.quad({-0.5, -0.5, -0.3}, {1, 0, 0}, {0, 0, 0.5}, bowl);
  maker.quad({-0.5, 0.5, -0.3}, {1, 0, 0}, {0, 0, 0.5}, bowl);
  maker.quad({-0.5, -0.5, -0.3}, {0, 1, 0}, {0, 0, 0.5}, bowl);
  maker.quad({0.5, -0.5, -0.3}, {0, 1, 0}, {0, 0, 0.5}, bowl);
  maker.sphere({0, 0, 0}, 0.1, maker.lamp(50));
  return maker;
}

/// A scene whose image is compared with and without maps.
struct Case {
  std::string name;
  SceneMaker maker;
  std::uint32_t max_depth = 8;
  std::uint32_t maps = 12;
};

/// A room whose lamp lights only a spot of the ceiling, so that each point of the spot is the start
/// of many photons.
SceneMaker room_with_a_spot() {
  SceneMaker maker;
  add_room(maker, maker.diffuse(0.6f));
  maker.quad({-1.3, -1.3, 1.69}, {0.6, 0, 0}, {0, 0.6, 0}, maker.diffuse(0.3f));
  maker.quad({-1.1, -1.1, 1.7}, {0.2, 0, 0}, {0, 0.2, 0}, maker.lamp(50));
  return maker;
}

/// Returns ten cases. All except the lit spot are variations of uplit_room().
std::vector<Case> cases() {
  std::vector<Case> all;
  const auto add = [&](const std::string& name) -> Case& {
    return all.emplace_back(Case{.name = name, .maker = uplit_room()});
  };
  add("diffuse");
  add("short paths").max_depth = 3;
  add("no depth left for indirect light").max_depth = 2;
  SceneMaker& mirror = add("a mirror on the floor").maker;
  mirror.quad({-1.9, -1.9, -1.9}, {3.8, 0, 0}, {0, 3.8, 0}, mirror.metal(0.9f, 0));
  SceneMaker& glass = add("glass around the lamp").maker;
  glass.sphere({0, 0, 0}, 0.18, glass.glass(1.5));
  SceneMaker& rough = add("rough metal, which casts no caustics").maker;
  rough.quad({-1.9, -1.9, -1.9}, {3.8, 0, 0}, {0, 3.8, 0}, rough.metal(0.9f, 0.8));
  SceneMaker& coat = add("walls with a smooth coat").maker;
  coat.scene.materials.front() = Plastic{.reflectance = TextureId{0}};
  // Few points are lit, so the brightness differs from map to map.
  SceneMaker& spot =
      all.emplace_back(
             Case{.name = "a lit spot of a rough coat", .maker = room_with_a_spot(), .maps = 16})
          .maker;
  spot.scene.materials.front() =
      Plastic{.reflectance = TextureId{0}, .surface = {.alpha_u = 0.4, .alpha_v = 0.4}};
  SceneMaker& screen = add("a half transparent screen").maker;
  Material half = screen.scene.materials.front();
  half.alpha = {AlphaMode::kBlend, {TextureId{0}, 0.5}};
  screen.quad({0.7, -2, -2}, {0, 4, 0}, {0, 0, 4}, screen.material(half));
  SceneMaker& window = add("a background behind a window").maker;
  Quad& wall = window.scene.geometry.quads[2];
  wall = Quad{{-2, -2, -2}, {0, 4, 0}, {0, 0, 3}, wall.material};
  window.background({2, 2, 2}, {2, 2, 2});
  return all;
}

// In each of the ten cases, paths with maps must have the same mean as paths without maps.
TEST(IndirectPhotons, ChangeNoMean) {
  for (const Case& tested : cases()) {
    SCOPED_TRACE(tested.name);
    const auto scene = tested.maker.build();
    const PhotonSources sources = sources_of(*scene, tested.max_depth);
    ASSERT_TRUE(sources.surfaces);
    const Ray ray{.origin = {0, 0, 1.9}, .direction = normalize(Vec3{1.2, 1, -1.5})};
    test::expect_same_mean(*scene, sources, ray,
                           {.max_depth = tested.max_depth,
                            .maps = tested.maps,
                            .paths = 4096,
                            .photons = 1 << 15,
                            .max_deviation = 0.05});
  }
}

/// Traces 500 photons. They start at those of 2,000 random points that are lit. `power`: if it is
/// not null, receives the luminance of all light that leaves these points.
TracedPhotons traced_500(const Scene& scene, const PhotonSources& sources,
                         double* power = nullptr) {
  const TracedMaps none;
  PhotonMaps maps(sources.casters);
  maps.use_for_all(none);
  const PhotonOrigins origins =
      find_origins(scene, sources, maps, {.seed = 1, .photons = 2000, .last = 2000});
  EXPECT_GT(origins.items.size(), 100u);
  std::vector<double> up_to;
  double sum = 0;
  for (const PhotonOrigin& origin : origins.items) {
    sum += luminance(origin.power);
    up_to.push_back(sum);
  }
  if (power != nullptr) {
    *power = sum;
  }
  return trace_indirect_photons(scene, sources, origins.items, up_to,
                                {.seed = 1, .photons = 500, .last = 500});
}

// Each photon starts with the luminance of all light divided by the number of photons. Absorption
// ends photons and does not dim them, so in grey rooms all photons keep this luminance.
TEST(IndirectPhotons, HaveEqualPower) {
  const auto scene = uplit_room().build();
  double sum = 0;
  const TracedPhotons traced = traced_500(*scene, sources_of(*scene, 8), &sum);
  ASSERT_GT(traced.photons.size(), 300u);
  for (const StoredPhoton& photon : traced.photons) {
    EXPECT_NEAR(luminance(photon.power), sum / 500, 1e-4 * sum / 500);
    // `chain` is the number of scatterings between the light and the photon's surface.
    EXPECT_GE(photon.chain, 1u);
    EXPECT_LT(photon.chain, 8u);
  }
}

// Without absorption only Russian roulette ends a photon, so that a map has a bounded size.
TEST(IndirectPhotons, EndWithoutAbsorption) {
  SceneMaker maker;
  add_room(maker, maker.diffuse(1));
  maker.sphere({0, 0, 0}, 0.1, maker.lamp(1));
  const auto scene = maker.build();
  const std::size_t stored = traced_500(*scene, sources_of(*scene, 500)).photons.size();
  // A photon is stored about 12 times on average: roulette begins after 8 scatterings, and ends a
  // quarter of the photons at each further scattering.
  EXPECT_GT(stored, 500u * 8);
  EXPECT_LT(stored, 500u * 14);
}

// A pane divides the room. The light that passes it does not count as scattered, so with two
// scatterings nearly all photons arrive at a wall. A few photons meet the lamp or are reflected by
// the pane.
TEST(IndirectPhotons, PassAPaneThatDoesNotCountAsAScattering) {
  SceneMaker maker;
  add_room(maker, maker.diffuse(0.6f));
  maker.sphere({-1.2, 0, 0}, 0.2, maker.lamp(10));
  maker.quad({-0.2, -2, -2}, {0, 4, 0}, {0, 0, 4},
             maker.material(ThinDielectric{.free_passage = true}));
  const auto scene = maker.build();
  const std::vector<StoredPhoton> photons = traced_500(*scene, sources_of(*scene, 2)).photons;
  EXPECT_GT(photons.size(), 450u);
  for (const StoredPhoton& photon : photons) {
    ASSERT_EQ(photon.chain, 1u);
  }
}

TEST(IndirectPhotons, DependOnTheSeedAndNotOnThreads) {
  const auto scene = uplit_room().build();
  const PhotonSources sources = sources_of(*scene, 8);
  const auto one = maps_of(*scene, sources, 3, 1 << 13, 1);
  const auto three = maps_of(*scene, sources, 3, 1 << 13, 3);
  ASSERT_GT(one->indirect.size(), 100u);
  ASSERT_EQ(one->indirect.size(), three->indirect.size());
  EXPECT_EQ(one->gather_distance, three->gather_distance);
  for (std::size_t i = 0; i < one->indirect.size(); ++i) {
    const StoredPhoton& a = one->indirect.photons()[i];
    const StoredPhoton& b = three->indirect.photons()[i];
    ASSERT_TRUE(a.position == b.position && a.radius == b.radius && a.power == b.power);
  }
  EXPECT_NE(maps_of(*scene, sources, 4, 1 << 13)->indirect.photons()[0].position,
            one->indirect.photons()[0].position);
}

// Where only a background lights a scene, paths are split at the first surface. With maps, paths
// are not split, because each sample has one map.
TEST(IndirectPhotons, AreUsedWhereABackgroundLightsTheScene) {
  SceneMaker maker;
  add_room(maker, maker.diffuse(0.6f));
  maker.scene.geometry.quads.pop_back();
  maker.background({2, 2, 2}, {2, 2, 2});
  const auto scene = maker.build();
  ASSERT_GT(branches_for(*scene), 1u);
  Pool pool(2);
  const auto pixels = render_band(
      *scene, {.width = 8, .height = 6, .max_depth = 6, .integrator = Integrator::kPathGuided},
      {{0, 64}, {0, 6}}, pool, kGoOn, {});
  ASSERT_TRUE(pixels.ok()) << pixels.status();
  EXPECT_NE(pixels->counters.techniques & Counters::kIndirectMaps, 0u);
}

// The integrator `path` takes indirect light from maps where the light of a lamp reaches most of
// the room by way of the ceiling. It uses no maps where light sampling finds the light.
TEST(IndirectPhotons, AreUsedWhereTheyPay) {
  Pool pool(2);
  const auto are_used = [&](const SceneMaker& maker) {
    const auto scene = maker.build();
    const auto trained = train_guiding(*scene, {64, 48, 16, /*only_if_it_pays=*/true},
                                       {pool, kGoOn}, /*photon_maps=*/true);
    return trained->sources != nullptr && trained->sources->surfaces;
  };
  EXPECT_TRUE(are_used(uplit_room()));
  SceneMaker bright;
  add_room(bright, bright.diffuse(0.2f));
  bright.quad({-1, -1, 1.9}, {0, 2, 0}, {2, 0, 0}, bright.lamp(10));
  EXPECT_FALSE(are_used(bright));
  // The room stands on a large plain. Hardly any of the points at which photons may start are in
  // the room.
  SceneMaker lost = uplit_room();
  lost.quad({-200, -200, -10}, {400, 0, 0}, {0, 400, 0}, MaterialId{0});
  EXPECT_FALSE(are_used(lost));
}

TEST(IndirectPhotons, HaveNoMapsWithNestedGlassOrHiddenLampsOrWithoutReceivers) {
  const auto possible = [](const SceneMaker& maker) {
    const auto scene = maker.build();
    return surfaces_of_indirect_light(*scene, Casters::none(*scene)).has_value();
  };
  const SceneMaker room = uplit_room();
  EXPECT_TRUE(possible(room));
  SceneMaker nested = room;
  nested.scene.materials.push_back(Material{Dielectric{.priority = 1}});
  EXPECT_FALSE(possible(nested));
  SceneMaker hidden = room;
  hidden.scene.materials.push_back(
      Material{Emissive{.radiance = hidden.texture(ConstantTexture{{1, 1, 1}}), .hidden = true}});
  EXPECT_FALSE(possible(hidden));
  SceneMaker lamp_only;
  lamp_only.sphere({0, 0, 0}, 1, lamp_only.lamp(1));
  EXPECT_FALSE(possible(lamp_only));
}

// A random point of two quads with the areas 1 and 3 lies on the second quad with probability 3/4.
// Its pdf is 1/4.
TEST(SurfaceSampler, IsUniformByArea) {
  SceneMaker maker;
  const MaterialId wall = maker.diffuse(0.5f);
  maker.quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, wall);
  maker.quad({0, 0, 5}, {3, 0, 0}, {0, 1, 0}, wall);
  const auto scene = maker.build();
  const auto surfaces = surfaces_of_indirect_light(*scene, Casters::none(*scene));
  ASSERT_TRUE(surfaces);
  int above = 0;
  for (int i = 0; i < 1000; ++i) {
    const auto sample = surfaces->sample(*scene, (i + 0.5) / 1000, 0.25, 0.5, 0);
    ASSERT_TRUE(sample);
    EXPECT_DOUBLE_EQ(sample->pdf, 0.25);
    EXPECT_DOUBLE_EQ(sample->point.position.y, 0.5);
    above += sample->point.position.z > 4 ? 1 : 0;
  }
  EXPECT_EQ(above, 750);
}

}  // namespace
}  // namespace bandsaw
