// The layers that `render --layers` adds to an EXR file (albedo, normal, depth, and so on).

#include "coordinator/cli/image/layers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coordinator/cli/options/choices.h"
#include "renderlib/render/render_image.h"
#include "tests/support/scenes.h"

namespace bandsaw::coordinator {
namespace {

using ::testing::ElementsAre;

TEST(Layers, EachKnownLayerMayBeNamedOnce) {
  EXPECT_THAT(parse_layers("depth,albedo").value(),
              ElementsAre(LayerKind::kDepth, LayerKind::kAlbedo));
  EXPECT_THAT(parse_layers("albedo,normal,depth,samples").value().size(), 4u);
  for (const char* wrong : {"", "albedo,", "albedo,albedo", "colour", "normals"}) {
    EXPECT_FALSE(parse_layers(wrong).ok()) << wrong;
  }
}

TEST(Layers, EqualTheImagesOfTheirIntegrators) {
  test::SceneMaker maker;
  maker.sphere({0, 0, 0}, 1, maker.diffuse({0.25f, 0.5f, 0.75f}));
  const auto scene = maker.build();
  Pool pool(2);
  const std::atomic<bool> stop{false};
  RenderSettings settings{.width = 8, .height = 6};
  const auto render = [&](const RenderSettings& wanted,
                          std::uint64_t samples) -> absl::StatusOr<Image> {
    return render_image(*scene, wanted, samples, pool, stop, {}, "")->film.snapshot().image;
  };
  const auto layers = make_layers({LayerKind::kSamples, LayerKind::kAlbedo, LayerKind::kDepth},
                                  settings, 16, render, {});
  ASSERT_TRUE(layers.ok()) << layers.status();
  // The image has 48 pixels. Each of them has 16 samples.
  EXPECT_EQ((*layers)[0].image.pixels, std::vector<Rgb>(48, gray(16)));
  EXPECT_TRUE((*layers)[0].is_number);
  EXPECT_FALSE((*layers)[1].is_number);
  settings.integrator = Integrator::kAlbedo;
  const auto albedo = render_image(*scene, settings, 16, pool, stop, {}, "");
  EXPECT_EQ((*layers)[1].image.pixels, albedo->film.snapshot().image.pixels);
  EXPECT_EQ((*layers)[2].name, "depth");
}

TEST(Layers, ShowTheSampleCountOfEachPixelOfAnAdaptiveImage) {
  const auto render = [](const RenderSettings&, std::uint64_t) -> absl::StatusOr<Image> {
    return absl::InternalError("nothing is to be rendered");
  };
  const Image counts{2, 1, {gray(32), gray(64)}};
  const auto layers = make_layers({LayerKind::kSamples}, {.width = 2, .height = 1}, 64, render,
                                  [&] { return counts; });
  ASSERT_TRUE(layers.ok()) << layers.status();
  EXPECT_EQ((*layers)[0].image.pixels, counts.pixels);
  const auto gone = make_layers({LayerKind::kSamples}, {.width = 2, .height = 1}, 64, render,
                                [] { return absl::NotFoundError("gone"); });
  EXPECT_EQ(gone.status().message(), "gone");
}

}  // namespace
}  // namespace bandsaw::coordinator
