#include "coordinator/cli/study/study_phone.h"

#include <gmock/gmock.h>

#include <set>
#include <string>

namespace bandsaw::coordinator {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

/// Each image takes 10 ms on one thread, and those of many objects 1 more each; a half on four, a
/// fifth on the farm.
PhoneStudy sample() {
  PhoneStudy study{.machine = "a CPU",
                   .threads = 4,
                   .farm = "2 workers, 8 threads",
                   .peak_mb = 120,
                   .images = {}};
  for (const PhoneTable& table : phone_tables()) {
    for (const PhoneRow& row : table.rows) {
      const double ms = table.title == std::string("Objects") ? 9 + row.x : 10;
      study.images.push_back({.name = row.image,
                              .rays = row.image == std::string("lights_1") ? 3.0 : 2.0,
                              .one = {{1, 3, 2}, {ms, ms, 99}},
                              .all = {{1, 1, 1}, {4, 5, 6}},
                              .farm = {{}, {2, 1, 3}}});
    }
  }
  return study;
}

TEST(PhoneStudy, HasTheStudysImages) {
  std::set<std::string> names;
  for (const PhoneImage& image : sample().images) {
    names.insert(image.name);
  }
  EXPECT_EQ(names.size(), 23u);
}

TEST(PhoneStudy, AMedianIsTheMiddle) {
  EXPECT_EQ(median({3}), 3);
  EXPECT_EQ(median({9, 1, 2}), 2);
  EXPECT_EQ(median({4, 1, 9, 2}), 3);
}

TEST(PhoneStudy, TablesHaveMediansBesideTheStudysFigures) {
  const std::string text = phone_tables_text(sample());
  EXPECT_THAT(text, HasSubstr("| a CPU, 1 thread | 300.0 | 1.00 |\n"));
  EXPECT_THAT(text, HasSubstr("| the same, 4 threads | 115.0 | 0.38 |\n"));
  EXPECT_THAT(text, HasSubstr("| a farm, 2 workers, 8 threads | 46.0 | 0.15 |\n"));
  EXPECT_THAT(text, HasSubstr("| the study's phones | 35 to 150 times the laptop's | not known |"));
  EXPECT_THAT(text, HasSubstr("| rows of texels | build, ms | 1 thread, ms | 4 threads, ms | farm, "
                              "ms | the study's, ms |\n"));
  EXPECT_THAT(text, HasSubstr("| 512 | 2.00 | 10.0 | 5.00 | 2.00 | not known |\n"));
  EXPECT_THAT(text, HasSubstr("| 1 | 2.00 | 10.0 | 5.00 | 2.00 | 290 |\n"));
  EXPECT_THAT(text, HasSubstr("| 24 | 2.00 | 33.0 | 5.00 | 2.00 | 3289 |\n"));
}

TEST(PhoneStudy, WhatTheStudyAskedForIsAnswered) {
  const std::string text = phone_tables_text(sample());
  EXPECT_THAT(text, HasSubstr("24 take on one thread 3.30 times as long, with 1.00 times the rays; "
                              "in the study 11.34 times"));
  EXPECT_THAT(text, HasSubstr("2.61 times as long on one as on 4"));
  EXPECT_THAT(text, HasSubstr("120 MB"));
  EXPECT_THAT(text, HasSubstr("with one light an image takes 1.00 times as long, with 1.50 times"));
}

TEST(PhoneStudy, WhatWasNotRenderedIsLeftOut) {
  PhoneStudy study = sample();
  study.farm = "";
  study.images.resize(4);  // of the first table
  for (PhoneImage& image : study.images) {
    image.farm = {};
  }
  const std::string text = phone_tables_text(study);
  EXPECT_THAT(text, HasSubstr("| 512 | 2.00 | 10.0 | 5.00 | – | not known |\n"));
  EXPECT_THAT(text, HasSubstr("| a farm | – | – |"));
  EXPECT_THAT(text, Not(HasSubstr("### Objects")));
  EXPECT_THAT(text, Not(HasSubstr("Many objects")));
  EXPECT_THAT(phone_csv(study), Not(HasSubstr("farm")));
}

TEST(PhoneStudy, FiguresHaveALineARun) {
  EXPECT_THAT(phone_csv(sample()), StartsWith("image,machine,run,build_ms,render_ms\n"
                                              "texture_512,1 thread,1,1.0000,10.0000\n"
                                              "texture_512,1 thread,2,3.0000,10.0000\n"
                                              "texture_512,1 thread,3,2.0000,99.0000\n"
                                              "texture_512,4 threads,1,1.0000,4.0000\n"));
  EXPECT_THAT(phone_csv(sample()), HasSubstr("texture_512,farm,1,,2.0000\n"));
}

TEST(PhoneStudy, WhatIsByANumberIsDrawn) {
  const Plot plot = phone_plot(sample());
  ASSERT_EQ(plot.panels.size(), 3u);
  EXPECT_EQ(plot.panels[1].title, "by objects");
  ASSERT_EQ(plot.panels[1].lines.size(), 4u);
  EXPECT_EQ(plot.panels[1].lines[0].points.back(), (std::pair<double, double>{24, 33}));
  EXPECT_EQ(plot.panels[1].lines[3].points.back(), (std::pair<double, double>{24, 3289}));
  EXPECT_EQ(plot.panels[0].lines.size(), 3u);  // nothing is known of the study's
}

}  // namespace
}  // namespace bandsaw::coordinator
