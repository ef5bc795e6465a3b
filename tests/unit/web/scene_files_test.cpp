// The requests of the Python module and the Blender add-on (deploy/python): scenes whose files are
// sent one by one, images as floats, and layers such as depth or normals.

#include <gmock/gmock.h>

#include <atomic>
#include <cstring>
#include <utility>

#include "absl/strings/str_cat.h"
#include "tests/unit/web/web_farm.h"

namespace bandsaw::coordinator {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string hex_of(const std::string& bytes) { return wire::sha256(bytes).hex(); }

/// Returns a file in the form of the body of /api/files: digest, size, and contents.
std::string sent(const std::string& bytes) {
  return absl::StrCat(hex_of(bytes), " ", bytes.size(), "\n", bytes);
}

class SceneFilesTest : public WebTest {
 protected:
  SceneFilesTest() { log_in(); }
  std::string error_of(const Answer& result) { return message<web::Problem>(result).error(); }
  /// Asks for files by their digests. Returns the digests of the files that the coordinator lacks.
  std::vector<std::string> missing(const std::vector<std::string>& hex) {
    web::FileDigests asked;
    asked.mutable_sha256()->Assign(hex.begin(), hex.end());
    std::string list;
    for (const std::string& one : hex) {
      absl::StrAppend(&list, list.empty() ? "" : ",", "\"", one, "\"");
    }
    const auto found =
        message<web::FileDigests>(post("/api/files/missing", "{\"sha256\": [" + list + "]}"));
    return {found.sha256().begin(), found.sha256().end()};
  }
  /// Returns the body of a request that submits a scene of one file.
  std::string scene(const std::string& name, const std::string& hex) {
    return absl::StrCat("{\"scene\": \"", name, "\", \"file\": [{\"name\": \"", name,
                        "\", \"sha256\": \"", hex, "\"}]}");
  }
};

TEST_F(SceneFilesTest, AFileIsMissingUntilItIsSent) {
  const std::string box = "a box";
  const std::string empty;
  EXPECT_THAT(missing({hex_of(box), hex_of(empty)}), ElementsAre(hex_of(box), hex_of(empty)));
  const auto taken = message<web::FileDigests>(post("/api/files", sent(box) + sent(empty)));
  EXPECT_THAT(taken.sha256(), ElementsAre(hex_of(box), hex_of(empty)));
  EXPECT_THAT(missing({hex_of(box), hex_of(empty)}), ElementsAre());
  EXPECT_EQ(post("/api/files", sent(box))->status, 200) << "sending a file again must succeed";
}

TEST_F(SceneFilesTest, ASceneOfSentFilesBecomesAJob) {
  const std::string box = "a box";
  ASSERT_EQ(post("/api/files", sent(box))->status, 200);
  const auto submitted = message<web::Submitted>(
      post("/api/scenes/files?width=48&samples=32&title=walk%201", scene("box.json", hex_of(box))));
  EXPECT_EQ(submitted.job(), 1u);
  const auto job = message<web::JobPage>(get("/api/jobs/1")).job().status();
  EXPECT_EQ(job.name(), "walk 1");
  EXPECT_EQ(job.settings().width(), 48u);
  EXPECT_EQ(job.stop().samples(), 32u);
}

// Clients repeat the request after 503, but not after 429, the status of a full disk.
TEST_F(SceneFilesTest, TheThirdSceneAtATimeIsRefusedWith503) {
  const std::string box = "a box";
  const std::string body = scene("box.json", hex_of(box));
  std::atomic<int> refused{0};
  options_.import_scene = [&, read = options_.import_scene](const std::string& path,
                                                            const std::string& inside,
                                                            const std::atomic<bool>& stop) {
    // Each import submits another scene while it runs, so three scenes are submitted at a time.
    if (const int status = post("/api/scenes/files", body)->status; status != 200) {
      refused = status;
    }
    return read(path, inside, stop);
  };
  start_dashboard();
  headers_.erase("Cookie");
  log_in();
  ASSERT_EQ(post("/api/files", sent(box))->status, 200);
  EXPECT_EQ(post("/api/scenes/files", body)->status, 200);
  EXPECT_EQ(refused, 503);
}

// A name of a job has at most 200 bytes. A client cannot parse a list of jobs with a name that is
// not UTF-8.
TEST_F(SceneFilesTest, ATitleIsCleanedAndCutBetweenCharacters) {
  const std::string box = "a box";
  ASSERT_EQ(post("/api/files", sent(box))->status, 200);
  const std::string body = scene("box.json", hex_of(box));
  const std::string prefix(199, 'x');
  post("/api/scenes/files?title=" + prefix + "%C3%A9", body);  // 201 bytes, the last two are an é
  post("/api/scenes/files?title=ok%0A%1B%5B31m%FF", body);
  for (const auto& [job, name] : {std::pair(1, prefix), std::pair(2, std::string("ok??[31m?"))}) {
    const std::string path = absl::StrCat("/api/jobs/", job);
    EXPECT_EQ(message<web::JobPage>(get(path)).job().status().name(), name);
  }
}

TEST_F(SceneFilesTest, ASceneMayHaveATimeLimit) {
  const std::string box = "a box";
  ASSERT_EQ(post("/api/files", sent(box))->status, 200);
  post("/api/scenes/files?time=60", scene("box.json", hex_of(box)));
  EXPECT_EQ(message<web::JobPage>(get("/api/jobs/1")).job().status().stop().time_s(), 60);
  EXPECT_THAT(error_of(post("/api/scenes/files?time=-1", scene("box.json", hex_of(box)))),
              HasSubstr("time"));
}

TEST_F(SceneFilesTest, WrongFilesAreRefused) {
  const std::string box = "a box";
  EXPECT_THAT(error_of(post("/api/files", "no digest 5\nxxxxx")), HasSubstr("SHA256 SIZE"));
  EXPECT_THAT(error_of(post("/api/files", std::string(200, 'a'))), HasSubstr("SHA256 SIZE"));
  EXPECT_THAT(error_of(post("/api/files", hex_of(box) + " 100\na box")), HasSubstr("ends within"));
  EXPECT_NE(post("/api/files", hex_of("another") + " 5\na box")->status, 200);
  EXPECT_THAT(error_of(post("/api/files", hex_of(box) + " 99999999999\n")), HasSubstr("at most"));
  EXPECT_THAT(missing({hex_of(box), hex_of("another")}),
              ElementsAre(hex_of(box), hex_of("another")));
}

TEST_F(SceneFilesTest, AFileMayHaveEveryNameThatStaysWithinTheFolder) {
  const std::string box = "a box";
  ASSERT_EQ(post("/api/files", sent(box))->status, 200);
  for (const std::string name : {"Karl's box [1] & more!.json", "{a};b=$c%20^`.json", ".a/.b.json",
                                 "..a/b...json", "Größe 世界.json"}) {
    const auto submitted = post("/api/scenes/files", scene(name, hex_of(box)));
    ASSERT_TRUE(submitted);
    EXPECT_EQ(submitted->status, 200) << name << ": " << submitted->body;
  }
}

TEST_F(SceneFilesTest, WrongScenesAreRefused) {
  const std::string box = "a box";
  const auto absent = post("/api/scenes/files", scene("box.json", hex_of(box)));
  ASSERT_TRUE(absent);
  EXPECT_EQ(absent->status, 409);
  EXPECT_THAT(error_of(absent), HasSubstr("send it again"));
  ASSERT_EQ(post("/api/files", sent(box) + sent("broken"))->status, 200);
  // The last three names contain a backslash and the control characters 1 and 0x9b.
  for (const std::string name : {"../box.json", "/etc/box.json", "a/../b", "..", "./b", "a//b", "",
                                 R"(a\\b)", R"(a\u0001b)", R"(a\u009bb)"}) {
    EXPECT_THAT(error_of(post("/api/scenes/files", scene(name, hex_of(box)))),
                HasSubstr("is not a file name"))
        << name;
  }
  EXPECT_THAT(error_of(post("/api/scenes/files", "{\"scene\": \"box.json\"}")),
              HasSubstr("scene: must be the name of one of the files"));
  EXPECT_THAT(error_of(post("/api/scenes/files", scene("a.json", hex_of("broken")))),
              HasSubstr("1:1: it is broken"));
  EXPECT_EQ(message<web::Overview>(get("/api/farm")).job_size(), 0);
}

TEST_F(SceneFilesTest, OnlyUsersMaySendFiles) {
  headers_ = {{"X-Bandsaw", "1"}};
  for (const std::string path : {"/api/files", "/api/files/missing", "/api/scenes/files"}) {
    EXPECT_EQ(post(path)->status, 401) << path;
  }
}

TEST_F(SceneFilesTest, PicturesAreAvailableAsFloats) {
  const std::uint64_t job = submit_box();
  const std::string path = absl::StrCat("/api/jobs/", job);
  EXPECT_EQ(get(path + "/preview.pfm")->status, 404) << "the job has no pixels yet";
  finish(job, 24, 16);
  for (const std::string name : {"/preview.pfm?side=64", "/image.pfm"}) {
    const auto got = get(path + name);
    ASSERT_TRUE(got);
    EXPECT_EQ(got->header("Content-Type"), "image/x-portable-floatmap");
    EXPECT_THAT(got->body, StartsWith("PF\n24 16\n-1"));
    float first = 0;
    const std::size_t pixels = std::size_t{24} * 16 * 3 * sizeof(float);
    ASSERT_GT(got->body.size(), pixels);
    std::memcpy(&first, got->body.data() + got->body.size() - pixels, sizeof(first));
    EXPECT_EQ(first, 0.5F) << "the mean of 64 samples with a sum of 32";
  }
}

TEST_F(SceneFilesTest, ALayerIsAJobOfTheSameScene) {
  const std::uint64_t job = submit_box();
  const std::string path = absl::StrCat("/api/jobs/", job, "/layer");
  const auto layer = message<web::Submitted>(post(path + "?kind=normals&samples=4"));
  const auto status =
      message<web::JobPage>(get(absl::StrCat("/api/jobs/", layer.job()))).job().status();
  EXPECT_EQ(status.name(), "box (normals)");
  EXPECT_EQ(status.settings().width(), 24u);
  EXPECT_EQ(status.stop().samples(), 4u);
  EXPECT_THAT(error_of(post(path + "?kind=sounds")), HasSubstr("kind"));
  EXPECT_THAT(error_of(post(path + "?kind=depth&samples=65")), HasSubstr("samples"));
  EXPECT_EQ(post("/api/jobs/99/layer?kind=depth")->status, 404);
}

// The name and " (normals)" together have at most 200 bytes.
TEST_F(SceneFilesTest, ALayerOfAJobWithALongNameHasAShorterName) {
  const std::string title(200, 'x');
  post("/api/scenes?name=box.textproto&title=" + title, "a box");
  const auto layer = message<web::Submitted>(post("/api/jobs/1/layer?kind=normals"));
  EXPECT_EQ(layer.job(), 2u);
  EXPECT_EQ(message<web::JobPage>(get("/api/jobs/2")).job().status().name(),
            std::string(190, 'x') + " (normals)");
}

// Everybody who can reach the port may download the add-on and the Python module, because they hold
// no secret.
TEST_F(SceneFilesTest, TheAddOnAndTheModuleAreOffered) {
  headers_.clear();
  const auto zip = get("/bandsaw_blender.zip");
  ASSERT_TRUE(zip);
  EXPECT_EQ(zip->header("Content-Type"), "application/zip");
  EXPECT_THAT(zip->body, StartsWith("PK"));
  EXPECT_THAT(zip->body, HasSubstr("bandsaw_blender/__init__.py"));
  EXPECT_THAT(zip->body, HasSubstr("bandsaw_blender/bandsaw.py"));
  EXPECT_THAT(get("/bandsaw.py")->body, HasSubstr("class Farm"));
}

}  // namespace
}  // namespace bandsaw::coordinator
