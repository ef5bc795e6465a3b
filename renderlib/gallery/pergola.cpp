// Builds the glTF text of a pergola, a scene of the gallery. All parts are copies of one cube, and
// the cube's bytes are embedded as base64.

#include "renderlib/gallery/pergola.h"

#include <array>
#include <cstdint>
#include <cstring>
#include <vector>

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "renderlib/math/vec.h"

namespace bandsaw::gallery {
namespace {

enum Mesh : int { kStone, kWood, kWater };  // each is the same cube with its own material

/// Returns the cube [-1/2, 1/2]^3: 24 positions, 24 normals, 36 indices of 16 bits.
std::string cube_bytes() {
  std::vector<float> positions;
  std::vector<float> normals;
  std::vector<std::uint16_t> indices;
  for (int face = 0; face < 6; ++face) {
    const std::size_t axis = static_cast<std::size_t>(face) / 2;
    const float side = face % 2 == 0 ? 1 : -1;
    const auto first = static_cast<std::uint16_t>(4 * face);
    for (int corner = 0; corner < 4; ++corner) {
      // Counter-clockwise as seen from outside.
      const float u = corner == 1 || corner == 2 ? 0.5f : -0.5f;
      const float v = corner >= 2 ? 0.5f : -0.5f;
      std::array<float, 3> p{};
      p[axis] = side / 2;
      p[(axis + 1) % 3] = u * side;
      p[(axis + 2) % 3] = v;
      std::array<float, 3> n{};
      n[axis] = side;
      positions.insert(positions.end(), p.begin(), p.end());
      normals.insert(normals.end(), n.begin(), n.end());
    }
    for (const int i : {0, 1, 2, 0, 2, 3}) {
      indices.push_back(static_cast<std::uint16_t>(first + i));
    }
  }
  positions.insert(positions.end(), normals.begin(), normals.end());
  std::string bytes(positions.size() * sizeof(float) + indices.size() * 2, '\0');
  std::memcpy(bytes.data(), positions.data(), positions.size() * sizeof(float));
  std::memcpy(bytes.data() + positions.size() * sizeof(float), indices.data(), indices.size() * 2);
  return bytes;
}

std::string triple(const Vec3& v) { return absl::StrFormat("[%.6g, %.6g, %.6g]", v.x, v.y, v.z); }

/// Returns a node that places the cube at `centre`, scaled to `size`.
std::string block(Mesh mesh, const Vec3& centre, const Vec3& size) {
  return absl::StrFormat(R"({"mesh": %d, "translation": %s, "scale": %s})", mesh, triple(centre),
                         triple(size));
}

/// Returns a node with the camera of number `camera` at `from`. The node's -z axis, along which a
/// glTF camera looks (glTF 2.0, 5.12), points to `to`. The columns of the node's matrix are its
/// axes and `from`.
std::string camera_node(const char* name, int camera, const Vec3& from, const Vec3& to,
                        const Vec3& up) {
  const Vec3 z = normalize(from - to);
  const Vec3 x = normalize(cross(up, z));
  const Vec3 y = cross(z, x);
  const auto column = [](const Vec3& v, int last) {
    return absl::StrFormat("%.6g, %.6g, %.6g, %d", v.x, v.y, v.z, last);
  };
  return absl::StrFormat(R"({"name": "%s", "camera": %d, "matrix": [%s, %s, %s, %s]})", name,
                         camera, column(x, 0), column(y, 0), column(z, 0), column(from, 1));
}

/// Returns the nodes: ground, basin, pillars, beams, slats and the three cameras.
std::vector<std::string> nodes() {
  std::vector<std::string> nodes = {
      block(kStone, {0, -0.1, 0}, {15, 0.2, 9}), block(kStone, {0, 0.06, 0}, {7.6, 0.12, 2.2}),
      block(kWater, {0, 0.1, 0}, {7.2, 0.06, 1.8}), block(kStone, {-5.6, 0.45, 0}, {1, 0.9, 1})};
  for (const double z : {-1.8, 1.8}) {
    for (int i = -2; i <= 2; ++i) {
      nodes.push_back(block(kStone, {2.0 * i, 1.5, z}, {0.34, 3, 0.34}));
    }
    nodes.push_back(block(kWood, {0, 3.12, z}, {9.4, 0.24, 0.3}));
  }
  for (int i = -9; i <= 9; ++i) {
    nodes.push_back(block(kWood, {0.5 * i, 3.35, 0}, {0.12, 0.22, 4.8}));
  }
  nodes.push_back(camera_node("gate", 0, {7.2, 1.7, 0.9}, {-5, 1.25, -0.2}, {0, 1, 0}));
  nodes.push_back(camera_node("corner", 0, {6.5, 3.4, 6.5}, {-0.6, 1.1, 0}, {0, 1, 0}));
  nodes.push_back(camera_node("plan", 1, {0, 20, 0}, {0, 0, 0}, {0, 0, -1}));
  return nodes;
}

// The meshes in the order of Mesh. Their buffer views are the positions, the normals and the
// indices, in the order of cube_bytes().
constexpr char kCube[] = R"("meshes": [
  {"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2, "material": 0}]},
  {"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2, "material": 1}]},
  {"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2, "material": 2}]}],
"accessors": [
  {"bufferView": 0, "componentType": 5126, "count": 24, "type": "VEC3", "min": [-0.5, -0.5, -0.5], "max": [0.5, 0.5, 0.5]},
  {"bufferView": 1, "componentType": 5126, "count": 24, "type": "VEC3"},
  {"bufferView": 2, "componentType": 5123, "count": 36, "type": "SCALAR"}],
"bufferViews": [
  {"buffer": 0, "byteLength": 288}, {"buffer": 0, "byteOffset": 288, "byteLength": 288}, {"buffer": 0, "byteOffset": 576, "byteLength": 72}],
)";

// The cameras 0 and 1 that nodes() places, and the materials 0 to 2 that the meshes of kCube have.
constexpr char kCamerasAndMaterials[] = R"("cameras": [
  {"name": "walker", "type": "perspective", "perspective": {"yfov": 0.72, "znear": 0.1}},
  {"name": "map", "type": "orthographic", "orthographic": {"xmag": 7.8, "ymag": 5.2, "znear": 0.1, "zfar": 50}}],
"materials": [
  {"name": "stone", "pbrMetallicRoughness": {"baseColorFactor": [0.66, 0.6, 0.52, 1], "metallicFactor": 0, "roughnessFactor": 0.85}},
  {"name": "wood", "pbrMetallicRoughness": {"baseColorFactor": [0.36, 0.17, 0.07, 1], "metallicFactor": 0, "roughnessFactor": 0.6}},
  {"name": "water", "pbrMetallicRoughness": {"baseColorFactor": [0.01, 0.05, 0.06, 1], "metallicFactor": 0, "roughnessFactor": 0.06}}],
)";

}  // namespace

std::string pergola() {
  const std::string bytes = cube_bytes();
  const std::vector<std::string> all = nodes();
  std::vector<std::string> numbers;
  for (std::size_t i = 0; i < all.size(); ++i) {
    numbers.push_back(absl::StrCat(i));
  }
  return absl::StrCat(
      R"({"asset": {"version": "2.0", "generator": "bandsaw-gallery"},)", "\n\"nodes\": [\n  ",
      absl::StrJoin(all, ",\n  "), "],\n\"scenes\": [{\"nodes\": [", absl::StrJoin(numbers, ", "),
      "]}], \"scene\": 0,\n", kCamerasAndMaterials, kCube,
      "\"buffers\": [{\"byteLength\": ", bytes.size(),
      ", \"uri\": \"data:application/octet-stream;base64,", absl::Base64Escape(bytes), "\"}]}\n");
}

}  // namespace bandsaw::gallery
