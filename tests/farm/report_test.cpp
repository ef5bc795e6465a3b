// The report, a JSON file that is written beside each image, does not depend on where the image was
// rendered, and its values can be reproduced.

#include <google/protobuf/struct.pb.h>
#include <google/protobuf/util/json_util.h>
#include <google/protobuf/util/message_differencer.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/farm/farm_processes.h"

namespace bandsaw::test {
namespace {

using google::protobuf::Struct;

Struct report(const std::string& path) {
  Struct out;
  const auto status = google::protobuf::util::JsonStringToMessage(file_bytes(path), &out);
  EXPECT_TRUE(status.ok()) << path << ": " << status.ToString();
  return out;
}

const Struct& section(const Struct& json, const std::string& name) {
  return json.fields().at(name).struct_value();
}

/// Returns the number `field` of the section `of`.
double number(const Struct& json, const std::string& of, const std::string& field) {
  return section(json, of).fields().at(field).number_value();
}

/// Removes the fields that depend on the machines, times and names. Also removes the course of the
/// error ("curve"), because a farm measures the error while some rows already have more samples
/// than others.
Struct comparable(Struct json) {
  for (const char* field : {"time", "machines", "outputs", "curve"}) {
    EXPECT_EQ(json.mutable_fields()->erase(field), 1u) << field;
  }
  return json;
}

class ReportOfAFarm : public testing::Test {
 protected:
  void submit(std::vector<std::string> with, const std::string& name) {
    std::vector<std::string> command = {"submit", kCornell, "--quiet", "-o", farm_.path(name)};
    command.insert(command.end(), with.begin(), with.end());
    expect_success(run(farm_.command(command)));
  }
  void render(std::vector<std::string> with, const std::string& name) {
    std::vector<std::string> command = {BANDSAW_BIN, "render", kCornell,
                                        "--quiet",   "-o",     farm_.path(name)};
    command.insert(command.end(), with.begin(), with.end());
    expect_success(run(command));
  }
  FarmProcesses farm_;
};

// A closed output pipe does not prevent the image from being written.
TEST(Render, WritesTheImageAlthoughTheReaderOfItsProgressHasEnded) {
  const TempDir folder;
  const std::string image = folder / "a.pfm";
  const std::string command = std::string(BANDSAW_BIN) + " render " + kCornell +
                              " --width 32 --samples 64 --json -o " + image + " | true";
  expect_success(run({"/bin/bash", "-o", "pipefail", "-c", command}));
  EXPECT_TRUE(std::filesystem::exists(image));
}

TEST_F(ReportOfAFarm, AgreesWithThatOfOneMachine) {
  farm_.add_worker("desk", 2);
  farm_.add_worker("laptop", 1);
  for (const std::vector<std::string>& stop :
       {std::vector<std::string>{"--samples", "72"}, {"--error", "20%"}}) {
    const std::vector<std::string> with = {"--width", "48", stop[0], stop[1]};
    render(with, "local.pfm");
    submit(with, "farm.pfm");
    const Struct local = report(farm_.path("local.json"));
    const Struct farm = report(farm_.path("farm.json"));
    EXPECT_TRUE(
        google::protobuf::util::MessageDifferencer::Equals(comparable(local), comparable(farm)))
        << local.ShortDebugString() << "\n"
        << farm.ShortDebugString();
    EXPECT_GT(number(local, "error", "relative_rmse"), 0);
    EXPECT_GT(number(local, "work", "rays"), 0);
    double samples = 0;
    const auto& workers = section(farm, "machines").fields().at("workers").list_value().values();
    for (const auto& worker : workers) {
      samples += worker.struct_value().fields().at("samples").number_value();
    }
    EXPECT_EQ(samples, number(farm, "work", "samples"))
        << "the samples of all workers must be all samples of the image";
  }
}

TEST_F(ReportOfAFarm, IsTheSameAfterARestart) {
  farm_.add_worker("desk", 1);
  submit({"--width", "32", "--samples", "32"}, "first.pfm");
  farm_.restart_coordinator();
  expect_success(run(farm_.command({"watch", "1", "--quiet", "-o", farm_.path("second.pfm")})));
  Struct first = report(farm_.path("first.json"));
  Struct second = report(farm_.path("second.json"));
  first.mutable_fields()->erase("outputs");
  second.mutable_fields()->erase("outputs");
  EXPECT_TRUE(google::protobuf::util::MessageDifferencer::Equals(first, second))
      << first.ShortDebugString() << "\n"
      << second.ShortDebugString();
}

// Two renders with --time need not give the same bytes. A render with the reported number of
// samples gives the same bytes.
TEST_F(ReportOfAFarm, TheSamplesOfATimeLimitGiveTheSameBytes) {
  farm_.add_worker("desk", 2);
  const std::vector<std::string> limited = {"--width", "64", "--time", "0.3s"};
  submit(limited, "farm.pfm");
  render(limited, "local.pfm");
  for (const char* name : {"farm", "local"}) {
    const std::string of = farm_.path(name);
    const auto samples =
        static_cast<int>(number(report(of + ".json"), "work", "samples_per_pixel"));
    ASSERT_GT(samples, 0);
    render({"--width", "64", "--samples", std::to_string(samples)}, "again.pfm");
    EXPECT_TRUE(file_bytes(of + ".pfm") == file_bytes(farm_.path("again.pfm"))) << name;
    // If a pixel has only one block, which is 8 samples or fewer, the error must be unknown in both
    // reports.
    const auto error = [](const std::string& file) { return report(file).fields().at("error"); };
    EXPECT_TRUE(google::protobuf::util::MessageDifferencer::Equals(error(of + ".json"),
                                                                   error(farm_.path("again.json"))))
        << name;
  }
}

// The report of an image that is stitched from two parts equals the report of the whole image.
TEST(ReportOfParts, EqualsThatOfTheWholeExceptForUnknownFields) {
  const TempDir folder;
  const auto path = [&](const char* name) { return folder / name; };
  const std::vector<std::string> with = {"--width", "32", "--samples", "72", "--quiet"};
  const auto render = [&](std::vector<std::string> command) {
    command.insert(command.begin(), {BANDSAW_BIN, "render", kCornell});
    command.insert(command.end(), with.begin(), with.end());
    expect_success(run(command));
  };
  render({"-o", path("whole.pfm")});
  render({"--rows", "0:20", "-o", path("top.band")});
  render({"--rows", "20:32", "-o", path("bottom.band")});
  expect_success(run(
      {BANDSAW_BIN, "stitch", path("top.band"), path("bottom.band"), "-o", path("stitched.pfm")}));
  const Struct whole = report(path("whole.json"));
  const Struct stitched = report(path("stitched.json"));
  for (const char* same : {"settings", "error", "work", "hashes", "health"}) {
    EXPECT_TRUE(google::protobuf::util::MessageDifferencer::Equals(section(whole, same),
                                                                   section(stitched, same)))
        << same;
  }
  // In the report of a part the error is unknown.
  EXPECT_TRUE(report(path("top.json")).fields().at("error").has_null_value());
}

// EXR files of 16-bit numbers clip values above 65,504. The lamp's red is above that. The lamp
// covers the middle of the image, so both parts have some of its pixels.
TEST(ReportOfParts, CountsTheValuesThatAreClipped) {
  const TempDir folder;
  std::ofstream(folder / "lamp.textproto") << R"(
camera { position: [0, 0, 5] look_at: [0, 0, 0] vertical_fov: 40 }
image { width: 16 height: 16 }
material { name: "lamp" emissive { radiance { rgb: [1e6, 2, 0.5] } } }
shape { quad { corner: [-1, -1, 0] u: [2, 0, 0] v: [0, 2, 0] } material: "lamp" }
)";
  const auto clipped = [&](const std::string& name, const std::vector<std::string>& with) {
    std::vector<std::string> command = {BANDSAW_BIN, "render", folder / "lamp.textproto",
                                        "--quiet",   "--half", "--samples",
                                        "16",        "-o",     folder / (name + ".exr")};
    command.insert(command.end(), with.begin(), with.end());
    expect_success(run(command));
    return number(report(folder / (name + ".json")), "health", "cut_off_values");
  };
  const double top = clipped("top", {"--rows", "0:8"});
  const double bottom = clipped("bottom", {"--rows", "8:16"});
  EXPECT_GT(top, 0);
  EXPECT_GT(bottom, 0);
  EXPECT_EQ(top + bottom, clipped("whole", {}));
}

TEST(ReportFile, ASceneFileIsNotReplacedByTheReport) {
  const TempDir folder;
  std::filesystem::copy(kCornell, folder / "a.textproto");
  expect_success(run({BANDSAW_BIN, "render", folder / "a.textproto", "--width", "8", "--samples",
                      "1", "--quiet", "--report", "none", "-o", folder / "a.png"}));
  EXPECT_FALSE(std::filesystem::exists(folder / "a.json"));
  std::filesystem::copy(kCornell, folder / "a.json");
  const Finished refused =
      run({BANDSAW_BIN, "render", kCornell, "--report", folder / "a.json", "-o", folder / "b.png"});
  EXPECT_EQ(refused.code, 2);
  EXPECT_FALSE(std::filesystem::exists(folder / "b.png"));
  EXPECT_EQ(file_bytes(folder / "a.json"), file_bytes(kCornell));
}

}  // namespace
}  // namespace bandsaw::test
