// Measures the cost of each scene feature (renderlib/scene/scene_features.h). Each scene is
// rendered in turns with its own features and with forced features. If an unused feature is forced,
// the renderer does its work although this work does not change the pixels. Writes Markdown to
// standard output.
//
//   features_bench SCENE...    scene files or models

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "renderlib/base/check.h"
#include "renderlib/import/import.h"
#include "renderlib/render/render_band.h"

namespace bandsaw {
namespace {

constexpr int kRounds = 15;
constexpr double kSecondsARender = 0.1;

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// A scene with its own features or with forced features.
struct Variant {
  std::string name;
  std::shared_ptr<const Scene> scene;
  /// For each round: CPU time of a render, divided by that of the scene with its own features.
  std::vector<double> ratios;
};

/// Returns the scene with its own features, twice, so that the second one shows the noise of the
/// measurement. Then follow the scene with each unused feature forced, and with all features
/// forced.
std::vector<Variant> variants_of(const SceneDescription& description, Pool& pool) {
  std::vector<Variant> out = {{"own", Scene::build(description, pool).value(), {}}};
  const SceneFeatures own = out[0].scene->features();
  out.push_back({"own again", Scene::build(description, pool).value(), {}});
  for (const NamedFeature& each : kEachFeature) {
    if (!(own.*each.feature)) {
      SceneFeatures forced;
      forced.*each.feature = true;
      out.push_back({each.name, Scene::build(description, pool, forced).value(), {}});
    }
  }
  out.push_back({"all", Scene::build(description, pool, kAllFeatures).value(), {}});
  return out;
}

/// Returns the CPU seconds of a render. The program ends if the render fails.
double seconds_of(const Scene& scene, const RenderSettings& settings, std::uint64_t samples,
                  Pool& pool) {
  const std::atomic<bool> stop = false;
  const double start = cpu_seconds();
  const auto done =
      render_band(scene, settings, {{0, samples}, {0, settings.height}}, pool, stop, {});
  BANDSAW_CHECK(done.ok(), done.status().ToString().c_str());
  return cpu_seconds() - start;
}

/// Returns the number of samples, a power of two, that take about kSecondsARender.
std::uint64_t samples_for(const Scene& scene, const RenderSettings& settings, Pool& pool) {
  std::uint64_t samples = 16;
  while (seconds_of(scene, settings, samples, pool) < kSecondsARender / 1.5) {
    samples *= 2;
  }
  return samples;
}

/// Prints a row for each variant of a scene file, except for the first, with which the others are
/// compared. A row has the median of the variant's ratios and the range of their middle half.
void measure(const std::string& path, Pool& pool) {
  const auto imported = import_scene(path);
  if (!imported.ok()) {
    std::fprintf(stderr, "%s: %s\n", path.c_str(), imported.status().ToString().c_str());
    return;
  }
  const RenderSettings settings{.width = 64,
                                .height = 64,
                                .max_depth = imported->info.max_depth,
                                .integrator = imported->info.integrator};
  std::vector<Variant> variants = variants_of(imported->scene, pool);
  const std::uint64_t samples = samples_for(*variants[0].scene, settings, pool);
  for (int round = 0; round < kRounds; ++round) {
    const double own = seconds_of(*variants[0].scene, settings, samples, pool);
    for (Variant& variant : variants) {
      if (&variant != &variants[0]) {
        variant.ratios.push_back(seconds_of(*variant.scene, settings, samples, pool) / own);
      }
    }
  }
  const std::string name = std::filesystem::path(path).stem();
  for (Variant& variant : variants) {
    std::sort(variant.ratios.begin(), variant.ratios.end());
    if (!variant.ratios.empty()) {
      std::printf("| %s | %s | %.3f | %.3f–%.3f |\n", name.c_str(), variant.name.c_str(),
                  variant.ratios[kRounds / 2], variant.ratios[kRounds / 4],
                  variant.ratios[kRounds - 1 - kRounds / 4]);
      std::fflush(stdout);
    }
  }
}

}  // namespace
}  // namespace bandsaw

int main(int argc, char** argv) {
  bandsaw::Pool pool(1);
  std::puts(
      "| scene | forced features | CPU time, divided by that with own features | middle half of "
      "runs |\n"
      "| --- | --- | --- | --- |");
  for (int i = 1; i < argc; ++i) {
    bandsaw::measure(argv[i], pool);
  }
  return 0;
}
