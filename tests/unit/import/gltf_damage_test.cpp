// Compressed glTF files that have been damaged, read by the confined import process.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coordinator/cli/scene/import_process.h"
#include "tests/support/random.h"
#include "tests/unit/import/compressed_gltf.h"

namespace bandsaw::coordinator {
namespace {

using test::GltfWriter;
using test::Json;
using test::TempDir;
using test::WavySquare;
using test::with_draco;
using test::with_meshopt;
using test::write_text;
using ::testing::HasSubstr;

// In each file, random bytes of the binary part are replaced. The file is then read, or it gives an
// error that names the file.
TEST(CompressedGltf, RandomDamageIsAnErrorOrHarmless) {
  const TempDir folder;
  const WavySquare square(6);
  GltfWriter meshopt = with_meshopt(square, false, 2);
  // A .glb file has a single buffer, so the views must not refer to a second one.
  meshopt.root.erase("buffers");
  for (Json& view : meshopt.root["bufferViews"]) {
    view["buffer"] = 0;
  }
  const std::string files[] = {with_draco(square, 11, true).glb(),
                               with_draco(square, 0, false).glb(), meshopt.glb()};
  ImportLimits limits;
  limits.program = BANDSAW_IMPORT_BIN;
  limits.seconds = 20;
  limits.memory_bytes = 2ull << 30;
  test::Random random(17);
  int read = 0;
  int refused = 0;
  for (int i = 0; i < 90; ++i) {
    std::string bytes = files[i % 3];
    const std::size_t binary = bytes.find(std::string("BIN\0", 4)) + 4;
    for (int n = 0; n <= i % 4; ++n) {
      const auto at =
          static_cast<std::size_t>(random.uniform() * static_cast<double>(bytes.size() - binary));
      bytes[binary + at] = static_cast<char>(256 * random.uniform());
    }
    const auto imported = import_in_process(write_text(folder, "r.glb", bytes), limits);
    ++(imported.ok() ? read : refused);
    if (!imported.ok()) {
      EXPECT_THAT(std::string(imported.status().message()), HasSubstr("r.glb"));
      EXPECT_NE(imported.status().code(), absl::StatusCode::kDeadlineExceeded);
    }
  }
  EXPECT_GT(read, 0);
  EXPECT_GT(refused, 0);
}

}  // namespace
}  // namespace bandsaw::coordinator
