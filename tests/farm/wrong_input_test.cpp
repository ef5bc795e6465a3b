// Every wrong input gives one clear sentence, the documented exit code, and no partial output.

#include <gtest/gtest.h>

#include <sys/mount.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "tests/farm/farm_processes.h"

namespace bandsaw::test {
namespace {

constexpr int kFailed = 1;
constexpr int kWrongUse = 2;
constexpr int kNoFarm = 3;

void write_input(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

// Expects one line on standard error that contains each of `words`, and the exit code.
void expect_error(const Finished& finished, int code, const std::vector<std::string>& words) {
  EXPECT_EQ(finished.code, code) << finished.err;
  EXPECT_EQ(std::count(finished.err.begin(), finished.err.end(), '\n'), 1) << finished.err;
  for (const std::string& word : words) {
    EXPECT_NE(finished.err.find(word), std::string::npos)
        << "no '" << word << "' in: " << finished.err;
  }
}

/// Runs `bandsaw render` with these arguments for a small image.
Finished render(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {BANDSAW_BIN, "render"});
  arguments.insert(arguments.end(), {"--width", "16", "--samples", "1", "--quiet"});
  return run(arguments);
}

class WrongInput : public testing::Test {
 protected:
  /// Writes a scene file with a camera in line 1 and the text `more` from line 2. Returns its path.
  std::string scene_with(const std::string& more) {
    const std::string path = folder_ / "scene.textproto";
    write_input(path, "camera { look_at: [0, 0, -1] }\n" + more);
    return path;
  }
  std::string output() const { return folder_ / "out.png"; }
  bool nothing_written() const {
    return std::none_of(std::filesystem::directory_iterator(folder_.path()), {}, [](const auto& e) {
      return e.path().string().find("out.png") != std::string::npos;
    });
  }
  TempDir folder_;
};

TEST_F(WrongInput, AMissingSceneIsNamed) {
  expect_error(render({folder_ / "no.textproto", "-o", output()}), kWrongUse, {"no.textproto"});
  EXPECT_TRUE(nothing_written());
}

TEST_F(WrongInput, UnknownFieldNamesLineAndColumn) {
  expect_error(
      render({scene_with("shape { sfere { radius: 1 } material: \"m\" }\n"), "-o", output()}),
      kWrongUse, {"scene.textproto:2:", "sfere"});
  EXPECT_TRUE(nothing_written());
}

TEST_F(WrongInput, ValueOutOfRangeNamesTheField) {
  const std::string scene = scene_with(
      "material { name: \"m\" diffuse { color { rgb: [1, 1, 1] } } }\n"
      "shape { sphere { center: [0, 0, -3] radius: -1 } material: \"m\" }\n");
  expect_error(render({scene, "-o", output()}), kWrongUse, {"scene.textproto:3:", "radius", "-1"});
}

TEST_F(WrongInput, AMissingTextureIsNamed) {
  const std::string scene = scene_with(
      "material { name: \"m\" diffuse { texture { image { file: \"no.png\" } } } }\n"
      "shape { sphere { center: [0, 0, -3] radius: 1 } material: \"m\" }\n");
  expect_error(render({scene, "-o", output()}), kWrongUse, {"no.png"});
}

TEST_F(WrongInput, AFileOutsideTheScenesFolderIsRefused) {
  const std::string scene = scene_with("model { file: \"../../etc/passwd\" }\n");
  expect_error(render({scene, "-o", output()}), kWrongUse, {"../../etc/passwd", "below"});
}

TEST_F(WrongInput, ATruncatedModelIsRefused) {
  const std::string whole =
      file_bytes("/usr/share/assimp/models/glTF2/BoxTextured-glTF-Binary/BoxTextured.glb");
  write_input(folder_ / "cut.glb", whole.substr(0, whole.size() / 2));
  expect_error(render({folder_ / "cut.glb", "-o", output()}), kWrongUse, {"cut.glb"});
  EXPECT_TRUE(nothing_written());
}

TEST_F(WrongInput, UnwritableOutputIsReportedBeforeRendering) {
  expect_error(render({kCornell, "-o", "/nonexistent/out.png"}), kWrongUse, {"/nonexistent"});
  expect_error(render({kCornell, "-o", folder_ / "out.jpeg"}), kWrongUse, {"jpeg", "pfm"});
}

TEST_F(WrongInput, AFullDiskLeavesNoPartialFile) {
  const std::string disk = folder_ / "disk";
  ASSERT_EQ(mkdir(disk.c_str(), 0700), 0);
  if (mount("tmpfs", disk.c_str(), "tmpfs", 0, "size=16k") != 0) {
    GTEST_SKIP() << "needs the right to mount a small tmpfs (run as root)";
  }
  const Finished finished = run({BANDSAW_BIN, "render", kCornell, "--width", "200", "--samples",
                                 "1", "--quiet", "-o", disk + "/out.pfm"});
  const bool empty = std::filesystem::is_empty(disk);
  umount(disk.c_str());
  expect_error(finished, kFailed, {"out.pfm", "space"});
  EXPECT_TRUE(empty);
}

TEST_F(WrongInput, WrongOptionsAndCommandsAreRefused) {
  expect_error(run({BANDSAW_BIN, "render", kCornell, "--samples", "4", "--error", "1%"}), kWrongUse,
               {});
  expect_error(run({BANDSAW_BIN, "render", kCornell, "--samples", "0"}), kWrongUse, {"samples"});
  expect_error(run({BANDSAW_BIN, "render", kCornell, "--rows", "9:2"}), kWrongUse, {"rows"});
  expect_error(run({BANDSAW_BIN, "rendr", kCornell}), kWrongUse, {"rendr"});
}

TEST_F(WrongInput, AWrongJoinStringIsRefused) {
  const Finished worker = run({BANDSAW_WORKER_BIN, "--join", "bsw1-w-nonsense"});
  expect_error(worker, kWrongUse, {"join string"});
  expect_error(run({BANDSAW_BIN, "jobs", "--farm", "bsw1-x"}), kWrongUse, {"join string"});
}

TEST_F(WrongInput, AMissingCoordinatorIsReported) {
  std::string farm;
  {
    FarmProcesses gone;
    farm = file_bytes(gone.farm_file());
  }
  expect_error(run({BANDSAW_BIN, "jobs", "--farm", farm}), kNoFarm, {"127.0.0.1:"});
}

TEST_F(WrongInput, AWorkersSecretCannotSubmit) {
  FarmProcesses farm;
  const Finished finished =
      run({BANDSAW_BIN, "submit", kCornell, "--farm", farm.join_file(), "-o", output()});
  EXPECT_NE(finished.code, 0);
  EXPECT_NE(finished.err.find("worker"), std::string::npos) << finished.err;
  EXPECT_TRUE(nothing_written());
}

TEST_F(WrongInput, ASecondCoordinatorOnThePortOrTheFolderIsRefused) {
  FarmProcesses farm;
  const std::string join = file_bytes(farm.farm_file());
  const std::size_t at = join.find("127.0.0.1:");
  const std::string address = join.substr(at, join.find('-', at) - at);
  expect_error(run({BANDSAW_BIN, "serve", "--data", folder_ / "other", "--listen", address}),
               kFailed, {address});
  expect_error(run({BANDSAW_BIN, "serve", "--data", farm.path("data"), "--listen", "127.0.0.1:0"}),
               kFailed, {farm.path("data")});
}

TEST_F(WrongInput, AnUnknownJobIsReported) {
  FarmProcesses farm;
  expect_error(run(farm.command({"watch", "99"})), kFailed, {"99"});
  expect_error(run(farm.command({"cancel", "99"})), kFailed, {"99"});
}

}  // namespace
}  // namespace bandsaw::test
