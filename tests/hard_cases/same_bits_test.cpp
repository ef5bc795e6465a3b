// Tests the hard cases C5, R6, R10, B12 and Y3 (cases.txt). The pixels' sums of thirteen gallery
// scenes have the hashes in same_bits.txt, in every build by every compiler. A change that alters
// pixels increments kPixelVersion. The table in same_bits.txt changes only together with
// kPixelVersion. If the test fails, the test prints the new table.

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iostream>
#include <map>
#include <string>

#include "absl/strings/str_format.h"
#include "renderlib/import/import.h"
#include "renderlib/render/hash64.h"
#include "renderlib/render/kernel.h"
#include "renderlib/render/pixel_version.h"
#include "renderlib/render/render_band.h"
#include "tests/support/hard_case.h"

namespace bandsaw {
namespace {

constexpr std::uint32_t kWidth = 20;
constexpr std::uint32_t kHeight = 15;
constexpr std::uint64_t kSamples = 16;

const char* const kScenes[] = {
    "cornell",   "spheres",   "glass_and_metal",   "textured",    "mesh",
    "instances", "motion",    "defocus",           "many_lights", "environment",
    "smoke",     "materials", "hard_light/uplight"};

/// A way to render a scene; all ways must give the same hash.
struct Rendering {
  int building_threads = 1;
  int threads = 1;
  std::uint32_t rows = kHeight;  ///< rows of a band
  SceneFeatures forced = {};
  Traversal traversal = Traversal::kBvh;
  const Kernel* kernel = nullptr;  ///< nullptr for the fastest
};

/// Returns the hash of the sums of all pixels, rendered as `how` says.
std::string hash_of(const ImportedScene& imported, const Rendering& how) {
  Pool building(how.building_threads);
  Pool pool(how.threads);
  const auto scene = Scene::build(imported.scene, building, how.forced, how.traversal, how.kernel);
  EXPECT_TRUE(scene.ok()) << scene.status();
  const RenderSettings settings{.width = kWidth,
                                .height = kHeight,
                                .max_depth = imported.info.max_depth,
                                .seed = 7,
                                .integrator = imported.info.integrator};
  const std::atomic<bool> stop = false;
  Hash64 hash;
  for (std::uint32_t y = 0; y < kHeight; y += how.rows) {
    const Band band{{0, kSamples}, {y, std::min(y + how.rows, kHeight)}};
    const auto pixels = render_band(**scene, settings, band, pool, stop, {});
    EXPECT_TRUE(pixels.ok()) << pixels.status();
    for (const double sum : pixels->sums) {
      hash.add(sum);
    }
  }
  return absl::StrFormat("%016x", hash.value());
}

/// Returns true if the scene is so small that each ray can be tested against all of its primitives.
bool is_small(const Geometry& geometry) {
  const auto few = [](const Mesh& mesh) { return mesh.triangles.size() <= 2'000; };
  return geometry.instances.size() <= 10 &&
         std::all_of(geometry.meshes.begin(), geometry.meshes.end(), few);
}

/// The contents of same_bits.txt.
struct Table {
  std::uint32_t pixel_version = 0;            ///< kPixelVersion when the hashes were recorded
  std::map<std::string, std::string> hashes;  ///< hash of each scene, by the scene's name
};

Table read_table() {
  std::ifstream file(BANDSAW_SOURCE "/tests/hard_cases/same_bits.txt");
  Table table;
  std::string words;
  file >> words >> table.pixel_version;
  for (std::string name, hash; file >> name >> hash;) {
    table.hashes[name] = hash;
  }
  return table;
}

TEST(SameBits, C5R6R10B12Y3_ThirteenScenesHaveTheirHashes) {
  const Table table = read_table();
  EXPECT_EQ(table.pixel_version, kPixelVersion);
  std::string now = absl::StrFormat("pixel_version %d\n", kPixelVersion);
  for (const std::string name : kScenes) {
    SCOPED_TRACE(name);
    const auto imported = import_scene(BANDSAW_GALLERY "/" + name + ".textproto");
    ASSERT_TRUE(imported.ok()) << imported.status();
    const std::string hash = hash_of(*imported, {});
    now += name + " " + hash + "\n";
    EXPECT_EQ(hash, table.hashes.count(name) == 1 ? table.hashes.at(name) : "");
    for (const int threads : {2, 3, 8}) {
      EXPECT_EQ(hash_of(*imported, {.building_threads = threads, .threads = threads}), hash);
    }
    for (const std::uint32_t rows : {1u, 3u, 7u}) {
      EXPECT_EQ(hash_of(*imported, {.threads = 2, .rows = rows}), hash) << rows;
    }
    EXPECT_EQ(hash_of(*imported, {.forced = kAllFeatures}), hash) << "all features";
    for (const Kernel* kernel : kernels()) {
      EXPECT_EQ(hash_of(*imported, {.kernel = kernel}), hash) << kernel->name;
    }
    if (is_small(imported->scene.geometry)) {
      EXPECT_EQ(hash_of(*imported, {.traversal = Traversal::kBruteForce}), hash) << "no tree";
    }
  }
  if (HasFailure()) {
    std::cout << now;
  }
  test::report_hard_case("C5",
                         "13 scenes: the hash of a scene is equal for 1, 2, 3, 8 threads and for "
                         "bands of 1, 3, 7, 15 rows");
  test::report_hard_case(
      "B12",
      "13 scenes: the hash of a scene is equal for trees built by 1, 2, 3, 8 threads and for code "
      "with all features; the hash of a small scene is also equal for brute force");
  test::report_hard_case("Y3",
                         "13 scenes: each kernel of this build gives the hashes in same_bits.txt");
  test::report_hard_case("R10", "13 scenes: this build gives the hashes in same_bits.txt");
}

}  // namespace
}  // namespace bandsaw
