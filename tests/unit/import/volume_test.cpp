// *.vol and *.vdb files, and media of scene files that use them. Valid files are read exactly, and
// a broken file gives one clear error.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/LevelSetSphere.h>

#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>

#include "renderlib/import/import.h"
#include "renderlib/import/volume/volume_file.h"
#include "tests/unit/import/files.h"
#include "tests/unit/import/gltf_writer.h"

namespace bandsaw {
namespace {

using test::TempDir;
using test::write_text;
using ::testing::HasSubstr;

/// Appends the bytes of `value` in memory.
template <class T>
void append(std::string& bytes, const T& value) {
  std::array<char, sizeof(T)> raw;
  std::memcpy(raw.data(), &value, sizeof(T));
  bytes.append(raw.data(), raw.size());
}

/// A *.vol file, the format of Mitsuba's grids. `encoding`: 1: floats; 2: halves; 3: bytes.
struct Vol {
  std::int32_t encoding = 1;
  std::array<std::int32_t, 3> cells = {3, 2, 1};
  std::int32_t channels = 1;
  std::array<float, 6> box = {-1, 0, 0, 5, 4, 2};
  std::vector<float> numbers = {0, 1, 2, 3, 4, 5.1f};

  std::string bytes() const {
    std::string out = "VOL\3";
    append(out, encoding);
    append(out, cells);
    append(out, channels);
    append(out, box);
    for (const float number : numbers) {
      append(out, number);
    }
    return out;
  }
};

/// Reads a *.vol file that consists of these bytes.
absl::StatusOr<FileGrid> read(const std::string& bytes) {
  return read_vol({reinterpret_cast<const std::byte*>(bytes.data()), bytes.size()});
}

std::string error_of(const std::string& bytes) {
  return std::string(read(bytes).status().message());
}

TEST(VolFile, IsReadExactly) {
  const auto read_grid = read(Vol{}.bytes());
  ASSERT_TRUE(read_grid.ok()) << read_grid.status();
  const VolumeGrid& grid = read_grid->grid;
  EXPECT_TRUE(check_grid(grid).ok()) << check_grid(grid).status();
  EXPECT_EQ(grid.cells, (std::array<std::uint32_t, 3>{3, 2, 1}));
  const GridReader reader(grid);
  EXPECT_EQ(reader.cell(0, 0, 0), 0);
  EXPECT_EQ(reader.cell(2, 0, 0), 2);
  EXPECT_EQ(reader.cell(0, 1, 0), 3);
  EXPECT_EQ(reader.cell(2, 1, 0), 5.1f);
  EXPECT_EQ(grid.to_medium.point({0, 0, 0}), (Vec3{-1, 0, 0}));
  EXPECT_EQ(grid.to_medium.point({3, 2, 1}), (Vec3{5, 4, 2}));
  EXPECT_EQ(read_grid->to_unit_box.point({3, 2, 1}), (Vec3{1, 1, 1}));
}

TEST(VolFile, ReadsThreeEncodingsAndThreeChannels) {
  std::string bytes = Vol{.encoding = 3, .cells = {2, 1, 1}, .numbers = {}}.bytes();
  bytes += "\x33\xff";
  auto grid = read(bytes);
  ASSERT_TRUE(grid.ok()) << grid.status();
  EXPECT_EQ(GridReader(grid->grid).cell(0, 0, 0), 51.0f / 255);
  EXPECT_EQ(GridReader(grid->grid).cell(1, 0, 0), 1);
  bytes = Vol{.encoding = 2, .cells = {2, 1, 1}, .numbers = {}}.bytes();
  append(bytes, std::uint16_t{0x3c00});
  append(bytes, std::uint16_t{0x3555});
  grid = read(bytes);
  ASSERT_TRUE(grid.ok()) << grid.status();
  EXPECT_EQ(GridReader(grid->grid).cell(0, 0, 0), 1);
  EXPECT_EQ(GridReader(grid->grid).cell(1, 0, 0), 0.333251953125f);
  grid = read(Vol{.cells = {2, 1, 1}, .channels = 3}.bytes());
  ASSERT_TRUE(grid.ok()) << grid.status();
  EXPECT_EQ(GridReader(grid->grid).color({1.5, 0.5, 0.5}), (Rgb{3, 4, 5.1f}));
}

TEST(VolFile, NegativeNumbersBecomeZeroAndAreCounted) {
  Vol vol;
  vol.numbers[1] = -2;
  vol.numbers[4] = -0.0f;
  const auto grid = read(vol.bytes());
  ASSERT_TRUE(grid.ok()) << grid.status();
  EXPECT_EQ(grid->negative, 1u);
  EXPECT_EQ(GridReader(grid->grid).cell(1, 0, 0), 0);
  EXPECT_TRUE(check_grid(grid->grid).ok());
}

TEST(VolFile, DamageIsOneClearError) {
  const std::string good = Vol{}.bytes();
  for (std::size_t size = 0; size < good.size(); ++size) {
    EXPECT_FALSE(read(good.substr(0, size)).ok()) << size;
  }
  EXPECT_THAT(error_of(""), HasSubstr("is no *.vol file"));
  EXPECT_THAT(error_of(good.substr(0, 60)),
              HasSubstr("claims 3 x 2 x 1 cells of 1 channels, and has 3 numbers: it is cut off"));
  EXPECT_THAT(error_of("VOL\2" + good.substr(4)),
              HasSubstr("has version 2; only version 3 can be read"));
  EXPECT_THAT(error_of(Vol{.encoding = 4}.bytes()), HasSubstr("has encoding 4"));
  EXPECT_THAT(error_of(Vol{.channels = 2}.bytes()), HasSubstr("has 2 channels"));
  EXPECT_THAT(error_of(Vol{.channels = -1}.bytes()), HasSubstr("has -1 channels"));
  EXPECT_THAT(error_of(Vol{.cells = {0, 2, 1}}.bytes()), HasSubstr("has a side of 0 cells"));
  EXPECT_THAT(error_of(Vol{.cells = {3, -2, 1}}.bytes()), HasSubstr("has a side of -2 cells"));
  // The headers claim 10 GB, and 2^60 cells of three channels.
  EXPECT_THAT(error_of(Vol{.cells = {1360, 1360, 1360}}.bytes()), HasSubstr("claims 1360 x 1360"));
  EXPECT_THAT(error_of(Vol{.cells = {1 << 20, 1 << 20, 1 << 20}, .channels = 3}.bytes()),
              HasSubstr("claims 1048576 x"));
  EXPECT_THAT(error_of(Vol{.box = {0, 0, 0, 1, 0, 1}}.bytes()),
              HasSubstr("has a box from 0 to 0 along axis 1"));
  EXPECT_THAT(error_of(Vol{.box = {0, 0, 0, 1, NAN, 1}}.bytes()), HasSubstr("along axis 1"));
  for (const float bad : {NAN, INFINITY, -INFINITY}) {
    Vol vol;
    vol.numbers[4] = bad;
    EXPECT_THAT(error_of(vol.bytes()), HasSubstr("number 4 is "));
  }
}

/// Writes grids to a *.vdb file and returns its path.
std::string write_vdb(const TempDir& folder, const openvdb::GridPtrVec& grids,
                      const std::string& name = "a.vdb") {
  openvdb::initialize();
  openvdb::io::File file(folder / name);
  file.write(grids);
  file.close();
  return folder / name;
}

/// Returns an empty grid with this name.
template <class Grid>
typename Grid::Ptr named(const std::string& name,
                         openvdb::GridClass kind = openvdb::GRID_FOG_VOLUME) {
  typename Grid::Ptr grid = Grid::create();
  grid->setName(name);
  grid->setGridClass(kind);
  return grid;
}

/// Returns a grid of 500 voxels, scaled by 0.25 and moved.
openvdb::FloatGrid::Ptr sparse_grid(const std::string& name) {
  auto grid = named<openvdb::FloatGrid>(name);
  auto access = grid->getAccessor();
  for (int i = 0; i < 500; ++i) {
    access.setValue({i % 23 - 20, i % 7 + 30, i % 11}, 0.1f * static_cast<float>(i % 13));
  }
  grid->setTransform(openvdb::math::Transform::createLinearTransform(0.25));
  grid->transform().postTranslate({1, 2, 3});
  return grid;
}

TEST(VdbFile, IsReadWithTheValuesAndPlacementOfOpenVdb) {
  const TempDir folder;
  const auto grid = sparse_grid("density");
  const std::string path = write_vdb(folder, {grid, sparse_grid("other")});
  const auto read_grid = read_volume(path, "", "density");
  ASSERT_TRUE(read_grid.ok()) << read_grid.status();
  ASSERT_TRUE(check_grid(read_grid->grid).ok()) << check_grid(read_grid->grid).status();
  const GridReader reader(read_grid->grid);
  const Transform to_cells = *inverse(read_grid->grid.to_medium);
  const auto access = grid->getConstAccessor();
  int positive = 0;
  for (int x = -30; x < 10; ++x) {
    for (int y = 25; y < 45; ++y) {
      for (int z = -5; z < 20; ++z) {
        const openvdb::Vec3d at = grid->indexToWorld(openvdb::Coord(x, y, z));
        const float value = access.getValue({x, y, z});
        ASSERT_NEAR(reader.value(to_cells.point({at.x(), at.y(), at.z()})), value, 1e-5)
            << x << " " << y << " " << z;
        positive += value > 0 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(positive, 100);
}

TEST(VdbFile, TilesVectorsDoublesAndHalvesAreRead) {
  const TempDir folder;
  auto tiles = named<openvdb::FloatGrid>("density");
  // The grid has a cube of 128 x 128 x 128 voxels. OpenVDB stores the cube as tiles, each with one
  // value for many voxels, or as leaves of 8 x 8 x 8 voxels. Beside the cube, a part of a leaf has
  // values.
  tiles->fill(openvdb::CoordBBox({0, 0, 0}, {127, 127, 127}), 0.5f);
  tiles->tree().prune();
  tiles->fill(openvdb::CoordBBox({128, 0, 0}, {130, 7, 7}), 2.0f);
  auto vectors = named<openvdb::Vec3SGrid>("albedo");
  vectors->fill(openvdb::CoordBBox({0, 0, 0}, {3, 3, 3}), {0.25f, 0.5f, 1});
  auto doubles = named<openvdb::DoubleGrid>("temperature");
  doubles->fill(openvdb::CoordBBox({0, 0, 0}, {3, 3, 3}), 1000);
  tiles->setSaveFloatAsHalf(true);
  const std::string path = write_vdb(folder, {tiles, vectors, doubles});
  const auto density = read_volume(path, "density", "");
  ASSERT_TRUE(density.ok()) << density.status();
  const Transform to_cells = *inverse(density->grid.to_medium);
  const GridReader reader(density->grid);
  EXPECT_EQ(density->grid.format, VolumeGrid::Format::kFloat16);
  EXPECT_EQ(reader.value(to_cells.point({5, 77, 100})), 0.5f);
  EXPECT_EQ(reader.value(to_cells.point({127, 127, 127})), 0.5f);
  EXPECT_EQ(reader.value(to_cells.point({129, 3, 3})), 2);
  EXPECT_EQ(reader.value(to_cells.point({131, 3, 3})), 0);
  EXPECT_EQ(reader.value(to_cells.point({-1, 3, 3})), 0);
  // A brick has 8 x 8 x 8 voxels. The bricks of the cube are equal and stored once. The second
  // brick that is stored has the part of a leaf. A voxel has two bytes.
  EXPECT_EQ(density->grid.values.size(), 2 * 512 * 2u);
  const auto albedo = read_volume(path, "albedo", "");
  ASSERT_TRUE(albedo.ok()) << albedo.status();
  EXPECT_EQ(GridReader(albedo->grid).color(inverse(albedo->grid.to_medium)->point({1, 2, 3})),
            (Rgb{0.25f, 0.5f, 1}));
  const auto hot = read_volume(path, "", "temperature");
  ASSERT_TRUE(hot.ok()) << hot.status();
  EXPECT_EQ(*check_grid(hot->grid), 1000);  // the largest value of the grid
}

TEST(VdbFile, AnEmptyGridIsZero) {
  const TempDir folder;
  const auto grid =
      read_volume(write_vdb(folder, {named<openvdb::FloatGrid>("density")}), "", "other");
  ASSERT_TRUE(grid.ok()) << grid.status();
  EXPECT_EQ(*check_grid(grid->grid), 0);
}

/// Writes the grids to a *.vdb file and reads the grid `name`. Returns the message of the error.
std::string vdb_error(const openvdb::GridPtrVec& grids, const std::string& name = "density") {
  const TempDir folder;
  return std::string(read_volume(write_vdb(folder, grids), name, "").status().message());
}

TEST(VdbFile, AnUnsupportedGridIsOneClearError) {
  EXPECT_THAT(
      vdb_error({openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(4, {0, 0, 0}, 1)}, ""),
      HasSubstr("is a level set: distances to a surface. Convert it to a fog volume"));
  EXPECT_THAT(vdb_error({named<openvdb::BoolGrid>("density")}), HasSubstr("is of type Tree_bool"));
  EXPECT_THAT(vdb_error({sparse_grid("heat"), sparse_grid("smoke")}),
              HasSubstr("has no grid called \"density\"; it has \"heat\", \"smoke\""));
  auto bad = named<openvdb::FloatGrid>("density");
  bad->getAccessor().setValue({1, 2, -3}, std::numeric_limits<float>::quiet_NaN());
  EXPECT_THAT(vdb_error({bad}), HasSubstr("voxel [1, 2, -3] is nan, not finite"));
  auto wide = named<openvdb::FloatGrid>("density");
  wide->getAccessor().setValue({0, 0, 0}, 1);
  wide->getAccessor().setValue({2000000, 0, 0}, 1);
  EXPECT_THAT(vdb_error({wide}), HasSubstr("spans 2000016 voxels along axis 0"));
  auto huge = named<openvdb::FloatGrid>("density");
  huge->getAccessor().setValue({0, 0, 0}, 1);
  huge->getAccessor().setValue({9000, 9000, 9000}, 1);
  EXPECT_THAT(vdb_error({huge}), HasSubstr("bricks of 8 x 8 x 8 voxels, at most"));
  auto flat = sparse_grid("density");
  flat->setTransform(openvdb::math::Transform::createFrustumTransform(
      openvdb::BBoxd({0, 0, 0}, {10, 10, 10}), 0.5, 10));
  EXPECT_THAT(vdb_error({flat}), HasSubstr("not affine"));
}

TEST(VdbFile, AFileOfAnotherFormatIsOneClearError) {
  const TempDir folder;
  EXPECT_FALSE(read_volume(write_text(folder, "empty.vdb", ""), "", "").ok());
  EXPECT_THAT(std::string(read_volume(write_text(folder, "no.vdb", "not a vdb file at all, no"), "",
                                      "density")
                              .status()
                              .message()),
              HasSubstr("is no OpenVDB file that can be read"));
}

const std::string kHead = "camera { position: [0, 1, 5] look_at: [0, 0, 0] }\n";

/// Imports a scene file of kHead and `text`. Its folder also has four files of volumes.
absl::StatusOr<ImportedScene> import_text(const std::string& text) {
  const TempDir folder;
  write_text(folder, "a.vol", Vol{}.bytes());
  Vol negative;
  negative.numbers[2] = -1;
  write_text(folder, "negative.vol", negative.bytes());
  write_text(folder, "cut.vol", Vol{}.bytes().substr(0, 50));
  write_vdb(folder, {sparse_grid("density")}, "b.vdb");
  return import_scene(write_text(folder, "s.textproto", kHead + text));
}

std::string message_of(const std::string& text) {
  return std::string(import_text(text).status().message());
}

TEST(SceneVolumes, AreReadAndSharedAndPlaced) {
  const auto imported = import_text(R"(
medium { name: "smoke" scattering { rgb: [1, 2, 3] } density: 2
  density_grid { file: "a.vol" scale: 0.5 unit_box: true
                 matrix: [2, 0, 0, 1, 0, 2, 0, 2, 0, 0, 2, 3] clamp: true } }
medium { name: "fire" density: 3
  albedo_grid { file: "b.vdb" grid: "density" filter: FILTER_NEAREST }
  emission_grid { file: "a.vol" }
  temperature_grid { file: "a.vol" scale: 100 } temperature_scale: 2 temperature_offset: 300
  blackbody: BLACKBODY_PEAK }
medium { name: "more" emission { rgb: [1, 0, 0] } density_grid { file: "a.vol" grid: "" } }
shape { sphere { radius: 1 } interior: "fire" }
shape { box { min: [0, 0, 0] max: [2, 2, 2] } interior: "smoke" }
shape { box { min: [0, 0, 0] max: [2, 2, 2] } interior: "smoke" velocity: [1, 0, 0] }
group { name: "g" shape { box { min: [0, 0, 0] max: [1, 2, 3] } interior: "smoke" } }
instance { of: "g" translate: [5, 0, 0] }
instance { of: "g" scale: [2, 2, 2] }
)");
  ASSERT_TRUE(imported.ok()) << imported.status();
  const Media& media = imported->scene.media;
  const MediumGrids& smoke = media.media[0].grids;
  ASSERT_TRUE(smoke.density);
  EXPECT_EQ(smoke.density->scale, 0.5f);
  const VolumeGrid& first = media.grids[index_of(smoke.density->grid)];
  // The grid has three cells along x, so (3, 0, 0) is the corner (1, 0, 0) of the unit box. The
  // matrix doubles this corner and moves it by (1, 2, 3).
  EXPECT_EQ(first.to_medium.point({3, 0, 0}), (Vec3{3, 2, 3}));
  EXPECT_EQ(first.border, VolumeGrid::Border::kClamp);
  const Medium& fire = media.media[1];
  EXPECT_EQ(fire.scattering, gray(3));
  EXPECT_EQ(fire.absorption, gray(0));
  EXPECT_EQ(fire.emission, gray(3));
  EXPECT_EQ(fire.grids.temperature->scale, 200);
  EXPECT_EQ(fire.grids.temperature_offset, 300);
  EXPECT_EQ(fire.grids.blackbody, BlackbodyScale::kPeak);
  EXPECT_EQ(media.grids[index_of(fire.grids.albedo->grid)].filter, VolumeGrid::Filter::kNearest);
  // The boundaries are the sphere and four boxes. Each box has a frame, the coordinate system of
  // the box before the box is placed in the world. The medium of the box is in this frame too.
  const Geometry& boundaries = media.boundaries;
  EXPECT_EQ(boundaries.spheres.size(), 1u);
  ASSERT_EQ(boundaries.instances.size(), 4u);
  for (const Instance& instance : boundaries.instances) {
    ASSERT_NE(instance.frame, kNoFrame);
  }
  EXPECT_EQ(frame_at(boundaries.frames, boundaries.instances[0].frame, 0), Transform{});
  const Instance& placed = boundaries.instances[2];
  EXPECT_EQ(frame_at(boundaries.frames, placed.frame, 0), translation({5, 0, 0}));
  EXPECT_EQ(placed.to_world.point({1, 1, 1}), (Vec3{1, 2, 3}));
  EXPECT_EQ(frame_at(boundaries.frames, boundaries.instances[3].frame, 0), scaling({2, 2, 2}));
}

TEST(SceneVolumes, AMovingNodeOfAModelCannotBeFilledByAMediumWithGrids) {
  const TempDir folder;
  test::GltfWriter model;
  model.attributes() = {{"POSITION", model.add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, 3)}};
  const auto times = model.add<float>({0, 1}, 1);
  const auto places = model.add<float>({0, 0, 0, 1, 0, 0}, 3);
  model.root["animations"] = {
      {{"samplers", {{{"input", times}, {"output", places}}}},
       {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}}};
  model.write(folder, "m.gltf");
  write_text(folder, "a.vol", Vol{}.bytes());
  ImportChoices choices;
  choices.frame = FrameChoice{.number = 0, .fps = 4, .shutter = 0.5};
  const auto imported = import_scene(write_text(folder, "s.textproto", kHead + R"(
medium { name: "smoke" scattering { rgb: [1, 1, 1] } density_grid { file: "a.vol" } }
model { file: "m.gltf" interior: "smoke" })"),
                                     choices);
  EXPECT_THAT(std::string(imported.status().message()),
              HasSubstr("model[0].interior: has grids, but a node of the model moves while the "
                        "shutter is open"));
}

TEST(SceneVolumes, AGridThatIsUsedTwiceWithOnePlacementIsStoredOnce) {
  const auto imported = import_text(R"(
medium { name: "a" density_grid { file: "a.vol" grid: "" scale: 2 } scattering { rgb: [1, 1, 1] } }
medium { name: "b" density_grid { file: "a.vol" } scattering { rgb: [1, 1, 1] } }
medium { name: "c" density_grid { file: "a.vol" unit_box: true } scattering { rgb: [1, 1, 1] } }
)");
  ASSERT_TRUE(imported.ok()) << imported.status();
  EXPECT_EQ(imported->scene.media.grids.size(), 2u);
}

TEST(SceneVolumes, ErrorsNameTheField) {
  const auto of_grid = [](const std::string& grid) {
    return message_of("medium { name: \"a\" scattering { rgb: [1, 1, 1] } density_grid { " + grid +
                      " } }");
  };
  EXPECT_THAT(of_grid(""), HasSubstr("medium[0].density_grid.file: is required"));
  EXPECT_THAT(of_grid("file: \"c.vol\""), HasSubstr("medium[0].density_grid.file: "));
  EXPECT_THAT(of_grid("file: \"../a.vol\""), HasSubstr("medium[0].density_grid.file: "));
  EXPECT_THAT(of_grid("file: \"cut.vol\""),
              HasSubstr("density_grid.file: cut.vol: claims 3 x 2 x 1 cells"));
  EXPECT_THAT(of_grid("file: \"s.textproto\""),
              HasSubstr("is not a volume: files of volumes end in"));
  EXPECT_THAT(of_grid("file: \"a.vol\" grid: \"x\""), HasSubstr("has one grid, without a name"));
  EXPECT_THAT(of_grid("file: \"b.vdb\" unit_box: true"), HasSubstr("unit_box: is for *.vol files"));
  EXPECT_THAT(of_grid("file: \"b.vdb\" clamp: true"), HasSubstr("clamp: is for *.vol files"));
  EXPECT_THAT(of_grid("file: \"a.vol\" scale: -1"), HasSubstr("density_grid.scale: must lie in"));
  EXPECT_THAT(of_grid("file: \"a.vol\" matrix: [1, 2]"),
              HasSubstr("density_grid.matrix: must be 12 numbers, has 2"));
  EXPECT_THAT(of_grid("file: \"a.vol\" matrix: [0,0,0,0, 0,0,0,0, 0,0,0,0]"),
              HasSubstr("density_grid.matrix: must not be singular"));
  EXPECT_THAT(of_grid("file: \"a.vol\" scale: 1e13"),
              HasSubstr("density_grid: must be at most 1e+12 per scene unit"));
  EXPECT_THAT(message_of("medium { name: \"a\" albedo { rgb: [1, 1, 1] } albedo_grid { file: "
                         "\"a.vol\" } }"),
              HasSubstr("medium[0].albedo_grid: write albedo_grid, or albedo,"));
  EXPECT_THAT(message_of("medium { name: \"a\" temperature_scale: 2 }"),
              HasSubstr("medium[0].temperature_scale: needs a temperature_grid"));
  EXPECT_THAT(message_of("medium { name: \"a\" density_grid { file: \"a.vol\" } scattering { rgb: "
                         "[1, 1, 1] } }\nfog: \"a\""),
              HasSubstr("fog: must not have grids"));
  const auto warned = import_text(
      "medium { name: \"a\" density_grid { file: \"negative.vol\" } scattering { rgb: [1, 1, 1] } "
      "}");
  ASSERT_TRUE(warned.ok()) << warned.status();
  EXPECT_THAT(warned->info.warnings,
              ::testing::Contains("negative.vol: 1 numbers of its grid were below 0 and became 0"));
}

}  // namespace
}  // namespace bandsaw
