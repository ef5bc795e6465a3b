// `bandsaw study`, which renders scenes with different techniques and compares their errors at
// equal cost, as text, CSV and SVG.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "coordinator/cli/study/study_clean.h"
#include "coordinator/cli/study/study_measure.h"
#include "coordinator/cli/study/study_pixel_stops.h"
#include "coordinator/cli/study/study_text.h"
#include "tests/support/scenes.h"

namespace bandsaw::coordinator {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

constexpr RenderSettings kSettings{.width = 8, .height = 8, .max_depth = 4, .seed = 1};

/// Runs the study of a scene. `every_object`: the same scene without a tree of bounding boxes, for
/// Method::kEveryObject; nullptr: this method is left out.
StudyOfScene study_of(const Scene& scene, const StudyPlan& plan,
                      const Scene* every_object = nullptr) {
  Pool pool(1);
  const std::atomic<bool> stop{false};
  auto study = study_scene("a|b", scene, every_object, kSettings, plan, pool, stop,
                           [](const std::string&) {});
  EXPECT_TRUE(study.ok()) << study.status();
  return study.ok() ? *study : StudyOfScene();
}

const StudyLine& line(const StudyOfScene& study, Method method) {
  const auto found = std::find_if(study.lines.begin(), study.lines.end(),
                                  [&](const StudyLine& one) { return one.method == method; });
  EXPECT_NE(found, study.lines.end()) << method_name(method);
  return *found;
}

/// Returns a scene with an area light in the middle of each pixel of kSettings. The light covers a
/// twentieth of the pixel. The rest of the image is black.
std::shared_ptr<const Scene> rare_light() {
  test::SceneMaker maker;
  const MaterialId lamp = maker.lamp(1);
  maker.camera({0, 0, 4}, {0, 0, 0}, 2 * std::atan(1) * 180 / 3.14159265358979323846 / 2);
  const double pixel = 2 * 4 * std::tan(std::atan(1.0) / 2) / 8;
  const double side = pixel * std::sqrt(0.05);
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 8; ++x) {
      maker.quad({(x - 3.5) * pixel - side / 2, (y - 3.5) * pixel - side / 2, 0}, {side, 0, 0},
                 {0, side, 0}, lamp);
    }
  }
  return maker.build();
}

TEST(Study, SamplesArePowersOfFourAndTheMaximum) {
  EXPECT_THAT(study_samples(64), ElementsAre(1, 4, 16, 64));
  EXPECT_THAT(study_samples(100), ElementsAre(1, 4, 16, 64, 100));
}

TEST(Study, WithoutATechniqueTheErrorIsLargerAndTheMeanIsUnbiased) {
  const StudyOfScene study =
      study_of(*test::cornell_box().build(), {.samples = 64, .seeds = 6, .reference = 2048});
  // Guiding does not pay here, so there is no line without guiding.
  ASSERT_EQ(study.lines.size(), std::size(kMethods) - 1);
  const double best = line(study, Method::kFull).points.back().relative_rmse;
  for (const Method method : {Method::kNoLights, Method::kIndependent}) {
    EXPECT_GT(line(study, method).points.back().relative_rmse, best) << method_name(method);
  }
  for (const Method method : {Method::kFull, Method::kNoMis, Method::kNoLights, Method::kAdaptive,
                              Method::kIndependent}) {
    const StudyLine& tested = line(study, method);
    ASSERT_EQ(tested.points.size(), 4u);
    EXPECT_LT(*slope_of(tested), -0.3) << method_name(method);
    // The reference has 64 pixels, so the error of its mean is an eighth of reference_error, which
    // is the error of a pixel.
    const StudyPoint& last = tested.points.back();
    EXPECT_LT(std::abs(last.bias), 4 * last.bias_error + 2 * study.reference_error / 8)
        << method_name(method);
  }
  EXPECT_NEAR(*slope_of(line(study, Method::kIndependent)), -0.5, 0.1);
}

// All visible light has passed through glass. Paths from the camera rarely find it, but photons do.
TEST(Study, WhereGuidingPaysThereIsALineWithoutIt) {
  test::SceneMaker maker = test::lamp_in_glass(1.5, 0.05);
  maker.camera({0, 0, 1}, {0, 0, 2}, 60);  // sees a wall; the lamp is behind the camera
  const StudyOfScene study =
      study_of(*maker.build(), {.samples = 16, .seeds = 2, .reference = 256});
  ASSERT_EQ(study.lines.size(), std::size(kMethods));
  EXPECT_LT(line(study, Method::kFull).points.back().relative_rmse,
            line(study, Method::kNoGuiding).points.back().relative_rmse / 2);
}

// A pixel that stops as soon as its own estimated error is small often stops before it has seen a
// rare light, so its image is too dark.
TEST(Study, StoppingPerPixelLosesRareLight) {
  const StudyOfScene study =
      study_of(*rare_light(), {.samples = 256, .seeds = 2, .reference = 4096});
  const StudyPoint& without_stops = line(study, Method::kIndependent).points.back();
  EXPECT_LT(std::abs(without_stops.bias), 0.1);
  for (const StudyPoint& point : line(study, Method::kPixelStops).points) {
    EXPECT_LT(point.bias, -0.25);
    EXPECT_LT(point.samples, 256);
  }
}

// Method::kEveryObject has no tree of bounding boxes: it tests each ray against every object.
TEST(Study, WithoutATreeThePixelsAreTheSame) {
  Pool pool(1);
  const auto everything = Scene::build(test::cornell_box().scene, pool, {}, Traversal::kBruteForce);
  ASSERT_TRUE(everything.ok());
  const StudyOfScene study =
      study_of(*test::cornell_box().build(), {.samples = 16, .seeds = 1, .reference = 64},
               everything->get());
  const StudyLine& full = line(study, Method::kFull);
  const StudyLine& without = line(study, Method::kEveryObject);
  ASSERT_EQ(without.points.size(), full.points.size());
  for (std::size_t i = 0; i < full.points.size(); ++i) {
    EXPECT_EQ(without.points[i].relative_mse, full.points[i].relative_mse);
    EXPECT_EQ(without.points[i].rays, full.points[i].rays);
  }
}

TEST(Study, ObjectsAreCountedPerPlacement) {
  SceneDescription scene = test::cornell_box().scene;
  const std::uint64_t loose = scene.geometry.size();
  EXPECT_EQ(objects_of(scene), loose);
  scene.geometry.groups.push_back(
      {.spheres = {3, Sphere{}}, .quads = {}, .triangles = {}, .disks = {}});
  Instance placed;
  placed.group = GroupId{0};
  scene.geometry.instances.assign(2, placed);
  EXPECT_EQ(objects_of(scene), loose + 6);
}

TEST(Study, AStopRequestEndsTheStudy) {
  Pool pool(1);
  const std::atomic<bool> stop{true};
  EXPECT_EQ(study_scene("a", *test::cornell_box().build(), nullptr, kSettings, {}, pool, stop,
                        [](const std::string&) {})
                .status()
                .code(),
            absl::StatusCode::kCancelled);
}

/// Returns a study with the lines of two methods. The error of kFull is 10 % at 16 samples and 1 s,
/// and 5 % at 64 samples and 4 s. The error of kPixelStops is 10 % at 16 and at 64 samples. The
/// members of a StudyPoint are the samples, the relative RMSE, the relative MSE, the bias, the
/// standard error of the bias, the CPU seconds and the rays.
std::vector<StudyOfScene> known() {
  StudyOfScene study{.scene = "a|\"b\" & <c>", .reference_error = 0.001, .lines = {}};
  study.lines.push_back(
      {Method::kFull, {{16, 0.1, 0.01, 0, 0, 1, 4e6}, {64, 0.05, 0.0025, 0, 0, 4, 16e6}}});
  study.lines.push_back(
      {Method::kPixelStops, {{16, 0.1, 0.01, -0.1, 0.01, 1, 4e6}, {64, 0.1, 0.01, 0, 0, 4, 16e6}}});
  return {study};
}

TEST(StudyText, ShowsTheCostOfOnePercent) {
  const std::vector<StudyOfScene> studies = known();
  const std::vector<StudyLine>& lines = studies[0].lines;
  EXPECT_NEAR(*slope_of(lines[0]), -0.5, 1e-12);
  EXPECT_NEAR(*cpu_s_to_1_percent(lines[0]), 100, 1e-9);
  EXPECT_FALSE(cpu_s_to_1_percent(lines[1]).has_value());
  const std::string table = study_table(known());
  EXPECT_THAT(table, HasSubstr("| a/\"b\" & <c> | all techniques | 64 | 5 % | +0.00 ± 0.00 % | "
                               "n^-0.50 | 4.00 | 4.0 | 1 min 40 s (1 ×) |"));
  EXPECT_THAT(table, HasSubstr("| – |"));
}

TEST(StudyText, TheCsvHasALineForEachPoint) {
  const std::string csv = study_csv(known());
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 5);  // the header and four points
  EXPECT_THAT(csv,
              HasSubstr("\"a|\"\"b\"\" & <c>\",\"all techniques\",16,0.1,0.01,0,0,1,4000000,"));
}

TEST(StudyText, ThePlotIsSvgOfAllLines) {
  const std::string svg = svg_of(study_plot(known()));
  EXPECT_THAT(svg, testing::StartsWith("<svg xmlns="));
  EXPECT_THAT(svg, HasSubstr("a|\"b\" &amp; &lt;c&gt;"));
  EXPECT_THAT(svg, HasSubstr("all techniques · n^-0.50"));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  EXPECT_EQ(std::count(svg.begin(), svg.end(), '<'), std::count(svg.begin(), svg.end(), '>'));
  // The axes run from 1 to 10 s and from 1 to 10 %. The first point, 1 s and 10 %, is in the top
  // left corner.
  EXPECT_THAT(svg, HasSubstr("<polyline points=\"62.0,34.0 "));
}

TEST(StudyText, AnEmptyPlotHasNoInvalidNumbers) {
  EXPECT_THAT(svg_of({.x = "x", .y = "y", .panels = {{}}}), Not(HasSubstr("nan")));
}

// A clean image is a denoised one. It needs the image as rendered, the guides (images by which the
// filter finds edges) and the filter, so it costs more than the image as rendered.
TEST(Study, CleanImagesAreComparedWithRenderedImages) {
  const StudyOfScene study =
      study_of(*test::cornell_box().build(),
               {.samples = 64, .seeds = 2, .reference = 1024, .denoise = true});
  ASSERT_EQ(study.lines.size(), 2u);
  EXPECT_EQ(study.lines[0].method, Method::kFull);
  EXPECT_EQ(study.lines[1].method, Method::kClean);
  ASSERT_EQ(study.clean.size(), 3u);  // 4, 16, 64
  for (const CleanPoint& point : study.clean) {
    EXPECT_GT(point.clean_cpu_s, point.raw_cpu_s);
    EXPECT_LT(point.gain_in_equal_time(), point.gain());
    EXPECT_EQ(point.error_ratios.size(), 2u);
  }
  const std::string table = clean_table({{"a|b", study.clean}});
  EXPECT_THAT(table, HasSubstr("| a/b | 16 |"));
  EXPECT_THAT(table, HasSubstr("of 6 images"));
}

// The clean images have 1/8 and 1/2 of the relMSE, so the ratios are 8 and 2, and their geometric
// mean is 4. Clean images take twice the CPU time, so the ratios in equal time are half as large.
// `error_ratios` are estimated errors, divided by true errors. Two of the four are in [0.7, 1.5].
TEST(Study, TheCleanTableHasMeansAndTheWorstScene) {
  const CleanPoint good{.samples = 16,
                        .raw_mse = 0.8,
                        .clean_mse = 0.1,
                        .raw_cpu_s = 1,
                        .clean_cpu_s = 2,
                        .error_ratios = {1.0, 0.6}};
  const CleanPoint bad{.samples = 16,
                       .raw_mse = 0.2,
                       .clean_mse = 0.1,
                       .raw_cpu_s = 1,
                       .clean_cpu_s = 2,
                       .error_ratios = {1.4, 1.6}};
  const std::string table = clean_table({{"good", {good}}, {"bad", {bad}}});
  EXPECT_THAT(table, HasSubstr("| 16 | 4.00 × | 2.00 × | 2.00 × (bad) | 1.00 × |"));
  EXPECT_THAT(table, HasSubstr("in 50 % of 4 images"));
}

}  // namespace
}  // namespace bandsaw::coordinator
