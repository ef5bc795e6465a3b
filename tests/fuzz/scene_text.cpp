// A scene file, as text or JSON, through the importer, without any other files.

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "renderlib/base/check.h"
#include "renderlib/import/import.h"
#include "renderlib/package/package.h"
#include "tests/fuzz/fuzz.h"

namespace {

/// A folder that contains only the scene, for this process.
class Folder {
 public:
  Folder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "fuzz-scene-XXXXXX").string();
    BANDSAW_CHECK(mkdtemp(pattern.data()) != nullptr, "a temporary folder can be made");
    path_ = pattern;
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string file(const char* name) const { return path_ + "/" + name; }

 private:
  std::string path_;
};

}  // namespace

void bandsaw::fuzz::run(absl::Span<const std::uint8_t> input) {
  static const Folder folder;
  const bool json = !input.empty() && input.front() == '{';
  const std::string path = folder.file(json ? "scene.json" : "scene.textproto");
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
