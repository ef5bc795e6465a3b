#pragma once

// GltfWriter makes glTF files from vectors of numbers, for tests of the import. Tests may change
// the JSON before it is written, also to damage it.

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <type_traits>
#include <vector>

#include "renderlib/import/import.h"
#include "tests/unit/import/files.h"

namespace bandsaw::test {

using Json = nlohmann::json;

/// Returns the number by which glTF names the type.
template <class T>
int component_type() {
  return std::is_same_v<T, float>           ? 5126
         : std::is_same_v<T, std::int8_t>   ? 5120
         : std::is_same_v<T, std::uint8_t>  ? 5121
         : std::is_same_v<T, std::int16_t>  ? 5122
         : std::is_same_v<T, std::uint16_t> ? 5123
                                            : 5125;
}

template <class T>
std::string bytes_of(const std::vector<T>& values) {
  std::string bytes(values.size() * sizeof(T), '\0');
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

/// A glTF file with one mesh of one primitive at one node. Tests add everything else.
class GltfWriter {
 public:
  GltfWriter() {
    root = Json::parse(R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
      "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {}}]}],
      "accessors": [], "bufferViews": []})");
  }

  Json& primitive() { return root["meshes"][0]["primitives"][0]; }
  Json& attributes() { return primitive()["attributes"]; }

  /// Gives the first mesh one triangle, (0, 0, 0), (1, 0, 0), (0, 1, 0), which follows joint 0.
  void add_skinned_triangle() {
    attributes() = {{"POSITION", add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, 3)},
                    {"JOINTS_0", add<std::uint8_t>({0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, 4)},
                    {"WEIGHTS_0", add<float>({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, 4)}};
  }

  /// Adds bytes to the buffer, with a buffer view of them; returns the index of the view.
  std::size_t view(const std::string& part) {
    bytes.resize((bytes.size() + 3) / 4 * 4);
    root["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", part.size()}});
    bytes += part;
    return root["bufferViews"].size() - 1;
  }
  /// Adds an accessor; returns its index.
  std::size_t accessor(const Json& members) {
    root["accessors"].push_back(members);
    return root["accessors"].size() - 1;
  }
  /// Adds the values as a new view with an accessor. Returns the index of the accessor. Each row of
  /// `values` has `components` numbers, and then `padding` numbers that are not read. Padding is
  /// needed because glTF requires that the size of a row of an attribute is a multiple of 4 bytes.
  template <class T>
  std::size_t add(const std::vector<T>& values, int components, bool normalized = false,
                  int padding = 0) {
    static constexpr const char* kTypes[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
    const std::size_t at = view(bytes_of(values));
    const auto row = static_cast<std::size_t>(components + padding);
    if (padding > 0) {
      root["bufferViews"][at]["byteStride"] = row * sizeof(T);
    }
    Json members = {{"bufferView", at},
                    {"componentType", component_type<T>()},
                    {"type", components == 16 ? "MAT4" : kTypes[components]},
                    {"count", values.size() / row}};
    if (normalized) {
      members["normalized"] = true;
    }
    return accessor(members);
  }

  /// Writes the file, and its buffer as a file beside it; returns its path.
  std::string write(const TempDir& folder, const std::string& name) {
    write_text(folder, name + ".bin", bytes);
    Json whole = root;
    if (!whole.contains("buffers")) {
      whole["buffers"] = Json::array({{{"uri", name + ".bin"}, {"byteLength", bytes.size()}}});
    }
    return write_text(folder, name, whole.dump());
  }

  /// Returns the bytes of the file as a .glb.
  std::string glb() const {
    Json whole = root;
    whole["buffers"] = Json::array({{{"byteLength", bytes.size()}}});
    std::string json = whole.dump();
    json.resize((json.size() + 3) / 4 * 4, ' ');
    std::string binary = bytes;
    binary.resize((binary.size() + 3) / 4 * 4);
    const auto number = [](std::size_t v) {
      return bytes_of<std::uint32_t>({static_cast<std::uint32_t>(v)});
    };
    // 28: the header of the file has 12 bytes, and the headers of the two chunks have 8 bytes each.
    return "glTF" + number(2) + number(28 + json.size() + binary.size()) + number(json.size()) +
           "JSON" + json + number(binary.size()) + std::string("BIN\0", 4) + binary;
  }

  /// Writes the file and imports it.
  absl::StatusOr<ImportedScene> import(const TempDir& folder, const std::string& name = "m.gltf") {
    return import_scene(write(folder, name));
  }

  Json root;          ///< the JSON of the file
  std::string bytes;  ///< the buffer of the file
};

/// A square of 2 n^2 triangles over [0, 1]^2 that is bent to a wave, as input for encoders.
struct WavySquare {
  explicit WavySquare(int n = 12) {
    for (int y = 0; y <= n; ++y) {
      for (int x = 0; x <= n; ++x) {
        const float u = static_cast<float>(x) / static_cast<float>(n);
        const float v = static_cast<float>(y) / static_cast<float>(n);
        const float slope = 0.5f - u;
        const float length = std::sqrt(slope * slope + 1);
        positions.insert(positions.end(), {u, v, 0.5f * u * (1 - u)});
        normals.insert(normals.end(), {-slope / length, 0, 1 / length});
        uvs.insert(uvs.end(), {u, 1 - v});
      }
    }
    const auto at = [&](int x, int y) { return static_cast<std::uint32_t>(y * (n + 1) + x); };
    for (int y = 0; y < n; ++y) {
      for (int x = 0; x < n; ++x) {
        indices.insert(indices.end(), {at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y),
                                       at(x + 1, y + 1), at(x, y + 1)});
      }
    }
  }
  std::size_t vertices() const { return positions.size() / 3; }

  /// Returns a file of the square, uncompressed: floats and 32-bit indices.
  GltfWriter plain() const {
    GltfWriter file;
    file.attributes() = {{"POSITION", file.add(positions, 3)},
                         {"NORMAL", file.add(normals, 3)},
                         {"TEXCOORD_0", file.add(uvs, 2)}};
    file.primitive()["indices"] = file.add(indices, 1);
    return file;
  }

  std::vector<float> positions;
  std::vector<float> normals;
  std::vector<float> uvs;
  std::vector<std::uint32_t> indices;
};

/// Returns the numbers of all values of an attribute, such as the positions, in one list.
template <class T, std::size_t n>
std::vector<T> flat(const std::vector<std::array<T, n>>& values) {
  std::vector<T> out;
  for (const auto& value : values) {
    out.insert(out.end(), value.begin(), value.end());
  }
  return out;
}

}  // namespace bandsaw::test
