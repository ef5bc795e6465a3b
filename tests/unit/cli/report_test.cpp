// The JSON report beside an image, and the rule that it never replaces another file.

#include "coordinator/cli/image/report.h"

#include <gmock/gmock.h>
#include <google/protobuf/struct.pb.h>
#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "coordinator/cli/image/report_file.h"
#include "tests/support/temp_dir.h"

namespace bandsaw::coordinator {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Returns the progress of a finished job that gives every field of the report a value.
Progress finished() {
  Progress progress;
  JobView& job = progress.job;
  job.id = 7;
  job.spec.name = "cor\"nell";
  job.spec.manifest = std::string(64, 'a');
  job.spec.settings = {.width = 6, .height = 4, .max_depth = 9, .seed = UINT64_MAX};
  job.spec.stop = StopAtError{.relative_rmse = 0.05};
  job.elapsed_s = 3;
  job.cpu_s = 4;
  job.samples_per_pixel = 64;
  job.samples_done = 64 * 24;
  job.counters = {.rays = 8'000'000,
                  .bad_samples = 5,
                  .negative_samples = 2,
                  .truncated_paths = 11,
                  .dropped_primitives = 4,
                  .techniques = Counters::kPhotonMaps,
                  .training_rays = 77};
  job.workers_used = 2;
  job.shares = {{1, "desk", 1000, 3}, {2, "", 536, 1}};
  job.curve = {{32, 1, 2, {.relative_rmse = 0.1}},
               {64, 3, 4, {.relative_rmse = 0.04, .margin = 0.01, .worst_share = 0.31}}};
  return progress;
}

google::protobuf::Struct struct_of(const std::string& text) {
  google::protobuf::Struct out;
  const auto status = google::protobuf::util::JsonStringToMessage(text, &out);
  EXPECT_TRUE(status.ok()) << status.ToString() << text;
  return out;
}

const google::protobuf::Value& at(const google::protobuf::Struct& json, const std::string& section,
                                  const std::string& field) {
  return json.fields().at(section).struct_value().fields().at(field);
}

TEST(Report, IsJsonWithAllFields) {
  const Image image{1, 1, {gray(0.5F)}};
  const std::string text = report_text({finished(), pixels_sha256(image), {"a.png"}});
  EXPECT_EQ(text.rfind(kReportBegins, 0), 0u);
  const auto json = struct_of(text);
  EXPECT_EQ(json.fields().at("schema").string_value(), "bandsaw.report/1");
  EXPECT_EQ(json.fields().at("scene").string_value(), "cor\"nell");
  EXPECT_EQ(at(json, "settings", "stop_error").number_value(), 0.05);
  EXPECT_THAT(text, HasSubstr("\"seed\":18446744073709551615"));
  EXPECT_EQ(at(json, "error", "relative_rmse").number_value(), 0.04);
  EXPECT_EQ(at(json, "error", "relative_rmse_at_most").number_value(), 0.05);
  EXPECT_TRUE(at(json, "error", "doubtful").bool_value());
  EXPECT_EQ(json.fields().at("curve").list_value().values_size(), 2);
  // The error is at most 10 % at 32 samples, and at most 5 % (4 % and a margin of 1 %) at 64
  // samples. So at 32 f samples (1 < f <= 2) the bound is 10 % / f. Beyond 64 samples, this part of
  // the curve is repeated for each doubling of the samples, and each repetition is lower than the
  // one before by the factor 2^(-3/4), the steepest fall over repetitions that the report assumes.
  // Four repetitions lower it by 2^3. So the bound at 512 f samples is 10 % / f / 2^3, which is
  // 1 % at 640 samples.
  EXPECT_NEAR(at(json, "time", "cpu_s_to_1_percent").number_value(), 4.0 * 640 / 64, 1e-9);
  EXPECT_EQ(at(json, "machines", "mrays_per_cpu_s").number_value(), 2);
  const auto& workers = at(json, "machines", "workers").list_value().values();
  EXPECT_EQ(workers[0].struct_value().fields().at("name").string_value(), "desk");
  EXPECT_TRUE(workers[1].struct_value().fields().at("name").has_null_value());
  // Five samples are bad. Two of them are negative.
  EXPECT_EQ(at(json, "health", "not_finite_samples").number_value(), 3);
  EXPECT_EQ(at(json, "health", "negative_samples").number_value(), 2);
  EXPECT_EQ(at(json, "health", "truncated_paths").number_value(), 11);
  EXPECT_EQ(at(json, "health", "dropped_primitives").number_value(), 4);
  EXPECT_FALSE(at(json, "work", "path_guiding").bool_value());
  EXPECT_TRUE(at(json, "work", "photon_maps").bool_value());
  EXPECT_FALSE(at(json, "work", "portals").bool_value());
  EXPECT_EQ(at(json, "work", "training_rays").number_value(), 77);
  EXPECT_EQ(at(json, "hashes", "pixels_sha256").string_value().size(), 64u);
}

TEST(Report, UnknownValuesAreNull) {
  Progress progress = finished();
  progress.job.curve.clear();
  progress.job.elapsed_s = -1;
  progress.job.cpu_s = 0;
  const auto json = struct_of(report_text({progress, "", {}}));
  EXPECT_TRUE(json.fields().at("error").has_null_value());
  for (const char* field : {"elapsed_s", "cpu_s", "cpu_s_to_1_percent"}) {
    EXPECT_TRUE(at(json, "time", field).has_null_value()) << field;
  }
  EXPECT_TRUE(at(json, "hashes", "pixels_sha256").has_null_value());
}

class ReportFiles : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  test::TempDir folder_;
};

TEST_F(ReportFiles, ImagesOfTheSameNameShareOneReport) {
  EXPECT_THAT(*report_files({}, {folder_ / "a.png", folder_ / "a.exr", folder_ / "b.x.png"}),
              ElementsAre(folder_ / "a.json", folder_ / "b.x.json"));
  EXPECT_THAT(*report_files({"none"}, {folder_ / "a.png"}), IsEmpty());
  EXPECT_THAT(*report_files({folder_ / "r.json"}, {folder_ / "a.png"}),
              ElementsAre(folder_ / "r.json"));
  EXPECT_FALSE(report_files({folder_ / "none/r.json"}, {}).ok());
}

TEST_F(ReportFiles, NeverReplaceOtherFiles) {
  const std::string scene = write("a.json", "{\"camera\":{}}");
  EXPECT_THAT(*report_files({}, {folder_ / "a.png"}), ElementsAre(folder_ / "a.report.json"));
  const auto asked = report_files({scene}, {folder_ / "a.png"});
  EXPECT_EQ(asked.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(asked.status().message()), HasSubstr("--report none"));
  EXPECT_FALSE(write_reports("x", {scene}).ok())
      << "a file that came during the render must be kept";
  EXPECT_EQ(std::filesystem::file_size(scene), 13u);
  std::filesystem::create_directory(folder_ / "b.json");
  EXPECT_THAT(*report_files({}, {folder_ / "b.png"}), ElementsAre(folder_ / "b.report.json"));
}

TEST_F(ReportFiles, APictureBesideAModelIsReplacedOnlyIfItHasAReport) {
  const std::string picture = write("cube.png", "a texture");
  EXPECT_EQ(check_default_output("cube.obj", picture).code(), absl::StatusCode::kInvalidArgument);
  EXPECT_TRUE(check_default_output("cube.textproto", picture).ok());
  EXPECT_TRUE(check_default_output("cube.obj", folder_ / "other.png").ok());
  ASSERT_TRUE(write_reports(report_text({finished(), "", {}}), {folder_ / "cube.json"}).ok());
  EXPECT_TRUE(check_default_output("cube.obj", picture).ok())
      << "the report beside the picture shows that the picture is a render";
}

TEST_F(ReportFiles, ReplaceAnEarlierReport) {
  const std::string file = folder_ / "a.json";
  for (int time = 0; time < 2; ++time) {
    ASSERT_THAT(*report_files({}, {folder_ / "a.png"}), ElementsAre(file));
    ASSERT_TRUE(write_reports(report_text({finished(), "", {}}), {file}).ok());
  }
}

}  // namespace
}  // namespace bandsaw::coordinator
