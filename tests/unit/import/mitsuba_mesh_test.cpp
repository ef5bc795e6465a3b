// Mesh files of Mitsuba scenes: OBJ, PLY and *.serialized. The last argument of the functions that
// read these files is `flip_v`: if it is true, v becomes 1 - v. The second argument of
// read_serialized() is the number of the mesh in the file, from 0.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <cstring>

#include "renderlib/import/mitsuba/source_mesh.h"

namespace bandsaw::mitsuba {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

using F2 = std::array<float, 2>;
using F3 = std::array<float, 3>;
using U3 = std::array<std::uint32_t, 3>;

template <class T>
std::string message(const absl::StatusOr<T>& result) {
  return std::string(result.status().message());
}

TEST(MitsubaObj, SharesCornersAndSplitsPolygons) {
  const auto mesh = read_obj(
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0.25\nvt 1 0\n# a square\nf 1/1 2/2 3/2 4/1\n",
      true);
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  EXPECT_THAT(mesh->mesh.triangles, ElementsAre(U3{0, 1, 2}, U3{0, 2, 3}));
  EXPECT_EQ(mesh->mesh.positions[2], (F3{1, 1, 0}));
  EXPECT_EQ(mesh->mesh.uvs[0], (F2{0, 0.75f}));
  EXPECT_TRUE(mesh->mesh.normals.empty());
  const auto backwards = read_obj("v 0 0 0\nv 1 0 0\nv 1 1 0\nf -3 -2 -1", true);
  ASSERT_TRUE(backwards.ok()) << backwards.status();
  EXPECT_THAT(backwards->mesh.triangles, ElementsAre(U3{0, 1, 2}));
}

TEST(MitsubaObj, NamesTheLineOfAnError) {
  EXPECT_EQ(message(read_obj("v 0 0\n", true)), "line 1: needs 3 numbers");
  EXPECT_THAT(message(read_obj("v 0 0 nan\n", true)), HasSubstr("is not a finite number"));
  EXPECT_EQ(message(read_obj("v 0 0 0\nf 1 2 1\n", true)),
            "line 2: index 2 is out of range: the number of entries is 1");
  EXPECT_EQ(message(read_obj("v 0 0 0\nf 1 0 1\n", true)),
            "line 2: index 0 is out of range: the number of entries is 1");
  EXPECT_EQ(message(read_obj("v 0 0 0\n", true)), "has no faces");
}

TEST(MitsubaPly, ReadsAttributesOfVerticesAndFaces) {
  const auto mesh = read_ply(
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
      "property float z\nproperty float u\nproperty float v\nproperty float heat_0\n"
      "element face 1\nproperty list uchar int vertex_indices\nproperty float color_0\n"
      "property float color_1\nproperty float color_2\nend_header\n"
      "0 0 0 0 0 5\n1 0 0 1 0 6\n1 1 0 1 1 7\n0 1 0 0 1 8\n4 0 1 2 3 0.1 0.2 0.3",
      false);
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  EXPECT_EQ(mesh->mesh.triangles.size(), 2u);
  ASSERT_EQ(mesh->attributes.size(), 2u);
  EXPECT_EQ(mesh->attributes[0].name, "vertex_heat");
  EXPECT_THAT(mesh->attributes[0].values, ElementsAre(5, 6, 7, 8));
  EXPECT_EQ(mesh->attributes[1].name, "face_color");
  EXPECT_THAT(mesh->attributes[1].values, ElementsAre(0.1f, 0.2f, 0.3f, 0.1f, 0.2f, 0.3f))
      << "each triangle of the polygon must have the values of the face";
}

TEST(MitsubaPly, ReadsBothByteOrders) {
  for (const bool big : {false, true}) {
    std::string text = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                       "_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                       "property float z\nelement face 1\n"
                       "property list uchar int vertex_indices\nend_header\n";
    const auto add = [&](auto value) {
      std::array<char, sizeof(value)> bytes;
      std::memcpy(bytes.data(), &value, sizeof(value));
      text +=
          big ? std::string(bytes.rbegin(), bytes.rend()) : std::string(bytes.begin(), bytes.end());
    };
    for (const float x : {0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 2.0f, 0.0f}) {
      add(x);
    }
    text += '\3';
    for (const std::int32_t i : {0, 1, 2}) {
      add(i);
    }
    const auto mesh = read_ply(text, false);
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    EXPECT_EQ(mesh->mesh.positions[2], (F3{0, 2, 0}));
    EXPECT_THAT(message(read_ply(text.substr(0, text.size() - 1), false)), HasSubstr("is damaged"));
  }
}

TEST(MitsubaPly, CountsAreCheckedBeforeMemoryIsAllocated) {
  EXPECT_THAT(message(read_ply("ply\nformat binary_little_endian 1.0\n"
                               "element vertex 1000000000000\nproperty float x\nend_header\n",
                               false)),
              HasSubstr("it says that it has 1000000000000 of \"vertex\""));
  EXPECT_THAT(message(read_ply("ply\nformat ascii 1.0\n", false)), HasSubstr("no end"));
  EXPECT_THAT(message(read_ply("solid", false)), HasSubstr("is not a PLY file"));
}

/// Returns a *.serialized file of one triangle. `vertices`: the number of vertices that the header
/// claims; `last_index`: the third vertex of the triangle; `flags`: 0x1000 means single precision.
std::string serialized(std::uint64_t vertices, std::uint32_t last_index = 2,
                       std::uint32_t flags = 0x1000) {
  std::string inside;
  const auto add = [&](auto value) {
    inside.append(reinterpret_cast<const char*>(&value), sizeof(value));
  };
  add(flags);
  inside += std::string("name") + '\0';
  add(vertices);
  add(std::uint64_t{1});
  for (const float x : {0.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 2.0f, 0.0f}) {
    add(x);
  }
  add(std::uint32_t{0});
  add(std::uint32_t{1});
  add(last_index);
  std::string packed(compressBound(inside.size()), '\0');
  uLongf size = packed.size();
  EXPECT_EQ(compress(reinterpret_cast<Bytef*>(packed.data()), &size,
                     reinterpret_cast<const Bytef*>(inside.data()), inside.size()),
            Z_OK);
  packed.resize(size);
  std::string file = std::string("\x1c\x04\x04", 3) + '\0' + packed;
  const std::uint64_t offset = 0;
  const std::uint32_t count = 1;
  file.append(reinterpret_cast<const char*>(&offset), 8);
  file.append(reinterpret_cast<const char*>(&count), 4);
  return file;
}

TEST(MitsubaSerialized, ReadsAMesh) {
  const auto mesh = read_serialized(serialized(3), 0, false);
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  EXPECT_EQ(mesh->mesh.positions[2], (F3{0, 2, 0}));
  EXPECT_THAT(mesh->mesh.triangles, ElementsAre(U3{0, 1, 2}));
}

TEST(MitsubaSerialized, DamageIsNamed) {
  EXPECT_THAT(message(read_serialized(serialized(300'000'000), 0, false)),
              HasSubstr("its compressed data end too early"));
  EXPECT_THAT(message(read_serialized(serialized(std::uint64_t{10} << 30), 0, false)),
              HasSubstr("is too large: a mesh may have 4 GB"));
  EXPECT_THAT(message(read_serialized(serialized(~std::uint64_t{0}), 0, false)),
              HasSubstr("is too large"));
  EXPECT_THAT(message(read_serialized(serialized(3, 3), 0, false)),
              HasSubstr("a triangle refers to vertex 3; the number of vertices is 3"));
  EXPECT_THAT(message(read_serialized(serialized(3), 1, false)), HasSubstr("has no mesh 1"));
  EXPECT_THAT(message(read_serialized("\x1c\x04", 0, false)), HasSubstr("ends too early"));
  EXPECT_THAT(message(read_serialized("OBJ file", 0, false)), HasSubstr("is not a *.serialized"));
  const std::string whole = serialized(3);
  // Mesh 0 may be readable without the last 18 bytes, which are the end of the compressed data,
  // their checksum and the table of meshes.
  for (std::size_t size = 0; size + 18 < whole.size(); ++size) {
    EXPECT_FALSE(read_serialized(whole.substr(0, size), 0, false).ok()) << size;
  }
}

TEST(MitsubaMesh, NormalsAreWeightedByAngles) {
  // Vertex 0 is the corner of a cube, where three faces meet at right angles. The normal must not
  // depend on the number of triangles of a face, which is 2 for one of the faces.
  PlyMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}};
  mesh.triangles = {{0, 4, 1}, {0, 2, 4}, {0, 3, 2}, {0, 1, 3}};
  add_smooth_normals(mesh);
  const float each = static_cast<float>(-std::sqrt(1.0 / 3));
  for (const float component : mesh.normals[0]) {
    EXPECT_NEAR(component, each, 1e-6);
  }
}

TEST(MitsubaMesh, TrianglesAreOrientedByTheirNormals) {
  PlyMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.normals.assign(3, {0, 0, -1});
  mesh.uvs = {{0, 0}, {1, 0}, {0, 1}};
  mesh.triangles = {{0, 1, 2}};
  EXPECT_FALSE(has_left_handed_uvs(mesh));
  orient_by_normals(mesh);
  EXPECT_THAT(mesh.triangles, ElementsAre(U3{0, 2, 1}));
  EXPECT_TRUE(has_left_handed_uvs(mesh));
  turn_over(mesh);
  EXPECT_EQ(mesh.normals[0], (F3{0, 0, 1}));
}

}  // namespace
}  // namespace bandsaw::mitsuba
