// Attributes of every type that glTF 2.0 and KHR_mesh_quantization allow are converted to the
// numbers that they represent, and a damaged file gives one clear error. The arguments of
// GltfWriter::add() are the values, how many numbers an element has, whether integers are
// normalised, and how many unused numbers follow each element.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "tests/unit/import/gltf_writer.h"

namespace bandsaw {
namespace {

using test::flat;
using test::GltfWriter;
using test::Json;
using test::TempDir;
using test::WavySquare;
using test::write_text;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const std::vector<float> kTriangle{0, 0, 0, 1, 0, 0, 0, 1, 0};

class GltfAccessors : public ::testing::Test {
 protected:
  ImportedScene read(GltfWriter& file) {
    auto imported = file.import(folder_);
    EXPECT_TRUE(imported.ok()) << imported.status();
    return imported.ok() ? *std::move(imported) : ImportedScene();
  }
  /// Returns the only mesh of the file. Expects no warning.
  Mesh mesh(GltfWriter& file) {
    const ImportedScene imported = read(file);
    EXPECT_THAT(imported.info.warnings, IsEmpty());
    return imported.scene.geometry.meshes.empty() ? Mesh{} : imported.scene.geometry.meshes[0];
  }
  TempDir folder_;
};

// Types that glTF 2.0 allows without any extension.
TEST_F(GltfAccessors, UvsAndColoursMayBeNormalisedBytesAndShorts) {
  GltfWriter bytes;
  bytes.attributes() = {
      {"POSITION", bytes.add(kTriangle, 3)},
      {"TEXCOORD_0",
       bytes.add<std::uint8_t>({0, 255, 0, 0, 51, 102, 0, 0, 255, 0, 0, 0}, 2, true, 2)},
      {"COLOR_0",
       bytes.add<std::uint8_t>({0, 51, 255, 0, 0, 0, 0, 0, 255, 255, 255, 0}, 3, true, 1)}};
  const Mesh small = mesh(bytes);
  // In a Mesh, v = 0 is the bottom of the image. In glTF, v = 0 is the top.
  EXPECT_THAT(small.uvs,
              ElementsAre(ElementsAre(0, 0), ElementsAre(0.2f, 1 - 0.4f), ElementsAre(1, 1)));
  EXPECT_THAT(small.colors,
              ElementsAre(ElementsAre(0, 0.2f, 1), ElementsAre(0, 0, 0), ElementsAre(1, 1, 1)));
  GltfWriter shorts;
  shorts.attributes() = {
      {"POSITION", shorts.add(kTriangle, 3)},
      {"TEXCOORD_0", shorts.add<std::uint16_t>({0, 65535, 13107, 26214, 65535, 0}, 2, true)},
      {"COLOR_0",
       shorts.add<std::uint16_t>(
           {0, 13107, 65535, 65535, 0, 0, 0, 65535, 65535, 65535, 65535, 65535}, 4, true)}};
  const Mesh large = mesh(shorts);
  EXPECT_EQ(large.uvs, small.uvs);
  EXPECT_EQ(large.colors, small.colors);
}

template <class T>
class Quantised : public GltfAccessors {};
using Types = ::testing::Types<std::int8_t, std::uint8_t, std::int16_t, std::uint16_t>;
TYPED_TEST_SUITE(Quantised, Types);

// KHR_mesh_quantization: integers are used unchanged, or divided by their largest value if they are
// normalised.
TYPED_TEST(Quantised, PositionsAndUvsAreTheirIntegers) {
  using T = TypeParam;
  const T most = std::numeric_limits<T>::max();
  const T least = std::numeric_limits<T>::min();
  const std::vector<T> positions{0, 0, 0, 0, most, 0, 7, 0, 0, most, least, 0};
  for (const bool normalized : {false, true}) {
    GltfWriter file;
    file.attributes() = {{"POSITION", file.add(positions, 3, normalized, 1)},
                         {"TEXCOORD_0", file.add(positions, 2, normalized, 2)}};
    file.root["extensionsUsed"] = {"KHR_mesh_quantization"};
    file.root["extensionsRequired"] = {"KHR_mesh_quantization"};
    const Mesh read = this->mesh(file);
    // `one` is the integer that means 1. `lowest` is the number that the least integer means.
    const float one = normalized ? static_cast<float>(most) : 1;
    const float lowest = normalized && least != 0 ? -1 : static_cast<float>(least);
    EXPECT_THAT(
        read.positions,
        ElementsAre(ElementsAre(0, 0, 0), ElementsAre(static_cast<float>(most) / one, 0, 7 / one),
                    ElementsAre(0, static_cast<float>(most) / one, lowest)));
    EXPECT_FLOAT_EQ(read.uvs[1][0], static_cast<float>(most) / one);
    EXPECT_FLOAT_EQ(read.uvs[2][1], 1 - static_cast<float>(most) / one);
  }
}

TEST_F(GltfAccessors, NormalsMayBeQuantised) {
  GltfWriter file;
  file.attributes() = {
      {"POSITION", file.add(kTriangle, 3)},
      {"NORMAL", file.add<std::int8_t>({0, 0, 127, 0, 0, 127, 0, 0, -128, 0, 0, 0}, 3, true, 1)}};
  EXPECT_THAT(mesh(file).normals,
              ElementsAre(ElementsAre(0, 0, 1), ElementsAre(0, 1, 0), ElementsAre(-1, 0, 0)));
}

// The coordinates of the 33 x 17 vertices can be represented in 8 bits without an error, so the
// quantised file must give the same mesh as the plain one.
TEST_F(GltfAccessors, AnExactQuantisationChangesNoBit) {
  GltfWriter plain;
  GltfWriter quantised;
  std::vector<float> floats;
  std::vector<std::uint8_t> bytes;
  for (int y = 0; y <= 16; ++y) {
    for (int x = 0; x <= 32; ++x) {
      floats.insert(floats.end(), {float(x), float(y), float(x * y % 7)});
      bytes.insert(bytes.end(), {std::uint8_t(x), std::uint8_t(y), std::uint8_t(x * y % 7), 0});
    }
  }
  std::vector<std::uint16_t> indices;
  for (std::uint16_t i = 0; i + 34 < 33 * 17; ++i) {
    indices.insert(indices.end(), {i, std::uint16_t(i + 1), std::uint16_t(i + 34)});
  }
  plain.attributes()["POSITION"] = plain.add(floats, 3);
  plain.primitive()["indices"] = plain.add(indices, 1);
  quantised.attributes()["POSITION"] = quantised.add(bytes, 3, false, 1);
  quantised.primitive()["indices"] = quantised.add(indices, 1);
  const Mesh a = mesh(plain);
  const Mesh b = mesh(quantised);
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.triangles, b.triangles);
}

TEST_F(GltfAccessors, SparseAccessorsReplaceElementsOfAViewOrOfZeros) {
  GltfWriter file;
  const std::size_t places = file.view(test::bytes_of<std::uint8_t>({1, 2}));
  const std::size_t values = file.view(test::bytes_of<float>({3, 0, 0, 0, 3, 0}));
  const Json sparse = {{"count", 2},
                       {"indices", {{"bufferView", places}, {"componentType", 5121}}},
                       {"values", {{"bufferView", values}}}};
  file.attributes()["POSITION"] =
      file.accessor({{"componentType", 5126}, {"type", "VEC3"}, {"count", 3}, {"sparse", sparse}});
  EXPECT_THAT(flat(mesh(file).positions), ElementsAre(0, 0, 0, 3, 0, 0, 0, 3, 0));
  const std::size_t base = file.add<float>({1, 1, 1, 9, 9, 9, 9, 9, 9}, 3);
  file.root["accessors"][base]["sparse"] = sparse;
  file.attributes()["POSITION"] = base;
  EXPECT_THAT(flat(mesh(file).positions), ElementsAre(1, 1, 1, 3, 0, 0, 0, 3, 0));
}

// Joint 1 lifts by 2, and joint 0 does not move. The second vertex follows joint 1 with the weight
// 51, which is 1/5 of a byte's range, so the vertex is lifted by 0.4. The first and the third
// vertex follow joint 0 alone. A joint of weight 0 may have any index.
TEST_F(GltfAccessors, SkinsMayHaveWeightsOfBytes) {
  GltfWriter file;
  file.attributes() = {
      {"POSITION", file.add(kTriangle, 3)},
      {"JOINTS_0", file.add<std::uint8_t>({0, 9, 9, 9, 0, 1, 9, 9, 0, 9, 9, 9}, 4)},
      {"WEIGHTS_0", file.add<std::uint8_t>({255, 0, 0, 0, 204, 51, 0, 0, 255, 0, 0, 0}, 4, true)}};
  file.root["nodes"] = {{{"mesh", 0}, {"skin", 0}},
                        {{"name", "still"}},
                        {{"name", "lift"}, {"translation", {0, 2, 0}}}};
  file.root["scenes"][0]["nodes"] = {0, 1, 2};
  file.root["skins"] = {{{"joints", {1, 2}}}};
  const auto positions = flat(mesh(file).positions);
  ASSERT_EQ(positions.size(), 9u);
  EXPECT_FLOAT_EQ(positions[1], 0);
  EXPECT_FLOAT_EQ(positions[4], 0.4f);
  EXPECT_FLOAT_EQ(positions[7], 1);
  file.attributes()["JOINTS_0"] = file.add<std::uint8_t>({0, 9, 9, 9, 0, 2, 9, 9, 0, 9, 9, 9}, 4);
  EXPECT_THAT(std::string(file.import(folder_).status().message()),
              HasSubstr("nodes[0].skin: has 2 joints, but its mesh uses joint 2"));
}

TEST_F(GltfAccessors, MorphTargetsMayBeQuantised) {
  GltfWriter file;
  file.attributes()["POSITION"] = file.add(kTriangle, 3);
  file.primitive()["targets"] = {
      {{"POSITION", file.add<std::int16_t>({0, 0, 0, 0, 0, 0, 4, 0, 0, 0, -6, 0}, 3, false, 1)}}};
  file.root["meshes"][0]["weights"] = {0.5};
  EXPECT_THAT(flat(mesh(file).positions), ElementsAre(0, 0, 0, 1, 0, 2, 0, 1, -3));
}

/// A change to a valid file, and the words that the error must contain.
struct Damage {
  const char* patch;  ///< JSON patch (RFC 6902) of one operation
  const char* error;
};

class DamagedGltf : public ::testing::TestWithParam<Damage> {};

TEST_P(DamagedGltf, GivesAnErrorThatNamesTheFault) {
  const TempDir folder;
  GltfWriter file = WavySquare(2).plain();
  file.root["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
  file.root["textures"] = {{{"source", 0}}};
  file.root["images"] = {{{"uri", "a.ppm"}}};
  file.primitive()["material"] = 0;
  write_text(folder, "a.ppm", test::small_ppm());
  ASSERT_TRUE(file.import(folder).ok()) << file.import(folder).status();
  file.root["buffers"] = Json::array({{{"uri", "m.gltf.bin"}, {"byteLength", file.bytes.size()}}});
  file.root = file.root.patch(Json::parse(std::string("[") + GetParam().patch + "]"));
  const auto imported = file.import(folder);
  EXPECT_FALSE(imported.ok());
  EXPECT_THAT(std::string(imported.status().message()), HasSubstr("m.gltf: "));
  EXPECT_THAT(std::string(imported.status().message()), HasSubstr(GetParam().error));
}

// Sets a member of an object, or inserts an element into a list (the operation "add" of RFC 6902).
#define REPLACE(path, value) R"({"op": "add", "path": ")" path R"(", "value": )" value "}"
INSTANTIATE_TEST_SUITE_P(
    All, DamagedGltf,
    ::testing::Values(
        Damage{REPLACE("/accessors/0/count", "10"), "accessors[0]: needs 120 bytes"},
        Damage{REPLACE("/accessors/0/count", "-1"), "accessors[0].count: is not a whole number"},
        Damage{REPLACE("/accessors/0/count", "1e300"), "accessors[0].count: is not a whole number"},
        Damage{REPLACE("/accessors/0/count", "9007199254740992"), "accessors[0]: count is"},
        Damage{REPLACE("/accessors/0/byteOffset", "9007199254740992"), "accessors[0]: needs"},
        Damage{REPLACE("/accessors/0/byteOffset", "4"),
               "accessors[0]: needs 108 bytes from byte 4"},
        Damage{REPLACE("/accessors/0/componentType", "5124"), "componentType is 5124"},
        Damage{REPLACE("/accessors/0/type", "\"VEC2\""), "POSITION needs 3"},
        Damage{REPLACE("/accessors/0/type", "7"), "accessors[0]: type is \"\""},
        Damage{REPLACE("/accessors/0/bufferView", "99"), "bufferViews[99] does not exist"},
        Damage{REPLACE("/accessors/1/count", "8"),
               "has 9 values of POSITION, but 8 values of another attribute"},
        Damage{REPLACE("/accessors/3/componentType", "5126"), "must be an unsigned integer"},
        Damage{REPLACE("/bufferViews/3/byteOffset", "0"), "indices: refers to vertex"},
        Damage{REPLACE("/accessors/0/sparse", R"({"count": 1, "indices": {"bufferView": 0,
          "componentType": 5126}, "values": {"bufferView": 0}})"),
               "of its indices is 5126"},
        // The index is read from the bytes of a position, the float 0.5.
        Damage{REPLACE("/accessors/0/sparse", R"({"count": 1, "indices": {"bufferView": 0,
          "componentType": 5125, "byteOffset": 12}, "values": {"bufferView": 0}})"),
               "accessors[0].sparse: replaces element 1056964608; the number of elements is 9"},
        Damage{REPLACE("/accessors/0/sparse", R"({"count": 100})"), "accessors[0].sparse: has no"},
        Damage{REPLACE("/bufferViews/0/byteLength", "99999999"), "bufferViews[0]: ends at byte"},
        Damage{REPLACE("/bufferViews/0/byteOffset", "9007199254740991"), "bufferViews[0]: ends at"},
        Damage{REPLACE("/bufferViews/0/byteStride", "3"), "bufferViews[0].byteStride: is 3"},
        Damage{REPLACE("/bufferViews/0/byteStride", "200"), "accessors[0]: needs"},
        Damage{REPLACE("/bufferViews/0/buffer", "1"), "buffers[1]: does not exist"},
        Damage{REPLACE("/buffers/0/byteLength", "99999"), "buffers[0]: byteLength is 99999"},
        Damage{REPLACE("/buffers/0/uri", "\"data:;base64,!\""), "its base64 is broken"},
        Damage{REPLACE("/buffers/0/uri", "\"none.bin\""), "its file \"none.bin\" is missing"},
        Damage{REPLACE("/buffers/0/uri", "\"../../x.bin\""), "outside of the scene's folder"},
        Damage{REPLACE("/meshes/0/primitives/0/attributes/POSITION", "99"), "accessors[99]"},
        Damage{REPLACE("/meshes/0/primitives/0/attributes/POSITION", "\"a\""),
               "not a whole number"},
        Damage{REPLACE("/meshes/0/primitives/0/indices", "0"), "indices are single numbers"},
        Damage{REPLACE("/meshes/0/primitives/0/material", "1"), "materials[1] does not exist"},
        Damage{REPLACE("/materials/0/pbrMetallicRoughness/baseColorTexture/index", "5"),
               "textures[5] does not exist"},
        Damage{REPLACE("/textures/0/source", "3"), "images[3] does not exist"},
        Damage{REPLACE("/textures/0/sampler", "0"), "samplers[0] does not exist"},
        Damage{REPLACE("/images/0", "{}"), "images[0]: has neither"},
        Damage{REPLACE("/images/0/bufferView", "77"), "bufferViews[77] does not exist"},
        Damage{REPLACE("/nodes/0/mesh", "4"), "nodes[0].mesh: meshes[4] does not exist"},
        Damage{REPLACE("/nodes/0/skin", "0"), "skins[0] does not exist"},
        Damage{REPLACE("/nodes/0/children", "[0]"), "in a circle"},
        Damage{REPLACE("/nodes", R"([{"mesh": 0}, {"children": [2]}, {"children": [1]}])"),
               "in a circle"},
        Damage{REPLACE("/nodes", R"([{"children": [1, 1]}, {"mesh": 0}])"), "child of two nodes"},
        Damage{REPLACE("/nodes", "{}"), "nodes: is not a list"},
        Damage{REPLACE("/nodes/0", "3"), "nodes[0]: is not an object"},
        Damage{REPLACE("/scenes/0/nodes", "[0, 0]"), "twice"},
        Damage{REPLACE("/scene", "1"), "scenes[1] does not exist"},
        Damage{REPLACE("/extensionsRequired", "[\"KHR_texture_basisu\"]"),
               "requires the extension KHR_texture_basisu"}));
#undef REPLACE

TEST_F(GltfAccessors, ADeepTreeOfNodesIsRefused) {
  GltfWriter file = WavySquare(2).plain();
  for (int n = 1; n < 2000; ++n) {
    file.root["nodes"][n] = {{"children", {n - 1}}};
  }
  file.root["scenes"][0]["nodes"] = {1999};
  EXPECT_THAT(std::string(file.import(folder_).status().message()),
              HasSubstr("nodes: are nested deeper than 1000 levels"));
}

TEST_F(GltfAccessors, JsonThatIsBrokenOrTooDeepIsRefused) {
  const auto message = [&](const std::string& json) {
    return std::string(import_scene(write_text(folder_, "j.gltf", json)).status().message());
  };
  EXPECT_THAT(message(R"({"asset": )"), HasSubstr("its JSON: is broken at byte"));
  EXPECT_THAT(message("[]"), HasSubstr("its JSON: is not an object"));
  EXPECT_THAT(message(R"({"asset": {"version": "2.0", "generator": ")"
                      "\xff"
                      R"("}})"),
              HasSubstr("its JSON: is broken at byte"));
  EXPECT_THAT(message(std::string(100'000, '[')), HasSubstr("nested deeper than 100 levels"));
  EXPECT_THAT(message(R"({"a": 1e999})"), HasSubstr("a number that is too large"));
}

// In glTF 1.0 the lists are JSON objects whose keys are names. Some programs write the version as a
// number.
TEST_F(GltfAccessors, FilesOfGltf1AreRead) {
  write_text(folder_, "f.bin", test::bytes_of(kTriangle));
  for (const std::string version : {"\"1.0\"", "1"}) {
    const auto imported = import_scene(write_text(
        folder_, "f.gltf",
        R"({"asset": {"version": )" + version + R"(}, "scene": "s", "extensionsUsed": ["X_y"],
"scenes": {"s": {"nodes": ["n"]}}, "nodes": {"n": {"meshes": ["m"]}},
"meshes": {"m": {"primitives": [{"attributes": {"POSITION": "a"}, "mode": 4}]}},
"accessors": {"a": {"bufferView": "v", "byteOffset": 0, "byteStride": 12, "componentType": 5126,
  "count": 3, "type": "VEC3"}},
"bufferViews": {"v": {"buffer": "b", "byteOffset": 0, "byteLength": 36, "target": 34962}},
"buffers": {"b": {"byteLength": 36, "type": "arraybuffer", "uri": "f.bin"}}})"));
    ASSERT_TRUE(imported.ok()) << imported.status();
    EXPECT_EQ(flat(imported->scene.geometry.meshes.at(0).positions), kTriangle);
    EXPECT_THAT(imported->info.warnings,
                ::testing::Contains("f.gltf: the extension X_y is left out"));
  }
}

// A .glb that is truncated anywhere is an error.
TEST_F(GltfAccessors, EveryTruncationIsAnError) {
  const std::string whole = WavySquare(1).plain().glb();
  ASSERT_TRUE(import_scene(write_text(folder_, "w.glb", whole)).ok());
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const auto cut = import_scene(write_text(folder_, "c.glb", whole.substr(0, size)));
    EXPECT_EQ(cut.status().code(), absl::StatusCode::kInvalidArgument) << size;
  }
}

}  // namespace
}  // namespace bandsaw
