// The globe is a generated map of a planet, a texture of scenes in gallery/study. Rendering with it
// takes little more memory than the bytes of its texels.

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <fstream>

#include "coordinator/cli/scene/import_process.h"
#include "renderlib/base/atomic_file.h"
#include "renderlib/gallery/globe.h"
#include "renderlib/image/png.h"
#include "renderlib/render/render_image.h"
#include "tests/support/sanitized.h"
#include "tests/support/temp_dir.h"

namespace bandsaw::gallery {
namespace {

using test::TempDir;

// Generates the map with `rows` rows in the folder, and copies the scene of gallery/study that uses
// this map into the folder. Returns the path of the copied scene.
std::string scene_in(const TempDir& folder, std::uint32_t rows) {
  Pool pool(2);
  const auto png = encode_png(2 * rows, rows, globe_map(rows, pool));
  EXPECT_TRUE(png.ok());
  const std::string number = std::to_string(rows);
  EXPECT_TRUE(write_file_atomically(folder / ("globe_" + number + ".png"), *png).ok());
  const std::string scene = "texture_" + number + ".textproto";
  std::filesystem::copy_file(std::string(BANDSAW_GALLERY) + "/study/" + scene, folder / scene);
  return folder / scene;
}

// Returns the peak resident memory of this process since the last call of forget_peak(), in bytes.
// 0: the peak is unknown.
std::uint64_t peak_bytes() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("VmHWM:")) {
      return std::stoull(line.substr(6)) * 1024;
    }
  }
  return 0;
}
// Starts a new measurement of the peak. Returns false if this fails.
bool forget_peak() {
  std::ofstream file("/proc/self/clear_refs");
  file << "5" << std::flush;
  return file.good();
}

// Imports the scene and renders it with 400 x 400 pixels. Returns the peak resident memory after
// the import, in bytes.
std::uint64_t peak_of_render(const std::string& scene_path) {
  coordinator::ImportLimits limits;
  limits.program = BANDSAW_IMPORT_BIN;
  auto package = coordinator::import_in_process(scene_path, limits);
  EXPECT_TRUE(package.ok()) << package.status();
  EXPECT_TRUE(forget_peak());
  auto description = decode_package(package->manifest(), package->blobs());
  EXPECT_TRUE(description.ok()) << description.status();
  Pool pool(2);
  const auto scene = Scene::build(*std::move(description), pool);
  EXPECT_TRUE(scene.ok()) << scene.status();
  const RenderSettings settings{
      .width = 400, .height = 400, .max_depth = 4, .integrator = package->info().integrator};
  const std::atomic<bool> stop = false;
  EXPECT_TRUE(render_image(**scene, settings, 4, pool, stop, {}, "").ok());
  return peak_bytes();
}

TEST(GlobeMemory, IsAtMostAFifthAboveTheTexels) {
  if (test::kSanitized) {
    GTEST_SKIP() << "a sanitizer's own memory would be counted";
  }
  const TempDir folder;
  const std::string small = scene_in(folder, 512);
  const std::string large = scene_in(folder, 2048);
  // Returns the bytes of the texels of a map, which has `rows` rows, twice as many columns, and
  // three bytes per texel.
  const auto texels = [](std::uint64_t rows) { return rows * 2 * rows * 3; };
  // The memory that a render needs besides the texels.
  const std::uint64_t base = peak_of_render(small) - texels(512);
  const std::uint64_t taken = peak_of_render(large) - base;
  RecordProperty("bytes_over_texel_bytes",
                 std::to_string(static_cast<double>(taken) / static_cast<double>(texels(2048))));
  // A value clearly below the bytes of the texels would mean that nothing was measured. The bound
  // is 5 % below, because the other memory of the two renders differs by a few pages.
  EXPECT_GE(static_cast<double>(taken), 0.95 * static_cast<double>(texels(2048)));
  EXPECT_LE(static_cast<double>(taken), 1.2 * static_cast<double>(texels(2048)));
}

}  // namespace
}  // namespace bandsaw::gallery
