// The import of a scene in a separate, confined process gives the same bytes as the import by the
// library. If anything goes wrong, the import gives one clear error. An ImportSession imports
// several frames of a scene by one process.

#include "coordinator/cli/scene/import_process.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <atomic>
#include <filesystem>

#include "coordinator/cli/base/child_process.h"
#include "renderlib/import/import.h"
#include "tests/support/sanitized.h"
#include "tests/unit/import/files.h"
#include "tests/unit/import/gltf_writer.h"

namespace bandsaw::coordinator {
namespace {

using test::TempDir;
using test::write_text;
using ::testing::HasSubstr;
using ::testing::StartsWith;

ImportLimits limits() {
  ImportLimits limits;
  limits.program = BANDSAW_IMPORT_BIN;
  return limits;
}

/// Returns the number of files and folders in a folder.
std::size_t entries(const std::string& folder) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

TEST(ImportProcess, GivesTheSameBytesAsTheLibrary) {
  const std::string path = std::string(BANDSAW_GALLERY) + "/mesh.textproto";
  auto imported = import_in_process(path, limits());
  ASSERT_TRUE(imported.ok()) << imported.status();
  const auto here = import_scene(path);
  ASSERT_TRUE(here.ok()) << here.status();
  BlobMap blobs;
  EXPECT_EQ(imported->manifest(), encode_package(here->scene, here->info, blobs));
  EXPECT_EQ(imported->info().name, "mesh");
  const auto refs = package_blobs(imported->manifest());
  ASSERT_TRUE(refs.ok()) << refs.status();
  for (const BlobRef& ref : *refs) {
    EXPECT_TRUE(imported->blobs().get(ref.digest).ok());
  }
  EXPECT_TRUE(decode_package(imported->manifest(), imported->blobs()).ok());
}

TEST(ImportProcess, TheTimeLimitGrowsWithTheFilesOfTheScene) {
  const TempDir folder;
  const std::string scene = write_text(folder, "scene.json", std::string(1000, ' '));
  EXPECT_NEAR(import_timeout_s(scene, 120), 120, 0.001);
  std::filesystem::create_directory(folder / "meshes");
  write_text(folder, "meshes/large.glb", "");
  std::filesystem::resize_file(folder / "meshes/large.glb", 2'000'000'000);  // a hole in the file
  // Each 4 MB in the folder of the scene add a second to the 120 seconds.
  EXPECT_NEAR(import_timeout_s(scene, 120), 620, 0.001);
  EXPECT_EQ(import_timeout_s(folder / "missing/scene.json", 120), 120);
}

TEST(ImportProcess, LeavesNothingBehind) {
  const TempDir scratch;
  ImportLimits in = limits();
  in.scratch = scratch.path();
  {
    auto imported = import_in_process(std::string(BANDSAW_GALLERY) + "/cornell.textproto", in);
    ASSERT_TRUE(imported.ok()) << imported.status();
    EXPECT_EQ(entries(scratch.path()), 1u);
    ImportedPackage moved = *std::move(imported);
    EXPECT_TRUE(decode_package(moved.manifest(), moved.blobs()).ok());
  }
  EXPECT_EQ(entries(scratch.path()), 0u);
  EXPECT_FALSE(import_in_process("/no/such.glb", in).ok());
  EXPECT_EQ(entries(scratch.path()), 0u);
}

/// Writes a glTF file with two triangles, and returns its path. The node of the first triangle
/// moves, and a morph target deforms the second triangle.
std::string moving_model(const TempDir& folder) {
  test::GltfWriter file;
  file.attributes() = {{"POSITION", file.add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, 3)}};
  file.root["meshes"].push_back(file.root["meshes"][0]);
  file.root["meshes"][1]["primitives"][0]["targets"] =
      test::Json::array({{{"POSITION", file.add<float>({0, 0, 0, 4, 0, 0, 0, 0, 0}, 3)}}});
  file.root["nodes"] = test::Json::parse(R"([{"mesh": 0}, {"mesh": 1}])");
  file.root["scenes"][0]["nodes"] = {0, 1};
  const std::size_t times = file.add<float>({0, 1}, 1);
  file.root["animations"] = test::Json::array();
  file.root["animations"].push_back(
      {{"name", "walk"},
       {"channels",
        {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}},
         {{"sampler", 1}, {"target", {{"node", 1}, {"path", "weights"}}}}}},
       {"samplers",
        {{{"input", times}, {"output", file.add<float>({0, 0, 0, 9, 0, 0}, 3)}},
         {{"input", times}, {"output", file.add<float>({0, 1}, 1)}}}}});
  return file.write(folder, "walk.gltf");
}

TEST(ImportSession, AFrameHasTheBytesOfAnImportInANewProcess) {
  const TempDir folder;
  const TempDir scratch;
  ImportLimits in = limits();
  in.scratch = scratch.path();
  const std::string path = moving_model(folder);
  {
    const auto session = ImportSession::start(path, in, {});
    ASSERT_TRUE(session.ok()) << session.status();
    for (const std::int64_t frame : {3, 7, 7, 20}) {
      auto package = (*session)->import(frame, /*stop=*/nullptr);
      ASSERT_TRUE(package.ok()) << package.status();
      const auto alone = import_in_process(path, limits(), {.frame = frame});
      ASSERT_TRUE(alone.ok()) << alone.status();
      EXPECT_EQ(package->manifest(), alone->manifest());
      EXPECT_TRUE(decode_package(package->manifest(), package->blobs()).ok());
      // The folder has nothing of earlier frames: only the manifest and its blobs.
      const auto kept = std::filesystem::directory_iterator(scratch.path())->path().string();
      EXPECT_EQ(entries(kept), 1 + package_blobs(package->manifest())->size());
    }
    EXPECT_EQ(entries(scratch.path()), 1u);
  }
  EXPECT_EQ(entries(scratch.path()), 0u);
}

TEST(ImportSession, TellsWhyAFrameCannotBeImported) {
  const TempDir folder;
  const std::string path = moving_model(folder);
  const auto session = *ImportSession::start(path, limits(), {.animation = "run"});
  EXPECT_THAT(std::string(session->import(1, /*stop=*/nullptr).status().message()),
              HasSubstr("walk.gltf: has no animation \"run\""));
  const auto stopped = *ImportSession::start(path, limits(), {});
  const std::atomic<bool> stop{true};
  EXPECT_EQ(stopped->import(1, &stop).status().code(), absl::StatusCode::kCancelled);
  ImportLimits hurried = limits();
  hurried.seconds = 0;
  EXPECT_EQ((*ImportSession::start(path, hurried, {}))->import(1, /*stop=*/nullptr).status().code(),
            absl::StatusCode::kDeadlineExceeded);
  ImportLimits broken = limits();
  broken.program = "/bin/true";  // ends without an answer
  EXPECT_EQ((*ImportSession::start(path, broken, {}))->import(1, /*stop=*/nullptr).status().code(),
            absl::StatusCode::kInternal);
  EXPECT_EQ(ImportSession::start("no.zip", limits(), {}).status().code(),
            absl::StatusCode::kNotFound);
}

TEST(ImportProcess, ReadsAnEnvironmentFromAnyFolder) {
  const std::string scene = std::string(BANDSAW_GALLERY) + "/cornell.textproto";
  const TempDir elsewhere;
  std::filesystem::copy_file(std::string(BANDSAW_GALLERY) + "/evening.hdr", elsewhere / "e.hdr");
  auto imported = import_in_process(scene, limits(), {.environment = elsewhere / "e.hdr"});
  ASSERT_TRUE(imported.ok()) << imported.status();
  const auto decoded = decode_package(imported->manifest(), imported->blobs());
  ASSERT_TRUE(decoded.ok()) << decoded.status();
  EXPECT_TRUE(decoded->background.environment.has_value());
  EXPECT_EQ(
      import_in_process(scene, limits(), {.environment = elsewhere / "none.hdr"}).status().code(),
      absl::StatusCode::kNotFound);
}

TEST(ImportProcess, UsesTheRequestedCamera) {
  const std::string model = std::string(BANDSAW_GALLERY) + "/pergola.gltf";
  auto imported = import_in_process(model, limits(), {.camera = "plan"});
  ASSERT_TRUE(imported.ok()) << imported.status();
  const auto decoded = decode_package(imported->manifest(), imported->blobs());
  ASSERT_TRUE(decoded.ok()) << decoded.status();
  EXPECT_TRUE(std::holds_alternative<OrthographicCamera>(decoded->camera));
  EXPECT_THAT(imported->info().model_cameras, ::testing::ElementsAre("gate", "corner", "plan"));
  EXPECT_EQ(import_in_process(model, limits(), {.camera = "walker"}).status().message(),
            "pergola.gltf: several cameras are called \"walker\"; there are \"gate\", \"corner\", "
            "\"plan\"");
}

TEST(ImportProcess, ForwardsTheImportersError) {
  const TempDir folder;
  const auto wrong =
      import_in_process(write_text(folder, "s.textproto", "\n camera { fov: 3 }"), limits());
  EXPECT_EQ(wrong.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(wrong.status().message()),
              StartsWith("s.textproto:2:11: unknown field \"fov\" in Camera"));
  EXPECT_EQ(import_in_process(folder / "no.glb", limits()).status().code(),
            absl::StatusCode::kNotFound);
  EXPECT_FALSE(import_in_process(folder.path(), limits()).ok());
}

// The importer unpacks an archive and writes a list of the files. In such a list, a line may be
// "made NAME" for a file that the importer wrote, but not "found NAME" for a file that existed
// before. A hostile archive may have taken control of the importer, so the list is checked.
TEST(ImportProcess, AnArchivesListWithAFileThatTheImporterDidNotWriteIsRefused) {
  const TempDir folder;
  const std::string program =
      write_text(folder, "importer.sh", "#!/bin/sh\necho 'found s.textproto' > \"$3/list\"\n");
  ASSERT_EQ(chmod(program.c_str(), 0700), 0);
  ImportLimits in;
  in.program = program;
  const auto imported = import_in_process(folder / "a.zip", in);
  EXPECT_EQ(imported.status().code(), absl::StatusCode::kDataLoss) << imported.status();
  EXPECT_EQ(imported.status().message(), "a.zip: the importer left a broken list of files");
}

/// Imports an archive that has these files (`names`, separated by spaces), with a script as the
/// importer. Returns "reads" and the name of the file that is chosen as the scene, or the error.
std::string choice_among(const std::string& names) {
  const TempDir folder;
  const std::string program =
      write_text(folder, "importer.sh",
                 "#!/bin/sh\nif [ \"$1\" != unzip ]; then\n"
                 "  echo \"INVALID_ARGUMENT: reads ${2##*/}\"\n  exit 1\nfi\n"
                 "i=0\nfor name in " +
                     names +
                     "; do\n  echo \"made $name\" >> \"$3/list\"\n"
                     "  : > \"$3/$i\"\n  i=$((i + 1))\ndone\n");
  EXPECT_EQ(chmod(program.c_str(), 0700), 0);
  ImportLimits in;
  in.program = program;
  return std::string(import_in_process(folder / "a.zip", in).status().message());
}

TEST(ImportProcess, ChoosesTheSceneOfAnArchive) {
  EXPECT_EQ(choice_among("a.obj s.json b.obj"), "reads s.json");
  EXPECT_EQ(choice_among("a.glb info.json"), "reads a.glb");
  EXPECT_EQ(choice_among("parts.pbrt.gz s.pbrt"), "reads s.pbrt");
  EXPECT_EQ(choice_among("a.ply s.pbrt.gz"), "reads s.pbrt.gz");
  EXPECT_EQ(choice_among("s.json s.textproto"), "reads s.textproto");
  EXPECT_EQ(choice_among("models/a.obj b.obj"), "reads b.obj");
  EXPECT_EQ(choice_among("a.json b.json c.obj"),
            "a.zip: holds 2 scenes, a.json and b.json; name one of them");
  EXPECT_THAT(choice_among("a.txt"), HasSubstr("a.zip: holds no scene: .textproto, .json"));
}

TEST(ImportProcess, AMissingProgramIsAnError) {
  ImportLimits in;
  in.program = "/no/such/bandsaw-import";
  const auto imported = import_in_process("scene.textproto", in);
  EXPECT_EQ(imported.status().code(), absl::StatusCode::kFailedPrecondition);
  EXPECT_THAT(std::string(imported.status().message()), HasSubstr("/no/such/bandsaw-import"));
}

TEST(ImportProcess, EndsAfterTheTimeLimit) {
  ImportLimits in = limits();
  in.seconds = 0;
  const auto imported = import_in_process(std::string(BANDSAW_GALLERY) + "/mesh.textproto", in);
  EXPECT_EQ(imported.status().code(), absl::StatusCode::kDeadlineExceeded) << imported.status();
  EXPECT_THAT(std::string(imported.status().message()),
              StartsWith("mesh.textproto: reading it took longer than 0 s"));
}

TEST(ImportProcess, EndsWhenItIsStopped) {
  const std::atomic<bool> stop{true};
  ImportLimits in = limits();
  in.stop = &stop;
  const auto imported = import_in_process(std::string(BANDSAW_GALLERY) + "/mesh.textproto", in);
  EXPECT_EQ(imported.status().code(), absl::StatusCode::kCancelled) << imported.status();
}

TEST(ImportProcess, DoesNotBlockOnAPipe) {
  const TempDir folder;
  ASSERT_EQ(mkfifo((folder / "pipe.textproto").c_str(), 0600), 0);
  const auto imported = import_in_process(folder / "pipe.textproto", limits());
  EXPECT_EQ(imported.status().code(), absl::StatusCode::kInvalidArgument) << imported.status();
}

TEST(ImportProcess, AFileThatNeedsTooMuchMemoryIsAnError) {
  if (test::kSanitized) {
    GTEST_SKIP() << "a sanitizer wants more address space than the limit";
  }
  const TempDir folder;
  ImportLimits in = limits();
  in.memory_bytes = 256ull << 20;
  // The file has 20000 x 20000 grey texels, which are 400 MB. It is sparse, so it takes little disk
  // space. The decoded texels take 1.2 GB.
  const std::string path = write_text(folder, "sky.pgm", "P5 20000 20000 255\n");
  std::filesystem::resize_file(path, 400'000'019);
  const auto picture = read_image_in_process(path, in);
  EXPECT_EQ(picture.status().code(), absl::StatusCode::kResourceExhausted) << picture.status();
  EXPECT_THAT(std::string(picture.status().message()), StartsWith("sky.pgm: needs more memory"));
}

TEST(ImportProcess, AModelThatStatesTooManyVerticesIsAnError) {
  if (test::kSanitized) {
    GTEST_SKIP() << "a sanitizer wants more address space than the limit";
  }
  const TempDir folder;
  ImportLimits in = limits();
  in.memory_bytes = 1ull << 30;
  // 900 million vertices of 12 bytes.
  write_text(folder, "a.ply",
             "ply\nformat binary_little_endian 1.0\nelement vertex 900000000\nproperty float x\n"
             "property float y\nproperty float z\nelement face 1\n"
             "property list uchar int vertex_indices\nend_header\n1234");
  const std::string scene =
      write_text(folder, "s.pbrt", "WorldBegin\nShape \"plymesh\" \"string filename\" \"a.ply\"");
  const auto imported = import_in_process(scene, in);
  EXPECT_THAT(std::string(imported.status().message()),
              HasSubstr("a.ply: needs more memory than reading a file may take"));
}

TEST(ImportProcess, SurvivesEveryBrokenModelOfAssimp) {
  if (!test::have_test_models()) {
    GTEST_SKIP() << "needs the package assimp-testmodels";
  }
  ImportLimits in = limits();
  in.seconds = 20;
  in.memory_bytes = 2ull << 30;
  std::size_t models = 0;
  for (const std::string folder : {"invalid", "OBJ", "glTF2"}) {
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(test::test_model(folder))) {
      const std::string suffix = entry.path().extension();
      if (suffix != ".obj" && suffix != ".gltf" && suffix != ".glb") {
        continue;
      }
      ++models;
      auto imported = import_in_process(entry.path(), in);
      if (!imported.ok()) {
        EXPECT_THAT(std::string(imported.status().message()),
                    HasSubstr(entry.path().filename().string()));
        EXPECT_NE(imported.status().code(), absl::StatusCode::kDeadlineExceeded);
      } else {
        EXPECT_TRUE(decode_package(imported->manifest(), imported->blobs()).ok()) << entry.path();
      }
    }
  }
  EXPECT_GT(models, 30u);
}

TEST(ReadImageInProcess, GivesAPictureOrOneError) {
  const TempDir folder;
  const auto picture =
      read_image_in_process(write_text(folder, "p.ppm", test::small_ppm()), limits());
  ASSERT_TRUE(picture.ok()) << picture.status();
  EXPECT_EQ(picture->width, 2u);
  EXPECT_EQ(picture->at(1, 0), (Rgb{0, 1, 0}));
  EXPECT_EQ(picture->at(0, 1), (Rgb{0, 0, 1}));
  const auto broken = read_image_in_process(write_text(folder, "b.png", "no png"), limits());
  EXPECT_EQ(broken.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(broken.status().message()), HasSubstr("b.png: is not an image"));
}

TEST(RunChild, ReportsHowAChildEnded) {
  const auto run = [](const std::string& script) {
    return run_child({"/bin/sh", "-c", script}, /*seconds=*/20, /*stop=*/nullptr).value();
  };
  EXPECT_EQ(WEXITSTATUS(run("exit 3").wait_status), 3);
  EXPECT_EQ(run("echo said; echo thrown away >&2").output, "said\n");
  EXPECT_EQ(WTERMSIG(run("kill -SEGV $$").wait_status), SIGSEGV);
  EXPECT_EQ(run("head -c 1000000 /dev/zero").output.size(), 65536u);  // the maximum
  EXPECT_EQ(run_child({"/bin/sh", "-c", "exec sleep 1000"}, /*seconds=*/0.05, nullptr)->end,
            ChildOutcome::End::kTimedOut);
  EXPECT_FALSE(run_child({"/no/such/program"}, 1, nullptr).ok());
}

TEST(RunChild, AChildDoesNotIgnoreTheSignalsThatItsParentIgnores) {
  struct sigaction before {};
  struct sigaction ignore {};
  ignore.sa_handler = SIG_IGN;
  sigaction(SIGINT, &ignore, &before);
  const auto outcome = run_child({"/bin/sh", "-c", "kill -INT $$; exit 0"}, 20, nullptr);
  sigaction(SIGINT, &before, nullptr);
  ASSERT_TRUE(outcome.ok());
  EXPECT_TRUE(WIFSIGNALED(outcome->wait_status));
  EXPECT_EQ(WTERMSIG(outcome->wait_status), SIGINT);
}

}  // namespace
}  // namespace bandsaw::coordinator
