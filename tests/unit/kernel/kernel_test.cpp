// A kernel is the code that builds scenes and renders them, compiled for one instruction set. All
// kernels of a program give the same bits, and a scene is rendered by the kernel that built it. The
// base kernel runs on every machine on which the program runs. kernels() returns the kernels that
// this machine can run, fastest first.

#include "renderlib/render/kernel.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>
#include <string>

#include "renderlib/base/simd.h"
#include "renderlib/base/x86_64_v3.h"
#include "renderlib/render/canary.h"
#include "tests/support/scenes.h"

namespace bandsaw {
namespace {

using testing::HasSubstr;

// This file is compiled for the same instruction set as the base kernel, and kSimdName is the name
// of this instruction set.
TEST(Kernels, EndWithTheBaseKernel) {
  EXPECT_EQ(kernels().back(), &Kernel::kBase);
  EXPECT_STREQ(Kernel::kBase.name, kSimdName);
}

#if defined(__x86_64__) && !defined(__AVX2__)
TEST(Kernels, BeginWithAvx2IfTheMachineRunsIt) {
  EXPECT_STREQ(Kernel::kBase.name, "plain");
  ASSERT_EQ(kernels().size(), runs_x86_64_v3() ? 2u : 1u);
  if (runs_x86_64_v3()) {
    EXPECT_STREQ(kernels().front()->name, "avx2");
  }
}

// The flags in /proc/cpuinfo are the answer of Linux to two questions: which features the processor
// has, and which registers programs may use.
TEST(Kernels, RunsX86_64V3AgreesWithLinux) {
  std::ifstream info("/proc/cpuinfo");
  std::set<std::string> flags;
  for (std::string line; flags.empty() && std::getline(info, line);) {
    if (line.starts_with("flags")) {
      std::istringstream words(line.substr(line.find(':') + 1));
      for (std::string word; words >> word;) {
        flags.insert(word);
      }
    }
  }
  ASSERT_FALSE(flags.empty()) << "/proc/cpuinfo lists no flags";
  const char* const wanted[] = {"pni",    "ssse3", "fma",    "cx16",    "sse4_1",
                                "sse4_2", "movbe", "popcnt", "avx",     "f16c",
                                "bmi1",   "avx2",  "bmi2",   "lahf_lm", "abm"};
  const bool all = std::all_of(std::begin(wanted), std::end(wanted),
                               [&](const char* flag) { return flags.contains(flag); });
  EXPECT_EQ(runs_x86_64_v3(), all);
}
#endif

TEST(Kernels, AreFoundByName) {
  for (const Kernel* kernel : kernels()) {
    const auto found = find_kernel(kernel->name);
    ASSERT_TRUE(found.ok()) << found.status();
    EXPECT_EQ(*found, kernel);
  }
  const absl::Status wrong = find_kernel("sse2").status();
  EXPECT_EQ(wrong.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(wrong.message()), HasSubstr("'sse2'; it has "));
  EXPECT_THAT(std::string(wrong.message()), HasSubstr(kernels().back()->name));
}

// The canary is the hash of a small image.
TEST(Kernels, HaveTheSameCanary) {
  for (const Kernel* kernel : kernels()) {
    EXPECT_EQ(canary(kernel), canary()) << kernel->name;
  }
}

/// A box with glass and metal, and a mesh that is large enough for a BVH of several levels.
SceneDescription mixed_scene() {
  test::SceneMaker maker = test::cornell_box();
  maker.sphere({180, 90, 180}, 90, maker.glass(1.5));
  maker.sphere({400, 60, 120}, 60, maker.metal(0.8f, 0.2));
  maker.instance(
      test::grid(40),
      translation({278, 200, 300}) * rotation({1, 0.3, 0.1}, 55) * scaling({150, 150, 1}),
      maker.diffuse(0.5f));
  return maker.scene;
}

TEST(Kernels, RenderTheSameSums) {
  const RenderSettings settings{.width = 40, .height = 40, .max_depth = 8, .seed = 11};
  const std::atomic<bool> stop = false;
  Pool pool(2);
  std::vector<double> sums;
  for (const Kernel* kernel : kernels()) {
    const auto scene = Scene::build(mixed_scene(), pool, {}, Traversal::kBvh, kernel);
    ASSERT_TRUE(scene.ok()) << scene.status();
    EXPECT_EQ(&(*scene)->kernel(), kernel);
    const auto pixels = render_band(**scene, settings, {{0, 32}, {0, 40}}, pool, stop, {});
    ASSERT_TRUE(pixels.ok()) << pixels.status();
    EXPECT_GT(*std::max_element(pixels->sums.begin(), pixels->sums.end()), 0);
    if (sums.empty()) {
      sums = pixels->sums;
    }
    EXPECT_EQ(pixels->sums, sums) << kernel->name;
  }
}

TEST(Kernels, TheFirstIsTheDefault) {
  Pool pool(1);
  const auto scene = Scene::build(mixed_scene(), pool);
  ASSERT_TRUE(scene.ok()) << scene.status();
  EXPECT_EQ(&(*scene)->kernel(), kernels().front());
}

}  // namespace
}  // namespace bandsaw
