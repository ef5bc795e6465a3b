// Meshes in the encodings of EXT_meshopt_compression and KHR_draco_mesh_compression, made by the
// libraries' own encoders, compared with the uncompressed meshes.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "renderlib/import/gltf/meshopt_filters.h"
#include "tests/support/random.h"
#include "tests/unit/import/compressed_gltf.h"
#include "tests/unit/import/layer.h"

namespace bandsaw {
namespace {

using test::add_attribute;
using test::draco_stream;
using test::GltfWriter;
using test::Json;
using test::kFloats3;
using test::TempDir;
using test::WavySquare;
using test::with_draco;
using test::with_meshopt;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Imports the file, and expects no error and no warning.
ImportedScene read(GltfWriter file, const TempDir& folder) {
  auto imported = file.import(folder);
  EXPECT_TRUE(imported.ok()) << imported.status();
  if (imported.ok()) {
    EXPECT_THAT(imported->info.warnings, IsEmpty());
  }
  return imported.ok() ? *std::move(imported) : ImportedScene();
}

const Mesh& mesh_of(const ImportedScene& imported) { return imported.scene.geometry.meshes.at(0); }

// --- meshopt

/// Returns the triangles, each rotated so that its lowest index comes first, because encoders may
/// rotate them.
std::vector<std::array<std::uint32_t, 3>> turned(std::vector<std::array<std::uint32_t, 3>> all) {
  for (auto& triangle : all) {
    std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()),
                triangle.end());
  }
  return all;
}

TEST(Meshopt, BufferViewsRoundTrip) {
  const TempDir folder;
  const WavySquare square;
  const Mesh plain = mesh_of(read(square.plain(), folder));
  for (const bool as_sequence : {false, true}) {
    for (const std::size_t index_size : {2u, 4u}) {
      const Mesh mesh = mesh_of(read(with_meshopt(square, as_sequence, index_size), folder));
      EXPECT_EQ(mesh.positions, plain.positions);
      EXPECT_EQ(mesh.normals, plain.normals);
      EXPECT_EQ(mesh.uvs, plain.uvs);
      EXPECT_EQ(turned(mesh.triangles), turned(plain.triangles));
    }
  }
}

/// Returns the normal layer of the scene as seen by an orthographic camera.
std::vector<Rgb> seen(const ImportedScene& imported) {
  ImportedScene scene = imported;
  scene.scene.camera =
      OrthographicCamera{.position = {0.5, 0.5, 9}, .look_at = {0.5, 0.5, 0}, .height = 1.2};
  return test::layer(scene, 40, 40, Integrator::kNormals).pixels;
}

TEST(Meshopt, ALosslessEncodingIsRenderedToTheSameBits) {
  const TempDir folder;
  const WavySquare square;
  EXPECT_EQ(seen(read(with_meshopt(square, true, 2), folder)), seen(read(square.plain(), folder)));
}

/// Encodes numbers for meshopt's exponential filter: each becomes an exponent of 8 bits above a
/// signed mantissa of `bits` bits. This replaces the library's encoder, which takes other arguments
/// in each of its versions.
std::string exponential(const std::vector<float>& values, int bits) {
  std::vector<std::uint32_t> codes;
  for (const float value : values) {
    int exponent = 0;
    const double fraction = std::frexp(static_cast<double>(value), &exponent);
    const auto mantissa = static_cast<std::int32_t>(std::lround(std::ldexp(fraction, bits - 2)));
    codes.push_back(static_cast<std::uint32_t>(exponent - (bits - 2)) << 24 |
                    (static_cast<std::uint32_t>(mantissa) & 0xffffffu));
  }
  return test::bytes_of(codes);
}

/// Returns vectors of three numbers with `value` as the fourth.
std::vector<float> fourth(const std::vector<float>& from, float value) {
  std::vector<float> to;
  for (std::size_t i = 0; i < from.size(); i += 3) {
    to.insert(to.end(), {from[i], from[i + 1], from[i + 2], value});
  }
  return to;
}

/// Returns the number of the square's vertex that is nearest in x and y; vertices are 1/12 apart.
std::size_t vertex_at(const WavySquare& square, const std::array<float, 3>& position) {
  std::size_t nearest = 0;
  float least = 9;
  for (std::size_t i = 0; i < square.vertices(); ++i) {
    const float distance = std::hypot(square.positions[3 * i] - position[0],
                                      square.positions[3 * i + 1] - position[1]);
    if (distance < least) {
      least = distance;
      nearest = i;
    }
  }
  return nearest;
}

TEST(Meshopt, FilteredNormalsAndPositionsAreWithinTheirPrecision) {
  const TempDir folder;
  const WavySquare square;
  const std::size_t count = square.vertices();
  for (const bool wide : {false, true}) {
    GltfWriter file = with_meshopt(square, false, 2);
    const std::size_t stride = wide ? 8 : 4;
    std::string normals(count * stride, '\0');
    meshopt_encodeFilterOct(normals.data(), count, stride, wide ? 16 : 8,
                            fourth(square.normals, 0).data());
    file.attributes()["NORMAL"] = add_attribute(
        file, normals, stride,
        {{"componentType", wide ? 5122 : 5120}, {"type", "VEC3"}, {"normalized", true}},
        "OCTAHEDRAL");
    file.attributes()["POSITION"] =
        add_attribute(file, exponential(square.positions, 15), 12, kFloats3, "EXPONENTIAL");
    file.root["buffers"][0]["byteLength"] = file.bytes.size();
    const Mesh mesh = mesh_of(read(file, folder));
    // A change of one step in the octahedral map moves a unit vector by at most 2 steps. One more
    // step is allowed for the rounding of the decoded values.
    const double step = 3.0 / (wide ? 32767 : 127);
    // Assimp 5.4, by which the file is read, renumbers vertices in the order in which triangles use
    // them. So the vertex of the square is found by its position.
    std::set<std::size_t> found;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
      const std::size_t vertex = vertex_at(square, mesh.positions[i]);
      found.insert(vertex);
      for (std::size_t c = 0; c < 3; ++c) {
        ASSERT_NEAR(mesh.normals[i][c], square.normals[3 * vertex + c], step);
        // The mantissa of 15 bits includes a sign, and the numbers are up to 1.
        ASSERT_NEAR(mesh.positions[i][c], square.positions[3 * vertex + c], 1.0 / (1 << 13));
      }
    }
    ASSERT_EQ(mesh.positions.size(), count);
    ASSERT_EQ(found.size(), count);
  }
}

// The decoders in meshopt_filters.h differ from the library's decoders by at most one unit.
TEST(Meshopt, FiltersDecodeLikeTheLibraryWithinOneUnit) {
  test::Random random(3);
  std::vector<float> unit;
  for (int i = 0; i < 4000; ++i) {
    const double x = random.uniform() - 0.5;
    const double y = random.uniform() - 0.5;
    const double z = random.uniform() - 0.5;
    const double w = random.uniform() - 0.5;
    const double length = std::sqrt(x * x + y * y + z * z + w * w);
    for (const double v : {x, y, z, w}) {
      unit.push_back(static_cast<float>(v / length));
    }
  }
  const std::size_t count = unit.size() / 4;
  // Expects that the 16-bit numbers of two buffers differ by at most 1.
  const auto near_16 = [](const std::string& a, const std::string& b) {
    for (std::size_t at = 0; at < a.size(); at += 2) {
      std::int16_t x = 0;
      std::int16_t y = 0;
      std::memcpy(&x, a.data() + at, 2);
      std::memcpy(&y, b.data() + at, 2);
      ASSERT_LE(std::abs(x - y), 1) << at;
    }
  };
  std::string ours(count * 8, '\0');
  meshopt_encodeFilterQuat(ours.data(), count, 8, 16, unit.data());
  std::string theirs = ours;
  gltf::decode_quaternions(ours);
  meshopt_decodeFilterQuat(theirs.data(), count, 8);
  near_16(ours, theirs);
  meshopt_encodeFilterOct(ours.data(), count, 8, 12, unit.data());
  theirs = ours;
  gltf::decode_octahedral(ours, 8);
  meshopt_decodeFilterOct(theirs.data(), count, 8);
  near_16(ours, theirs);
  ours.resize(count * 4);
  meshopt_encodeFilterOct(ours.data(), count, 4, 8, unit.data());
  theirs = ours;
  gltf::decode_octahedral(ours, 4);
  meshopt_decodeFilterOct(theirs.data(), count, 4);
  for (std::size_t at = 0; at < ours.size(); ++at) {
    ASSERT_LE(std::abs(static_cast<signed char>(ours[at]) - static_cast<signed char>(theirs[at])),
              1);
  }
  ours = exponential(unit, 20);
  theirs = ours;
  gltf::decode_exponential(ours);
  meshopt_decodeFilterExp(theirs.data(), count, 16);
  EXPECT_EQ(ours, theirs);
}

TEST(Meshopt, TheErrorOfADamagedViewNamesTheFault) {
  const TempDir folder;
  const GltfWriter sound = with_meshopt(WavySquare(), false, 2);
  const auto message = [&](const char* member, const Json& value, std::size_t view = 0) {
    GltfWriter file = sound;
    file.root["bufferViews"][view]["extensions"]["EXT_meshopt_compression"][member] = value;
    return std::string(file.import(folder).status().message());
  };
  const std::string place = "m.gltf: cannot be read: bufferViews[0].EXT_meshopt_compression";
  // View 0 has the positions: 169 vertices of 12 bytes, 2028 bytes. View 3 has the indices.
  EXPECT_THAT(message("mode", "OTHER"), HasSubstr(place + ": mode is \"OTHER\""));
  EXPECT_THAT(message("filter", "COLOR"), HasSubstr(place + ": filter is \"COLOR\""));
  EXPECT_THAT(message("filter", "QUATERNION"), HasSubstr("does not go with this mode"));
  EXPECT_THAT(message("count", 168), HasSubstr("do not make up the 2028 bytes"));
  EXPECT_THAT(message("count", 1ull << 52), HasSubstr("do not make up"));
  EXPECT_THAT(message("byteStride", 13), HasSubstr(place + ": byteStride is 13"));
  EXPECT_THAT(message("byteLength", 1), HasSubstr("cannot be decoded"));
  EXPECT_THAT(message("byteLength", 0), HasSubstr("not one of EXT_meshopt_compression"));
  EXPECT_THAT(message("byteLength", 1u << 30), HasSubstr("ends at byte"));
  EXPECT_THAT(message("byteOffset", 1), HasSubstr("not one of EXT_meshopt_compression"));
  EXPECT_THAT(message("buffer", 1), HasSubstr("buffers[1]: has no uri"));
  EXPECT_THAT(message("mode", "INDICES", 3), HasSubstr("not one of EXT_meshopt_compression"));
}

// --- Draco

TEST(Draco, UnquantisedValuesAreTheSameToTheBit) {
  const TempDir folder;
  const WavySquare square;
  const ImportedScene plain = read(square.plain(), folder);
  const ImportedScene imported = read(with_draco(square, 0, false), folder);
  EXPECT_EQ(mesh_of(imported).positions, mesh_of(plain).positions);
  EXPECT_EQ(mesh_of(imported).normals, mesh_of(plain).normals);
  EXPECT_EQ(mesh_of(imported).uvs, mesh_of(plain).uvs);
  EXPECT_EQ(mesh_of(imported).triangles, mesh_of(plain).triangles);
  EXPECT_EQ(seen(imported), seen(plain));
}

struct Vertex {
  std::array<float, 2> uv;
  std::array<float, 3> position;
  std::array<float, 3> normal;
};
/// Returns the vertices of a square of n x n cells, sorted by their uvs, because the encoding
/// "edgebreaker" renumbers vertices.
std::vector<Vertex> sorted_vertices(const Mesh& mesh, int n) {
  std::vector<Vertex> all;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    all.push_back({mesh.uvs.at(i), mesh.positions[i], mesh.normals.at(i)});
  }
  const auto key = [&](const Vertex& v) {
    return std::lround(v.uv[1] * n) * 1000 + std::lround(v.uv[0] * n);
  };
  std::sort(all.begin(), all.end(),
            [&](const Vertex& a, const Vertex& b) { return key(a) < key(b); });
  return all;
}

TEST(Draco, QuantisedMeshesAreWithinTheirPrecision) {
  const TempDir folder;
  constexpr int kSide = 12;
  const WavySquare square(kSide);
  const Mesh plain = mesh_of(read(square.plain(), folder));
  const auto expected = sorted_vertices(plain, kSide);
  for (const bool edgebreaker : {false, true}) {
    for (const int bits : {10, 14}) {
      const Mesh mesh = mesh_of(read(with_draco(square, bits, edgebreaker), folder));
      ASSERT_EQ(mesh.triangles.size(), plain.triangles.size());
      const auto found = sorted_vertices(mesh, kSide);
      ASSERT_EQ(found.size(), expected.size());
      // Positions and uvs may be off by half a step of the largest extent, which is 1. Normals may
      // be off by one step of the octahedral map, whose extent is 2.
      const double step = 0.51 / ((1 << bits) - 1);
      for (std::size_t i = 0; i < found.size(); ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
          ASSERT_NEAR(found[i].position[c], expected[i].position[c], step);
          ASSERT_NEAR(found[i].normal[c], expected[i].normal[c], 4.0 / (1 << bits));
          ASSERT_NEAR(found[i].uv[c % 2], expected[i].uv[c % 2], step);
        }
      }
    }
  }
}

TEST(Draco, AQuantisedMeshIsRenderedWithinItsBound) {
  const TempDir folder;
  const WavySquare square;
  const auto plain = seen(read(square.plain(), folder));
  const auto quantised = seen(read(with_draco(square, 14, true), folder));
  ASSERT_EQ(plain.size(), quantised.size());
  // The normals of vertices are off by at most 4 / 2^14. A hit may move by 1 / 2^14 of the square.
  // The normals of neighbouring vertices, which are 1/12 apart, differ by less than 1/12, so this
  // changes the normal n by less than 1 / 2^14. The layer shows 0.5 + 0.5 n, so it is off by less
  // than 2.5 / 2^14.
  for (std::size_t i = 0; i < plain.size(); ++i) {
    EXPECT_NEAR(plain[i].r, quantised[i].r, 4.0 / (1 << 14)) << i;
    EXPECT_NEAR(plain[i].g, quantised[i].g, 4.0 / (1 << 14)) << i;
    EXPECT_NEAR(plain[i].b, quantised[i].b, 4.0 / (1 << 14)) << i;
  }
}

TEST(Draco, TheErrorOfADamagedStreamNamesTheFault) {
  const TempDir folder;
  const WavySquare square;
  const std::string stream = draco_stream(square, 12, true);
  const auto message = [&](GltfWriter file) {
    return std::string(file.import(folder).status().message());
  };
  const std::string place = "m.gltf: cannot be read: meshes[0].primitives[0]";
  for (std::size_t size = 0; size + 1 < stream.size(); size += 1 + size / 4) {
    EXPECT_THAT(message(with_draco(stream.substr(0, size), square.vertices(), 3)),
                HasSubstr(place + ": its Draco stream cannot be decoded"))
        << size;
  }
  EXPECT_THAT(message(with_draco(stream, square.vertices() + 1, 3)),
              HasSubstr("count is 170, but its Draco stream has 169 vertices"));
  GltfWriter wrong = with_draco(stream, square.vertices(), 3);
  wrong.primitive()["extensions"]["KHR_draco_mesh_compression"]["attributes"]["NORMAL"] = 7;
  EXPECT_THAT(message(wrong), HasSubstr(place + ": its Draco stream has no attribute 7"));
  wrong.primitive()["extensions"]["KHR_draco_mesh_compression"]["attributes"]["NORMAL"] = 2;
  EXPECT_THAT(message(wrong),
              HasSubstr("has 3 components, but attribute 2 of its Draco stream has 2"));
  wrong.primitive()["extensions"]["KHR_draco_mesh_compression"]["bufferView"] = 5;
  EXPECT_THAT(message(wrong), HasSubstr("bufferViews[5] does not exist"));
}

}  // namespace
}  // namespace bandsaw
