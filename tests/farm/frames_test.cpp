// A job of many frames on real farms. Each frame has the bytes of `render --frame`, and no frame is
// rendered twice or lost, even if a worker, the coordinator or the submitter is killed.

#include <gmock/gmock.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "tests/farm/farm_processes.h"

namespace bandsaw::test {
namespace {

using testing::HasSubstr;
using testing::Not;

/// A glTF file with a triangle that moves to the right for two seconds, before a camera.
std::string moving_triangle() {
  const std::vector<float> values = {-1, 0, 0, 1, 0, 0, 0, 1.5f, 0,  // positions
                                     0,  2,                          // times
                                     0,  0, 0, 2, 0, 0};             // translations
  const std::string bytes(reinterpret_cast<const char*>(values.data()),
                          values.size() * sizeof(float));
  return absl::StrCat(R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1]}],
"nodes":[{"mesh":0,"name":"it"},{"camera":0,"translation":[0,0.5,5]}],
"cameras":[{"type":"perspective","perspective":{"yfov":0.8,"znear":0.1}}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
"animations":[{"name":"walk","channels":[{"sampler":0,"target":{"node":0,"path":"translation"}}],
"samplers":[{"input":1,"output":2}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[-1,0,0],"max":[1,1.5,0]},
{"bufferView":1,"componentType":5126,"count":2,"type":"SCALAR","min":[0],"max":[2]},
{"bufferView":2,"componentType":5126,"count":2,"type":"VEC3"}],
"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":8},
{"buffer":0,"byteOffset":44,"byteLength":24}],
"buffers":[{"byteLength":68,"uri":"data:application/octet-stream;base64,)",
                      absl::Base64Escape(bytes), "\"}]}");
}

class Frames : public testing::Test {
 protected:
  void SetUp() override { std::ofstream(scene_) << moving_triangle(); }

  std::vector<std::string> settings() const {
    return {"--width",   std::to_string(size_),
            "--height",  std::to_string(size_),
            "--samples", samples_,
            "--fps",     "12",
            "--shutter", "0.5"};
  }
  /// Returns the command line that submits these frames.
  std::vector<std::string> submit(const std::string& frames, std::vector<std::string> more = {}) {
    std::vector<std::string> arguments = {"submit", scene_, "--frames", frames, "--json"};
    const std::vector<std::string> chosen = settings();
    arguments.insert(arguments.end(), chosen.begin(), chosen.end());
    arguments.insert(arguments.end(), more.begin(), more.end());
    return farm_.command(arguments);
  }
  /// Returns the command line that runs `argv` in the farm's folder.
  std::vector<std::string> in_the_folder(const std::vector<std::string>& argv) const {
    std::vector<std::string> out = {"/bin/sh", "-c", "cd \"$0\" && exec \"$@\"", farm_.path(".")};
    out.insert(out.end(), argv.begin(), argv.end());
    return out;
  }
  std::string file_of(int frame) const { return farm_.path(absl::StrFormat("w.%04d.pfm", frame)); }

  /// Expects that the file of the frame has the bytes of `render --frame`.
  void expect_bytes_of_render(int frame, const std::vector<std::string>& more = {}) {
    render_alone(frame, more);
    EXPECT_TRUE(file_bytes(file_of(frame)) == file_bytes(farm_.path("alone.pfm")))
        << "frame " << frame;
  }

  /// Renders a frame on this machine, to alone.pfm.
  void render_alone(int frame, const std::vector<std::string>& more = {}) {
    const std::string file = farm_.path("alone.pfm");
    std::vector<std::string> argv = {BANDSAW_BIN,           "render", scene_, "--frame",
                                     std::to_string(frame), "-o",     file,   "--quiet"};
    const std::vector<std::string> chosen = settings();
    argv.insert(argv.end(), chosen.begin(), chosen.end());
    argv.insert(argv.end(), more.begin(), more.end());
    const Finished finished = run(argv);
    ASSERT_EQ(finished.code, 0) << finished.err;
  }

  /// Waits until `count` frames are written. Returns false if the client ended before that, or the
  /// time expired.
  static bool wait_for_frames(Process& client, std::size_t count) {
    return client.wait_until([&](const std::string& out, const std::string&) {
      std::size_t found = 0;
      for (std::size_t at = out.find("\"event\":\"frame\""); at != std::string::npos;
           at = out.find("\"event\":\"frame\"", at + 1)) {
        ++found;
      }
      return found >= count;
    });
  }

  /// Returns how many jobs each frame had, from the coordinator's log.
  std::map<std::string, int> jobs_of_frames() const {
    std::map<std::string, int> jobs;
    const std::string log = farm_.coordinator_log();
    const std::regex line("added name=.* frame=(-?[0-9]+) of=");
    for (std::sregex_iterator found(log.begin(), log.end(), line), end; found != end; ++found) {
      ++jobs[(*found)[1]];
    }
    return jobs;
  }

  FarmProcesses farm_;
  const std::string scene_ = farm_.path("walk.gltf");
  const std::string outputs_ = farm_.path("w.####.pfm");
  int size_ = 24;  ///< width and height, pixels
  std::string samples_ = "16";
};

TEST_F(Frames, HaveTheBytesOfRenderThoughAWorkerAndTheCoordinatorAreKilled) {
  samples_ = "1024";  // so that frames are left when the coordinator is killed
  for (const char* name : {"one", "two", "three"}) {
    farm_.add_worker(name, 1);
  }
  Process client = Process::start(submit("1:12", {"-o", outputs_}));
  ASSERT_TRUE(wait_for_frames(client, 2)) << client.err();
  farm_.worker("two").signal(SIGKILL);
  ASSERT_TRUE(wait_for_frames(client, 4)) << client.err();
  farm_.coordinator().signal(SIGKILL);
  ASSERT_EQ(farm_.coordinator().wait(), 128 + SIGKILL);
  farm_.restart_coordinator();
  ASSERT_EQ(client.wait(), 0) << client.err() << farm_.coordinator_log();
  for (int frame = 1; frame <= 12; ++frame) {
    expect_bytes_of_render(frame);
    EXPECT_TRUE(std::filesystem::exists(farm_.path(absl::StrFormat("w.%04d.json", frame))));
  }
  const std::map<std::string, int> jobs = jobs_of_frames();
  EXPECT_EQ(jobs.size(), 12u);
  for (const auto& [frame, times] : jobs) {
    EXPECT_EQ(times, 1) << "frame " << frame;
  }
  const Finished listed = run(farm_.command({"jobs"}));
  EXPECT_THAT(listed.out, HasSubstr("12 of 12 frames"));
  // The list has a header and one line for all frames.
  EXPECT_EQ(std::count(listed.out.begin(), listed.out.end(), '\n'), 2) << listed.out;
  EXPECT_THAT(run(farm_.command({"missing", "1"})).out, HasSubstr("no frame is missing"));
}

TEST_F(Frames, AreSentAgainAfterTheirSubmitterWasKilled) {
  Process client = Process::start(submit("1,3,5-20", {"-o", outputs_, "--fixed-seed"}));
  // There is no worker, so no frame is rendered before the submitter is killed.
  ASSERT_TRUE(client.wait_for("\"event\":\"job\"")) << client.err();
  client.signal(SIGKILL);
  client.wait();
  farm_.add_worker("one", 2);
  const Finished other = run(submit("1-20", {"-o", outputs_, "--fixed-seed", "--continue", "1"}));
  EXPECT_EQ(other.code, 2) << other.err;
  EXPECT_THAT(other.err, HasSubstr("the frames of job 1 are 1,3,5-20"));
  const Finished again =
      run(submit("1,3,5-20", {"-o", outputs_, "--fixed-seed", "--continue", "1", "--then",
                              "cp \"$BANDSAW_FILE_LIST\" " + farm_.path("list") +
                                  "; echo job $BANDSAW_JOB is $BANDSAW_STATE: $BANDSAW_FILES"}));
  ASSERT_EQ(again.code, 0) << again.err;
  EXPECT_THAT(again.err, HasSubstr("job 1 is done: " + outputs_));
  EXPECT_THAT(file_bytes(farm_.path("list")), HasSubstr(file_of(20) + "\n"));
  for (const int frame : {1, 3, 20}) {
    expect_bytes_of_render(frame, {"--fixed-seed"});
  }
  EXPECT_EQ(jobs_of_frames().size(), 18u);  // the frames 1, 3 and 5 to 20
}

TEST_F(Frames, FramesWithoutAnOutputNameDoNotReplaceFilesOfTheModel) {
  farm_.add_worker("one", 1);
  std::ofstream(farm_.path("walk.0002.png")) << "a texture";
  const Finished refused = run(in_the_folder(submit("1-3")));
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err, HasSubstr("walk.0002.png: exists and may belong to the model"));
  EXPECT_EQ(file_bytes(farm_.path("walk.0002.png")), "a texture");
  EXPECT_THAT(run(farm_.command({"jobs"})).out, HasSubstr("no jobs"));
}

TEST_F(Frames, UnsentFramesAreNamedIfAFileCannotBeWritten) {
  farm_.add_worker("one", 1);
  std::filesystem::create_directory(file_of(1));
  // There are so many frames that most of them are not sent when the first one is done.
  const Finished failed = run(submit("1-2000", {"-o", outputs_}));
  EXPECT_EQ(failed.code, 1);
  EXPECT_THAT(failed.err, HasSubstr("w.0001.pfm"));
  EXPECT_THAT(failed.err, HasSubstr("-2000 were not sent"));
  EXPECT_THAT(failed.err, HasSubstr("--continue 1"));
}

// The farm has no worker. When the job is cancelled, most of its many frames are not sent yet.
TEST_F(Frames, AreNotSentAnyMoreWhenTheJobIsCancelled) {
  Process client = Process::start(
      submit("1-2000", {"-o", outputs_, "--then", "echo job $BANDSAW_JOB is $BANDSAW_STATE"}));
  ASSERT_TRUE(client.wait_for("\"event\":\"job\"")) << client.err();
  expect_success(run(farm_.command({"cancel", "1"})));
  EXPECT_EQ(client.wait(), 1);
  EXPECT_THAT(client.out(), HasSubstr("\"event\":\"ended\""));
  EXPECT_THAT(client.err(), HasSubstr("job 1 cancelled"));
  EXPECT_THAT(client.err(), HasSubstr("job 1 is cancelled"));  // printed by --then
  EXPECT_THAT(client.err(), Not(HasSubstr("were not sent")));
}

TEST_F(Frames, AreNotSentAnyMoreWhenTheJobOfADetachedSubmitterIsCancelled) {
  Process client = Process::start(submit("1-2000", {"--detach"}));
  ASSERT_TRUE(farm_.coordinator().wait_for("frames=2000")) << client.err();
  expect_success(run(farm_.command({"cancel", "1"})));
  EXPECT_EQ(client.wait(), 1);
  EXPECT_THAT(client.err(), HasSubstr("job 1 was cancelled"));
  EXPECT_THAT(client.err(), Not(HasSubstr("were not sent")));
}

TEST_F(Frames, AreNamedIfTheFirstSceneCannotBeSent) {
  const std::string blobs = farm_.path("data/blobs");
  std::filesystem::rename(blobs, farm_.path("away"));
  const Finished failed = run(submit("1-3", {"-o", outputs_}));
  EXPECT_EQ(failed.code, 1);
  EXPECT_THAT(failed.err, HasSubstr("1-3 were not sent"));
  EXPECT_THAT(failed.err, HasSubstr("--continue 1"));
  std::filesystem::rename(farm_.path("away"), blobs);
}

TEST_F(Frames, HaveAContactSheetAndAFailedCommandOrMissingFfmpegIsReported) {
  farm_.add_worker("one", 2);
  const std::string sheet = farm_.path("sheet.png");
  const Finished done =
      run(submit("1-4", {"-o", outputs_, "--contact-sheet", sheet, "--then", "exit 3"}));
  EXPECT_EQ(done.code, 1);
  EXPECT_THAT(done.err, HasSubstr("--then: the command failed with exit status 3"));
  EXPECT_TRUE(std::filesystem::exists(sheet));
  const Finished without =
      run(submit("1-4", {"-o", outputs_, "--video", farm_.path("w.mp4")}), {"PATH=/nowhere"});
  EXPECT_EQ(without.code, 1);
  EXPECT_THAT(without.err, HasSubstr("ffmpeg, which is not on PATH"));
}

TEST_F(Frames, AreFollowedByACommandWhoseOutputIsCompleteAndApartFromTheJson) {
  farm_.add_worker("one", 1);
  const Finished done = run(submit(
      "1", {"-o", outputs_, "--then", "echo it ran; head -c 200000 /dev/zero | tr '\\0' x"}));
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_EQ(done.out.find("it ran"), std::string::npos);
  EXPECT_THAT(done.err, HasSubstr("it ran\n" + std::string(200'000, 'x')));
  const Finished plain = run(farm_.command({"watch", "1", "--then", "echo it ran"}));
  EXPECT_THAT(plain.out, testing::EndsWith("it ran\n"));
}

TEST_F(Frames, AreFollowedByACommandThatASignalEnds) {
  farm_.add_worker("one", 1);
  const std::string temporary = farm_.path("tmp");
  std::filesystem::create_directory(temporary);
  Process client =
      Process::start(submit("1", {"-o", outputs_, "--then", "echo it began; exec sleep 1000"}),
                     {"TMPDIR=" + temporary});
  ASSERT_TRUE(client.wait_for("it began")) << client.err();
  client.signal(SIGTERM);
  EXPECT_EQ(client.wait(), 130) << client.err();
  EXPECT_THAT(client.err(), HasSubstr("--then: the command was interrupted"));
  EXPECT_TRUE(std::filesystem::is_empty(temporary));
}

TEST_F(Frames, AreDenoisedAsByRender) {
  farm_.add_worker("one", 1);
  farm_.add_worker("two", 1);
  const Finished done = run(submit("1-4", {"-o", outputs_, "--denoise"}));
  ASSERT_EQ(done.code, 0) << done.err;
  for (int frame = 1; frame <= 4; ++frame) {
    expect_bytes_of_render(frame, {"--denoise"});
    EXPECT_TRUE(file_bytes(farm_.path(absl::StrFormat("w.%04d.raw.pfm", frame))) ==
                file_bytes(farm_.path("alone.raw.pfm")));
    EXPECT_THAT(file_bytes(farm_.path(absl::StrFormat("w.%04d.json", frame))),
                HasSubstr("\"method\":\"regression\""));
  }
  // The farm still has the guides of the first submission, which are the images that the denoiser
  // needs.
  const Finished again =
      run(farm_.command({"watch", "1", "--denoise", "-o", farm_.path("again.####.pfm")}));
  ASSERT_EQ(again.code, 0) << again.err;
  EXPECT_TRUE(file_bytes(farm_.path("again.0003.pfm")) == file_bytes(file_of(3)));
  const Finished listed = run(farm_.command({"jobs"}));
  EXPECT_THAT(listed.out, HasSubstr("4 of 4 frames"));
  EXPECT_THAT(listed.out, HasSubstr("8 finished guide images for the denoiser"));
  // The list has a header, one line for all frames, and one line for their guides.
  EXPECT_EQ(std::count(listed.out.begin(), listed.out.end(), '\n'), 3) << listed.out;
}

TEST_F(Frames, FramesOfOneSampleAreNotCleaned) {
  samples_ = "1";
  const Finished refused = run(submit("1-2", {"-o", outputs_, "--denoise"}));
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err, HasSubstr("take 2 samples or more"));
  EXPECT_THAT(run(farm_.command({"jobs"})).out, HasSubstr("no jobs"));
}

TEST_F(Frames, CanBeWrittenAsAVideo) {
  ASSERT_TRUE(std::filesystem::exists("/usr/bin/ffprobe"))
      << "ffprobe is missing: apt-get install ffmpeg";
  farm_.add_worker("one", 1);
  farm_.add_worker("two", 1);
  const std::string video = farm_.path("walk.mp4");
  const Finished done = run(submit("1-6", {"--video", video, "-o", outputs_}));
  ASSERT_EQ(done.code, 0) << done.err;
  const Finished probe =
      run({"/usr/bin/ffprobe", "-v", "error", "-count_frames", "-show_entries",
           "stream=codec_name,width,height,nb_read_frames,r_frame_rate", "-of", "csv=p=0", video});
  EXPECT_EQ(probe.out, "h264,24,24,12/1,6\n") << probe.err;
  // ffmpeg must not read the part of the name before the colon as a protocol.
  const Finished colon = run(in_the_folder(farm_.command({"watch", "1", "--video", "a:b.mp4"})));
  EXPECT_EQ(colon.code, 0) << colon.err;
  EXPECT_TRUE(std::filesystem::exists(farm_.path("a:b.mp4")));
  // Nothing half-written is left.
  for (const auto& entry : std::filesystem::directory_iterator(farm_.path("."))) {
    EXPECT_EQ(entry.path().filename().string().find(".part"), std::string::npos) << entry.path();
  }
}

}  // namespace
}  // namespace bandsaw::test
