// The features of a scene (scene_features.h) are flags such as "has moving shapes". A flag that is
// not set only skips work that would change nothing. So every scene of the gallery is rendered to
// the same bits with its own features and with all features.

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <vector>

#include "coordinator/cli/scene/import_process.h"
#include "renderlib/base/atomic_file.h"
#include "renderlib/gallery/globe.h"
#include "renderlib/image/png.h"
#include "renderlib/render/render_band.h"
#include "tests/support/temp_dir.h"

namespace bandsaw::gallery {
namespace {

namespace fs = std::filesystem;

struct Loaded {
  SceneDescription description;
  PackageInfo info;
};

class GalleryFeatures : public testing::Test {
 protected:
  // Copies the gallery and adds the maps of the globe, which are generated textures that the
  // repository does not have. Small maps suffice, because no feature depends on the number of
  // texels.
  void SetUp() override {
    fs::copy(BANDSAW_GALLERY, folder_.path(), fs::copy_options::recursive);
    constexpr std::uint32_t kRows = 64;
    const auto globe = encode_png(2 * kRows, kRows, globe_map(kRows, pool_));
    ASSERT_TRUE(globe.ok()) << globe.status();
    for (const char* map : {"study/globe_512.png", "study/globe_1024.png", "study/globe_2048.png",
                            "study/globe_4096.png", "books/globe_512.png"}) {
      ASSERT_TRUE(write_file_atomically(folder_ / map, *globe).ok());
    }
  }

  std::vector<std::string> scenes() const {
    std::vector<std::string> out;
    for (const auto& entry : fs::recursive_directory_iterator(folder_.path())) {
      if (entry.path().extension() == ".textproto") {
        out.push_back(fs::relative(entry.path(), folder_.path()));
      }
    }
    std::sort(out.begin(), out.end());
    return out;
  }

  Loaded load(const std::string& scene) {
    coordinator::ImportLimits limits;
    limits.program = BANDSAW_IMPORT_BIN;
    auto package = coordinator::import_in_process(folder_ / scene, limits);
    EXPECT_TRUE(package.ok()) << package.status();
    auto description = decode_package(package->manifest(), package->blobs());
    EXPECT_TRUE(description.ok()) << description.status();
    return {*std::move(description), package->info()};
  }

  // Renders 16 samples of each pixel of a small picture, and returns the sums. `forced`: features
  // that are set in addition to those of the scene.
  std::vector<double> sums(const Loaded& scene, Integrator integrator,
                           const SceneFeatures& forced) {
    const auto built = Scene::build(scene.description, pool_, forced);
    EXPECT_TRUE(built.ok()) << built.status();
    EXPECT_EQ((*built)->features(), (*built)->features() | forced);
    const RenderSettings settings{.width = 16,
                                  .height = 16,
                                  .max_depth = std::min(scene.info.max_depth, 8u),
                                  .integrator = integrator};
    const std::atomic<bool> stop = false;
    const auto pixels = render_band(**built, settings, {{0, 16}, {0, 16}}, pool_, stop, {});
    EXPECT_TRUE(pixels.ok()) << pixels.status();
    return pixels->sums;
  }

  const test::TempDir folder_;
  Pool pool_{2};
};

TEST_F(GalleryFeatures, AllTogetherGiveTheSameBitsOnEveryScene) {
  const std::vector<std::string> all = scenes();
  EXPECT_GE(all.size(), 60u);
  for (const std::string& scene : all) {
    const Loaded loaded = load(scene);
    EXPECT_TRUE(sums(loaded, loaded.info.integrator, kAllFeatures) ==
                sums(loaded, loaded.info.integrator, {}))
        << scene;
  }
}

// Renders scenes that have few features of their own, so most features are forced. Each scene is
// rendered with all integrators.
TEST_F(GalleryFeatures, EachAloneGivesTheSameBitsByEveryIntegrator) {
  for (const char* scene : {"cornell.textproto", "spheres.textproto", "textured.textproto",
                            "study/lights_0.textproto"}) {
    const Loaded loaded = load(scene);
    for (int i = 0; i <= kLastIntegrator; ++i) {
      const auto integrator = static_cast<Integrator>(i);
      const std::vector<double> own = sums(loaded, integrator, {});
      EXPECT_TRUE(sums(loaded, integrator, kAllFeatures) == own) << scene;
      for (const NamedFeature& each : kEachFeature) {
        SceneFeatures forced;
        forced.*each.feature = true;
        EXPECT_TRUE(sums(loaded, integrator, forced) == own)
            << scene << ", " << each.name << ", " << integrator_name(integrator);
      }
    }
  }
}

}  // namespace
}  // namespace bandsaw::gallery
