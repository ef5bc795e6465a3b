// Scenes with motion, and the memory that a scene with many instances takes. An id such as C8 in a
// test's name is that of a case in tests/hard_cases/cases.txt.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <fstream>
#include <string>

#include "renderlib/render/render_band.h"
#include "renderlib/scene/static_instances.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

namespace bandsaw {
namespace {

using test::SceneMaker;
using ::testing::HasSubstr;

Instance of_group(std::uint32_t group, const Transform& to_world) {
  Instance instance;
  instance.group = GroupId{group};
  instance.material = kOwnMaterial;
  instance.to_world = to_world;
  return instance;
}

/// A ball over a floor under a sky. The ball is placed by a frame, which is a coordinate system
/// that moves. A key is the placement of the frame at one time.
SceneMaker ball_in_frame(std::vector<Key> keys, const Shutter& shutter) {
  SceneMaker maker;
  maker.quad({-5, 0, -5}, {0, 0, 10}, {10, 0, 0}, maker.diffuse(0.5f));
  maker.camera({0, 1, 5}, {0, 1, 0}, 40);
  maker.background({1, 1, 1}, {0.5f, 0.7f, 1});
  Geometry& g = maker.scene.geometry;
  g.groups.resize(1);
  g.groups[0].spheres.push_back({{0, 1, 0}, 0.5, maker.metal(0.8f, 0.2)});
  g.frames = {{kNoFrame, {}, std::move(keys)}};
  g.instances.push_back(of_group(0, {}));
  g.instances[0].frame = FrameId{0};
  std::get<PerspectiveCamera>(maker.scene.camera).shutter = shutter;
  return maker;
}

/// Returns the sums of 32 samples of each pixel; empty if rendering fails.
std::vector<double> pixels(const Scene& scene) {
  Pool pool(1);
  const std::atomic<bool> stop = false;
  const auto band = render_band(scene, {.width = 24, .height = 16, .seed = 3}, {{0, 32}, {0, 16}},
                                pool, stop, {});
  return band.ok() ? band->sums : std::vector<double>{};
}

/// At time 1, the ball is at x = 0.5.
const std::vector<Key> kMoving = {Key(0, {}), Key(2, translation({1, 0, 0}))};

// A shutter without duration gives the pixels of the static scene, to the bit.
TEST(MovingScene, C8_AnInstantEqualsTheStaticScene) {
  const auto moving = ball_in_frame(kMoving, {1, 1}).build();
  EXPECT_FALSE(moving->features().motion);
  SceneMaker still = ball_in_frame(kMoving, {});
  still.scene.geometry.frames.clear();
  still.scene.geometry.instances = {of_group(0, translation({0.5, 0, 0}))};
  EXPECT_EQ(pixels(*moving), pixels(*still.build()));
}

// Static instances have the same pixels with and without a shutter.
TEST(MovingScene, StaticInstancesDoNotSetTheMotionFeature) {
  const std::vector<Key> still = {Key(-1, translation({0.5, 0, 0})),
                                  Key(7, translation({0.5, 0, 0}))};
  const auto open = ball_in_frame(still, {0, 1}).build();
  EXPECT_FALSE(open->features().motion);
  EXPECT_EQ(pixels(*open), pixels(*ball_in_frame(still, {}).build()));
  const auto moving = ball_in_frame(kMoving, {0, 1}).build();
  EXPECT_TRUE(moving->features().motion);
  EXPECT_NE(pixels(*moving), pixels(*open));
}

TEST(MovingScene, OnlyInstancesThatNeverMoveBecomeStatic) {
  Geometry g;
  g.frames = {{kNoFrame, {}, {Key(0, {}), Key(1, translation({1, 0, 0})), Key(2, {})}},
              {kNoFrame, {}, {Key(5, {}), Key(6, translation({1, 0, 0}))}},
              {FrameId{0}, {}, {Key(0, {})}},
              {FrameId{1}, {}, {Key(0, scaling({2, 2, 2}))}}};
  for (std::uint32_t i = 0; i < 4; ++i) {
    g.instances.push_back(of_group(0, {}));
    g.instances[i].frame = FrameId{i};
  }
  g.shutter = {0, 2};
  make_static(g);
  EXPECT_EQ(g.instances[0].frame, FrameId{0}) << "it ends where it began and moves in between";
  EXPECT_EQ(g.instances[1].frame, kNoFrame) << "it moves only after the shutter has closed";
  EXPECT_EQ(g.instances[2].frame, FrameId{2}) << "its parent frame moves";
  EXPECT_EQ(g.instances[3].to_world, scaling({2, 2, 2}));
  EXPECT_TRUE(moves(g));
}

/// Returns the error of a valid moving scene that `spoil` has changed; empty if there is none.
std::string message_after_moving(void (*spoil)(SceneDescription&)) {
  SceneMaker maker = ball_in_frame(kMoving, {0, 1});
  maker.scene.geometry.disks.push_back({{0, 0, 0}, {0, 1, 0}, 1, MaterialId{0}});
  spoil(maker.scene);
  Pool pool(1);
  return std::string(Scene::build(maker.scene, pool).status().message());
}

// Also covers placements without an inverse (X3).
TEST(MovingScene, InvalidMotionIsRefusedWithTheField) {
  EXPECT_EQ(message_after_moving([](auto&) {}), "");
  EXPECT_EQ(message_after_moving([](auto& s) { s.geometry.disks[0].radius = 0; }),
            "disks[0].radius: must be > 0, is 0");
  EXPECT_THAT(message_after_moving([](auto& s) {
                s.geometry.disks[0].normal = {0, 2, 0};
              }),
              HasSubstr("disks[0].normal: must have length 1"));
  EXPECT_THAT(message_after_moving([](auto& s) { s.geometry.groups[0].spheres[0].radius = -1; }),
              HasSubstr("groups[0].spheres[0].radius"));
  EXPECT_THAT(message_after_moving([](auto& s) { s.geometry.instances[0].group = GroupId{1}; }),
              HasSubstr("instances[0].group: must be below 1"));
  EXPECT_THAT(message_after_moving([](auto& s) { s.geometry.instances[0].frame = FrameId{1}; }),
              HasSubstr("instances[0].frame: must be below 1"));
  EXPECT_THAT(message_after_moving([](auto& s) { s.geometry.frames[0].parent = FrameId{0}; }),
              HasSubstr("frames[0].parent: must be below 0"));
  EXPECT_THAT(message_after_moving([](auto& s) { s.geometry.frames[0].keys[1].time = 0; }),
              HasSubstr("frames[0].keys[1].time"));
  EXPECT_THAT(message_after_moving([](auto& s) { s.geometry.frames[0].keys.clear(); }),
              HasSubstr("frames[0].keys: must have at least one key"));
  EXPECT_THAT(message_after_moving([](auto& s) {
                s.geometry.frames[0].keys[1] =
                    Key(2, rotation({0, 0, 1}, 45) * scaling({1, 2, 1}) * rotation({0, 0, 1}, 9));
              }),
              HasSubstr("frames[0].keys[1].at: must be a scale, then a rotation"));
  EXPECT_THAT(message_after_moving([](auto& s) {
                s.geometry.frames[0].placement = scaling({1, 0, 1});
              }),
              HasSubstr("frames[0].placement: must have an inverse"));
  EXPECT_THAT(
      message_after_moving([](auto& s) {
        std::get<PerspectiveCamera>(s.camera).shutter = {1, 0};
      }),
      HasSubstr("camera.shutter_close: must not be before 1, the value of shutter_open; it is 0"));
}

/// Returns the maximum memory of this process so far, in bytes.
std::size_t peak_memory() {
  std::ifstream status("/proc/self/status");
  std::string word;
  while (status >> word) {
    if (word == "VmHWM:") {
      std::size_t kilobytes = 0;
      status >> kilobytes;
      return kilobytes << 10;
    }
  }
  return 0;
}

TEST(ManyInstances, ManyInstancesOfALargeMeshFitInAGigabyte) {
  SceneMaker maker;
  maker.instance(test::grid(224), {}, maker.diffuse(0.5f));
  std::vector<Instance>& instances = maker.scene.geometry.instances;
  instances.clear();
  test::Random random(1);
  for (int i = 0; i < 100'000; ++i) {
    const auto place = [&] { return random.uniform(-1000, 1000); };
    const Vec3 to = {place(), place(), place()};
    instances.push_back({MeshId{0}, MaterialId{0}, translation(to) * rotation(to, 77)});
  }
  Pool pool(2);
  ASSERT_GE(maker.scene.geometry.meshes[0].triangles.size(), 100'000u);
  const auto scene = Scene::build(std::move(maker.scene), pool);
  ASSERT_TRUE(scene.ok());
  int hits = 0;
  // For every tenth instance, a ray begins at distance 1 from a point of the mesh and goes to this
  // point.
  for (std::size_t i = 0; i < 100'000; i += 10) {
    const Instance& instance = (*scene)->geometry().instances[i];
    const Vec3 target = instance.to_world.point({0.3, 0.2, 0});
    const Vec3 normal = instance.to_world.direction({0, 0, 1});
    const Hit hit = (*scene)->accel().closest({target + normal, -normal});
    hits += hit && hit.t <= 1 + 1e-9 ? 1 : 0;
  }
  EXPECT_EQ(hits, 10'000);
  EXPECT_GT(peak_memory(), std::size_t{10} << 20);  // less would mean a wrong measurement
  EXPECT_LT(peak_memory(), std::size_t{1} << 30);
}

}  // namespace
}  // namespace bandsaw
