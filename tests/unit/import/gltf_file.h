#pragma once

// A small glTF file that tests write as text: one triangle, to which they add materials, textures
// and further members. GltfWriter (gltf_writer.h) makes files from vectors of numbers.

#include <cstring>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "tests/unit/import/files.h"

namespace bandsaw::test {

/// Returns the bytes of floats, for the buffer of a glTF file.
inline std::string floats(const std::vector<float>& values) {
  std::string bytes(values.size() * sizeof(float), '\0');
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

/// One triangle (0,0,0), (1,0,0), (0,1,0) with two sets of uvs and material 0. If `colors` is set,
/// its vertex colours are (0.5,0,0), (0,0.5,0), (0,0,0.5). The buffer views 0 to 3 have the
/// positions, the uvs, the second uvs and the colours.
struct GltfTriangle {
  std::string materials = "{}";  ///< contents of the list
  std::string textures;          ///< contents of the list
  std::string images;            ///< contents of the list
  std::string samplers;          ///< contents of the list
  bool colors = false;           ///< the triangle has its vertex colours
  std::string primitives;        ///< further primitives of the mesh, each after a comma
  std::string more;              ///< further members of the file, each followed by a comma

  /// Writes the file, and its buffer t.bin beside it; returns its path.
  std::string write(const TempDir& folder, const std::string& name) const {
    write_text(folder, "t.bin",
               floats({0, 0, 0, 1, 0, 0, 0, 1, 0}) + floats({0, 0, 1, 0, 0, 1}) +
                   floats({0, 0, 0.5f, 0, 0, 0.5f}) + floats({0.5f, 0, 0, 0, 0.5f, 0, 0, 0, 0.5f}));
    const auto list = [](const char* what, const std::string& items) {
      return items.empty() ? "" : absl::StrCat("\"", what, "\": [", items, "],\n");
    };
    return write_text(
        folder, name,
        absl::StrCat("{\"asset\": {\"version\": \"2.0\"}, \"scene\": 0,\n", more,
                     list("textures", textures), list("images", images), list("samplers", samplers),
                     list("materials", materials), R"("scenes": [{"nodes": [0]}],
"nodes": [{"mesh": 0}],
"meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1, "TEXCOORD_1": 2)",
                     colors ? R"(, "COLOR_0": 3)" : "", R"(}, "material": 0})", primitives,
                     R"(]}],
"accessors": [
{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0,0,0], "max": [1,1,0]},
{"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2"},
{"bufferView": 2, "componentType": 5126, "count": 3, "type": "VEC2"},
{"bufferView": 3, "componentType": 5126, "count": 3, "type": "VEC3"}],
"bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 24},
{"buffer": 0, "byteOffset": 60, "byteLength": 24}, {"buffer": 0, "byteOffset": 84, "byteLength": 36}],
"buffers": [{"byteLength": 120, "uri": "t.bin"}]})"));
  }
};

}  // namespace bandsaw::test
