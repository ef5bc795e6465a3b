// Journal records as text: records of every kind are written and read back, and records of older
// versions are read.

#include "coordinator/store/record_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/store/sample_records.h"

namespace bandsaw::coordinator {
namespace {

using testing::HasSubstr;

TEST(RecordText, EveryKindRoundTrips) {
  for (const Record& record : sample_records()) {
    const RecordText text = to_text(record);
    const absl::StatusOr<Record> back = from_text(text);
    ASSERT_TRUE(back.ok()) << text.kind << ": " << back.status();
    EXPECT_EQ(back->index(), record.index());
    EXPECT_EQ(to_text(*back), text);
  }
}

TEST(RecordText, AJobKeepsEveryField) {
  const JobSpec spec = sample_spec(StopAtError{.relative_rmse = 1.0 / 3, .max_samples = 77});
  const absl::StatusOr<Record> back =
      from_text(to_text(record::JobAdded{.job = 5, .spec = spec, .pixel_version = 8}));
  ASSERT_TRUE(back.ok());
  EXPECT_EQ(std::get<record::JobAdded>(*back).job, 5u);
  EXPECT_EQ(std::get<record::JobAdded>(*back).pixel_version, 8u);
  EXPECT_EQ(std::get<record::JobAdded>(*back).spec, spec);
  EXPECT_EQ(std::get<record::JobAdded>(*back).spec.package_bytes, spec.package_bytes);
}

TEST(RecordText, AJobWithoutAnIntegratorUsesThePathIntegrator) {
  JobSpec spec = sample_spec(StopAtSamples{4});
  RecordText text = to_text(record::JobAdded{.job = 5, .spec = spec});
  const std::size_t at = text.fields.find("integrator ");
  ASSERT_NE(at, std::string::npos);
  text.fields.erase(at, text.fields.find('\n', at) + 1 - at);
  spec.settings.integrator = Integrator::kPath;
  EXPECT_EQ(std::get<record::JobAdded>(from_text(text).value()).spec, spec);
}

TEST(RecordText, AJobWithoutAPixelVersionGetsVersion0) {
  RecordText text = to_text(
      record::JobAdded{.job = 5, .spec = sample_spec(StopAtSamples{4}), .pixel_version = 8});
  const std::string field = "pixel_version 8\n";
  text.fields.erase(text.fields.find(field), field.size());
  EXPECT_EQ(std::get<record::JobAdded>(from_text(text).value()).pixel_version, 0u);
}

TEST(RecordText, RecordsWithoutTheNewestFieldsAreRead) {
  int fields = 0;
  for (const Record& record : sample_records()) {
    RecordText old = to_text(record);
    for (const std::string field :
         {"package_bytes ", "browser ", "techniques ", "training_rays "}) {
      if (const std::size_t at = old.fields.find(field); at != std::string::npos) {
        old.fields.erase(at, old.fields.find('\n', at) + 1 - at);
        ++fields;
      }
    }
    const absl::StatusOr<Record> back = from_text(old);
    ASSERT_TRUE(back.ok()) << old.kind << ": " << back.status();
    if (const auto* joined = std::get_if<record::WorkerJoined>(&*back)) {
      EXPECT_FALSE(joined->browser);
    }
    if (const auto* added = std::get_if<record::JobAdded>(&*back)) {
      EXPECT_EQ(added->spec.package_bytes, 0u) << "an unknown size is 0";
    }
    if (const auto* summary = std::get_if<record::JobSummary>(&*back)) {
      EXPECT_EQ(summary->counters.techniques, 0u);
    }
  }
  EXPECT_GT(fields, 5) << "several sample records must have had fields that were removed";
}

TEST(RecordText, NamesOfOlderVersionsAreRead) {
  for (const Record& record : sample_records()) {
    const RecordText text = to_text(record);
    RecordText old = text;
    old.kind = text.kind == "job_summary"   ? "figures"
               : text.kind == "failure_log" ? "last_words"
                                            : text.kind;
    const std::size_t process = old.fields.find("process ");
    if (process != std::string::npos) {
      old.fields.replace(process, 7, "renderer");
    }
    const absl::StatusOr<Record> back = from_text(old);
    ASSERT_TRUE(back.ok()) << old.kind << ": " << back.status();
    EXPECT_EQ(to_text(*back), text);
  }
}

TEST(RecordText, AnUnknownKindIsNamed) {
  const absl::Status status = from_text({.kind = "job_paused", .fields = "job 1\n"}).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kDataLoss);
  EXPECT_THAT(std::string(status.message()), HasSubstr("job_paused"));
}

TEST(RecordText, MissingWrongAndExtraFieldsAreNamed) {
  const auto message = [](const char* kind, const char* fields) {
    const absl::Status status = from_text({.kind = kind, .fields = fields}).status();
    EXPECT_EQ(status.code(), absl::StatusCode::kDataLoss);
    return std::string(status.message());
  };
  EXPECT_THAT(message("pass_planned", "job 1\nfirst 0\n"), HasSubstr("last"));
  EXPECT_THAT(message("pass_planned", "job 1\nfirst x\nlast 1\n"), HasSubstr("first"));
  EXPECT_THAT(message("pass_planned", "job -1\nfirst 0\nlast 1\n"), HasSubstr("job"));
  EXPECT_THAT(message("samples_fixed", "job 1\nsamples 1\nmore 1\n"), HasSubstr("more"));
  EXPECT_THAT(message("state_changed", "job 1\nstate lost\nreason \n"), HasSubstr("lost"));
  EXPECT_THAT(message("worker_left", "instance \\q\n"), HasSubstr("instance"));
  EXPECT_THAT(message("worker_left", "instance a"), HasSubstr("instance"));
}

TEST(RecordText, EveryTruncatedRecordIsRefused) {
  for (const Record& record : sample_records()) {
    const RecordText text = to_text(record);
    for (std::size_t length = 0; length < text.fields.size(); ++length) {
      EXPECT_FALSE(from_text({.kind = text.kind, .fields = text.fields.substr(0, length)}).ok());
    }
  }
}

}  // namespace
}  // namespace bandsaw::coordinator
