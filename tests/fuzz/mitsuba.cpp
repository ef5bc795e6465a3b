// Fuzz target (fuzz.h): an input that begins with '<' is a scene of Mitsuba, which the importer
// reads without any other files. The imported scene is encoded as a scene package, the form in
// which workers get scenes, and this package must be decodable. Any other input is a mesh file of a
// scene of Mitsuba.

#include <fstream>

#include "absl/strings/match.h"
#include "renderlib/base/check.h"
#include "renderlib/import/import.h"
#include "renderlib/import/mitsuba/source_mesh.h"
#include "renderlib/package/package.h"
#include "tests/fuzz/fuzz.h"
#include "tests/support/temp_dir.h"

namespace bandsaw {
namespace {

/// Reads a PLY, serialized or OBJ file. An accepted mesh must have valid indices and normals.
void read_mesh(absl::string_view bytes) {
  const auto mesh = absl::StartsWith(bytes, "ply") ? mitsuba::read_ply(bytes, /*flip_v=*/false)
                    : absl::StartsWith(bytes, "\x1c")
                        ? mitsuba::read_serialized(bytes, /*index=*/0, /*flip_v=*/true)
                        : mitsuba::read_obj(bytes, /*flip_v=*/true);
  if (!mesh.ok()) {
    return;
  }
  PlyMesh whole = mesh->mesh;
  for (const auto& triangle : whole.triangles) {
    for (const std::uint32_t index : triangle) {
      BANDSAW_CHECK(index < whole.positions.size(), "each index is that of a vertex");
    }
  }
  BANDSAW_CHECK(whole.normals.empty() || whole.normals.size() == whole.positions.size(),
                "either all vertices have a normal or none has one");
  mitsuba::orient_by_normals(whole);
  mitsuba::add_smooth_normals(whole);
  mitsuba::has_left_handed_uvs(whole);
}

}  // namespace
}  // namespace bandsaw

void bandsaw::fuzz::run(absl::Span<const std::uint8_t> input) {
  static const test::TempDir folder;
  const std::string bytes = text(input);
  if (!absl::StartsWith(bytes, "<")) {
    read_mesh(bytes);
    return;
  }
  const std::string path = folder / "scene.xml";
  std::ofstream(path, std::ios::binary) << bytes;
  const absl::StatusOr<ImportedScene> imported = import_scene(path);
  if (!imported.ok()) {
    return;
  }
  BlobMap blobs;
  const std::string manifest = encode_package(imported->scene, imported->info, blobs);
  const auto decoded = decode_package(manifest, blobs);
  BANDSAW_CHECK(decoded.ok(), decoded.status().ToString().c_str());
}
