// Tests the renderer in a browser's tab, through the functions that the renderer exports. Its
// pixels have the same bytes as those of a native worker. A lease is a message that assigns a band
// (some samples of some rows) to a worker. The renderer renders a band in parts of a few rows.
// Parts should end at multiples of the row step. If the scene shares paths between pixels, the row
// step is 16, the height of a tile; otherwise it is 1. A digest is passed as 64 hexadecimal digits.
// The helper good() expects that a call succeeds, and error_of() that a call fails. Both return the
// answer of the call.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <future>
#include <random>

#include "absl/strings/str_cat.h"
#include "proto/convert/render_values.h"
#include "proto/farm.pb.h"
#include "renderlib/package/package.h"
#include "renderlib/render/tile_pattern.h"
#include "tests/support/scenes.h"
#include "tests/unit/browser/answers.h"
#include "worker/browser/exports.h"
#include "worker/executor/executor.h"

namespace bandsaw::worker {
namespace {

using ::testing::HasSubstr;

/// Returns a scene of two meshes, one of them with an image as texture, in front of a sky. `shift`:
/// the camera's x.
SceneDescription textured_meshes(float shift) {
  test::SceneMaker maker;
  maker.camera({shift, 1, 6}, {0, 0, 0}, 40);
  maker.background({0.2f, 0.3f, 0.4f}, {1, 1, 1});
  ImageTexture image;
  image.width = 4;
  image.height = 4;
  image.format = ImageTexture::Format::kSrgb8;
  std::vector<std::byte> texels;
  for (int i = 0; i < 48; ++i) {
    texels.push_back(static_cast<std::byte>(i * 5));
  }
  image.texels = std::move(texels);
  maker.scene.textures.emplace_back(std::move(image));
  maker.scene.materials.emplace_back(Diffuse{TextureId{0}});
  maker.instance(test::grid(12), {}, MaterialId{0});
  maker.instance(test::grid(3), translation({1, 0.5, -2}), maker.metal(0.8f, 0.1));
  return maker.scene;
}

class BrowserRendererTest : public ::testing::Test {
 protected:
  BrowserRendererTest() : renderer_(bandsaw_renderer_new()) {}
  ~BrowserRendererTest() override { bandsaw_renderer_delete(renderer_); }

  /// Adds a scene to `farm_`: its blobs (arrays such as meshes and textures) and its manifest,
  /// which lists the blobs. Returns the digest of the manifest.
  wire::Digest add(const SceneDescription& scene) {
    const std::string text = encode_package(scene, {}, farm_);
    const auto* data = reinterpret_cast<const std::byte*>(text.data());
    return farm_.put(std::vector<std::byte>(data, data + text.size()));
  }

  const BandsawAnswer* add_blob(const wire::Digest& digest, absl::Span<const std::byte> bytes) {
    void* memory = bandsaw_allocate(bytes.size());
    std::copy(bytes.begin(), bytes.end(), static_cast<std::byte*>(memory));
    return bandsaw_renderer_add_blob(renderer_, digest.hex().c_str(), 64, memory, bytes.size());
  }
  const BandsawAnswer* begin(const wire::Digest& manifest) {
    const SharedBytes& bytes = farm_.all().at(manifest);
    return bandsaw_renderer_begin_scene(renderer_, manifest.hex().c_str(), 64, bytes.data(),
                                        bytes.size());
  }
  const BandsawAnswer* build(const wire::Digest& manifest) {
    return bandsaw_renderer_build_scene(renderer_, manifest.hex().c_str(), 64);
  }
  /// Loads a scene into the renderer: adds the blobs that the renderer does not have yet, and
  /// builds the scene. Returns the number of blobs that were added.
  std::size_t load(const wire::Digest& manifest) {
    const std::string wanted = good(begin(manifest));
    std::size_t count = 0;
    for (const auto& [digest, bytes] : farm_.all()) {
      const std::string entry =
          absl::StrCat("{\"digest\":\"", digest.hex(), "\",\"size\":", bytes.size(), "}");
      if (wanted.find(entry) != std::string::npos) {
        EXPECT_EQ(good(add_blob(digest, bytes.span())), "");
        ++count;
      }
    }
    row_step_ = good(build(manifest));
    return count;
  }

  static farm::Lease lease_of(const Task& task) {
    farm::Lease lease;
    lease.set_job(task.job);
    lease.set_manifest_sha256(task.manifest.raw());
    *lease.mutable_settings() = to_message(task.settings);
    *lease.mutable_band() = to_message(task.band);
    for (const std::uint32_t number : task.tiles.numbers()) {
      lease.add_tile_samples(number);
    }
    return lease;
  }
  const BandsawAnswer* render(const farm::Lease& lease, std::uint32_t first, std::uint32_t last) {
    const std::string bytes = lease.SerializeAsString();
    return bandsaw_renderer_render(renderer_, bytes.data(), bytes.size(), first, last);
  }

  /// Renders a band in parts that end at multiples of `step` rows. Returns the whole band, joined
  /// from the parts as the tab joins them.
  BandPixels pieces(const Task& task, std::uint32_t step) {
    BandPixels joined{.band = task.band, .width = task.settings.width, .sums = {}, .counters = {}};
    const farm::Lease lease = lease_of(task);
    for (std::uint32_t row = task.band.rows.first; row < task.band.rows.last;) {
      const std::uint32_t end = std::min((row / step + 1) * step, task.band.rows.last);
      const std::string bytes = good(render(lease, row, end));
      std::vector<double> sums(bytes.size() / sizeof(double));
      std::memcpy(sums.data(), bytes.data(), bytes.size());
      joined.sums.insert(joined.sums.end(), sums.begin(), sums.end());
      farm::Counters counters;
      EXPECT_TRUE(counters.ParseFromString(good(bandsaw_renderer_counters(renderer_))));
      joined.counters.add(counters_of(counters));
      row = end;
    }
    return joined;
  }

  /// Renders the band as a native worker does.
  BandPixels native(const Task& task, const SceneDescription& scene) {
    Pool pool(2);
    std::promise<FinishedBand> done;
    Executor executor(pool,
                      [&](const wire::Digest&, const std::atomic<bool>&, const Prepared&) {
                        return Scene::build(scene, pool);
                      },
                      {.preparing = [](TaskId, std::uint64_t) {},
                       .rendering = [](TaskId, std::uint32_t) {},
                       .finished = [&](FinishedBand band) { done.set_value(std::move(band)); },
                       .failed =
                           [&](const Task&, const absl::Status& status) {
                             ADD_FAILURE() << status;
                             done.set_value({});
                           }});
    executor.add(task);
    return done.get_future().get().pixels;
  }

  /// Expects that the band has the same sums as on a native worker. If the pixels of a tile share
  /// paths and a part ends within a tile, each part traces all paths of the tile. The counters are
  /// then higher, so they are compared only in other cases.
  void expect_same(const Task& task, const SceneDescription& scene, std::uint32_t step) {
    const BandPixels expected = native(task, scene);
    const BandPixels joined = pieces(task, step);
    ASSERT_EQ(joined.sums.size(), expected.sums.size());
    EXPECT_EQ(std::memcmp(joined.sums.data(), expected.sums.data(),
                          expected.sums.size() * sizeof(double)),
              0);
    EXPECT_GT(*std::max_element(joined.sums.begin(), joined.sums.end()), 0);
    if (step % kTileSide == 0 || row_step_ == "{\"row_step\":1}") {
      EXPECT_EQ(joined.counters, expected.counters);
    }
  }

  Task task(const wire::Digest& manifest, const Band& band) {
    return {.id = 1,
            .job = 1,
            .manifest = manifest,
            .settings = {.width = 40, .height = 40, .max_depth = 5, .seed = 3},
            .band = band};
  }

  BlobMap farm_;  ///< all blobs of the scenes, from which the tab would fetch them
  BandsawRenderer* renderer_;
  std::string row_step_;  ///< JSON, of the scene that was loaded last
};

TEST_F(BrowserRendererTest, SharedPathsGiveTheBytesOfANativeWorker) {
  const SceneDescription scene = test::cornell_box().scene;
  const wire::Digest manifest = add(scene);
  load(manifest);
  EXPECT_EQ(row_step_, "{\"row_step\":16}");
  for (const Band& band :
       {Band{{0, 16}, {0, 40}}, Band{{16, 32}, {3, 21}}, Band{{32, 64}, {16, 32}}}) {
    expect_same(task(manifest, band), scene, 16);
    expect_same(task(manifest, band), scene, 1);
  }
}

TEST_F(BrowserRendererTest, MeshesAndTexturesGiveTheBytesOfANativeWorker) {
  const SceneDescription scene = textured_meshes(0);
  const wire::Digest manifest = add(scene);
  load(manifest);
  EXPECT_EQ(row_step_, "{\"row_step\":1}");
  for (const Integrator integrator :
       {Integrator::kPath, Integrator::kDirect, Integrator::kNormals, Integrator::kPathGuided}) {
    Task band_task = task(manifest, {{16, 32}, {5, 30}});
    band_task.settings.integrator = integrator;
    expect_same(band_task, scene, 7);
  }
}

// Adaptive sampling takes a range of samples for each half tile, which is half of the pixels of a
// tile. The ranges of the half tiles differ here.
TEST_F(BrowserRendererTest, HalfTilesWithDifferentSamplesGiveTheBytesOfANativeWorker) {
  for (const SceneDescription& scene : {test::cornell_box().scene, textured_meshes(0)}) {
    const wire::Digest manifest = add(scene);
    load(manifest);
    Task adaptive = task(manifest, {{64, 128}, {0, 40}});
    adaptive.tiles = TileSamples(40, {0, 40});
    const SampleRange samples[] = {{16, 32}, {0, 0}, {0, 16}, {32, 64}, {64, 128}};
    for (std::size_t i = 0; i < 18; ++i) {  // 3 x 3 tiles of two half tiles each
      adaptive.tiles.set(i, samples[i % 5]);
    }
    expect_same(adaptive, scene, 16);
    expect_same(adaptive, scene, 3);
  }
}

TEST_F(BrowserRendererTest, AFrameNeedsOnlyTheBlobsThatChanged) {
  const SceneDescription first = textured_meshes(0);
  const SceneDescription second = textured_meshes(1);  // another camera
  const wire::Digest manifests[] = {add(first), add(second)};
  EXPECT_GT(load(manifests[0]), 3U);
  EXPECT_EQ(load(manifests[1]), 0U);
  expect_same(task(manifests[1], {{0, 16}, {0, 8}}), second, 4);
  expect_same(task(manifests[0], {{0, 16}, {0, 8}}), first, 4);
  for (const wire::Digest& manifest : manifests) {
    good(bandsaw_renderer_drop_scene(renderer_, manifest.hex().c_str(), 64));
  }
  EXPECT_THAT(error_of(render(lease_of(task(manifests[0], {{0, 16}, {0, 8}})), 0, 8)),
              HasSubstr("not loaded"));
  EXPECT_GT(load(manifests[1]), 3U) << "no scene keeps the meshes, so they must be added again";
}

TEST_F(BrowserRendererTest, ShowsTheRowsThatItRendered) {
  const wire::Digest manifest = add(textured_meshes(0));
  load(manifest);
  good(render(lease_of(task(manifest, {{0, 16}, {0, 40}})), 2, 5));
  const std::string picture = good(bandsaw_renderer_picture(renderer_));
  ASSERT_EQ(picture.size(), 3U * 40 * 4);
  for (std::size_t i = 0; i < picture.size(); i += 4) {
    EXPECT_EQ(picture[i + 3], '\xff');
  }
  EXPECT_NE(picture.substr(0, 3), std::string(3, '\0')) << "the sky must not be black";
}

TEST_F(BrowserRendererTest, RefusesInvalidCalls) {
  const wire::Digest manifest = add(textured_meshes(0));
  const std::vector<std::byte> some(7);
  EXPECT_THAT(error_of(build(manifest)), HasSubstr("no scene was begun"));
  EXPECT_THAT(error_of(add_blob(manifest, some)), HasSubstr("no scene was begun"));
  good(begin(manifest));
  EXPECT_THAT(error_of(add_blob(manifest, some)), HasSubstr("has no blob"));
  EXPECT_THAT(error_of(build(manifest)), HasSubstr("is missing"));
  const std::string no_digest(64, 'x');
  EXPECT_THAT(error_of(bandsaw_renderer_drop_scene(renderer_, no_digest.c_str(), 64)),
              HasSubstr("64 hexadecimal digits"));
  load(manifest);
  const farm::Lease lease = lease_of(task(manifest, {{0, 16}, {4, 8}}));
  EXPECT_THAT(error_of(render(lease, 3, 8)), HasSubstr("do not lie in the band"));
  EXPECT_THAT(error_of(render(lease, 4, 9)), HasSubstr("do not lie in the band"));
  EXPECT_THAT(error_of(render(lease, 5, 5)), HasSubstr("do not lie in the band"));
  good(render(lease, 4, 8));
}

// A manifest or a lease has a wrong byte, or its end is missing. The answer is an error or a
// result, and the renderer still renders afterwards.
TEST_F(BrowserRendererTest, AnswersDamagedInput) {
  const SceneDescription scene = textured_meshes(0);
  const wire::Digest manifest = add(scene);
  load(manifest);
  const farm::Lease valid = lease_of(task(manifest, {{0, 16}, {0, 2}}));
  std::mt19937 random(1);
  const auto damage = [&](absl::string_view bytes) {
    std::string damaged(
        bytes.substr(0, random() % 4 == 0 ? random() % bytes.size() : bytes.size()));
    if (!damaged.empty()) {
      damaged[random() % damaged.size()] = static_cast<char>(random());
    }
    return damaged;
  };
  const SharedBytes& text = farm_.all().at(manifest);
  const absl::string_view whole(reinterpret_cast<const char*>(text.data()), text.size());
  const std::string name = wire::sha256(std::string("damaged")).hex();
  int built = 0;
  for (int i = 0; i < 300; ++i) {
    const std::string bad = damage(whole);
    if (bandsaw_renderer_begin_scene(renderer_, name.c_str(), 64, bad.data(), bad.size())->failed ==
        0) {
      for (const auto& [digest, bytes] : farm_.all()) {
        add_blob(digest, bytes.span());
      }
      built += bandsaw_renderer_build_scene(renderer_, name.c_str(), 64)->failed == 0;
    }
    bandsaw_renderer_drop_scene(renderer_, name.c_str(), 64);
    const std::string lease = damage(valid.SerializeAsString());
    bandsaw_renderer_render(renderer_, lease.data(), lease.size(), 0, 2);
  }
  EXPECT_GT(built, 0) << "damage that changes only values must give a scene";
  EXPECT_LT(built, 300);
  expect_same(task(manifest, {{0, 16}, {0, 4}}), scene, 2);
}

}  // namespace
}  // namespace bandsaw::worker
