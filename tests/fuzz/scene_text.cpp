// Fuzz target (fuzz.h): a scene file, as text or JSON, through the importer, without any other
// files. The imported scene is encoded as a scene package, the form in which workers get scenes,
// and this package must be decodable.

#include <fstream>

#include "renderlib/base/check.h"
#include "renderlib/import/import.h"
#include "renderlib/package/package.h"
#include "tests/fuzz/fuzz.h"
#include "tests/support/temp_dir.h"

void bandsaw::fuzz::run(absl::Span<const std::uint8_t> input) {
  static const test::TempDir folder;
  const bool json = !input.empty() && input.front() == '{';
  const std::string path = folder / (json ? "scene.json" : "scene.textproto");
  std::ofstream(path, std::ios::binary) << text(input);
  const absl::StatusOr<ImportedScene> imported = import_scene(path);
  if (!imported.ok()) {
    return;
  }
  BlobMap blobs;
  const std::string manifest = encode_package(imported->scene, imported->info, blobs);
  const auto decoded = decode_package(manifest, blobs);
  BANDSAW_CHECK(decoded.ok(), decoded.status().ToString().c_str());
}
