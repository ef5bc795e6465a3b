// Renders the scenes of Mitsuba's own tests and compares them with Mitsuba's references.
//
//   mitsuba_refs FOLDER [--only NAME] [--samples N] [--budget N] [--seeds N] [--out FOLDER]
//
// FOLDER is a copy of Mitsuba's test data: tests/scenes/*/*.xml, and beside them
// refs/STEM_ref_rgb.exr and refs/STEM_ref_rgb_var.exr, the variance of one sample. STEM is the name
// of the scene's file without the last "_" and what follows it. With --only, the tool renders only
// the scenes whose path contains NAME. Each scene is rendered with --seeds seeds (default 16). With
// --samples, all seeds together take that many samples of each pixel. Otherwise all seeds together
// take --budget samples (default 2 million, as in Mitsuba's tests), which are spread over all
// pixels. With --out, the tool writes a PNG into that folder for each scene that has a reference of
// the same size.
//
// A channel of a pixel fails if the p-value of its difference from the reference is below Sidak's
// level. At this level, at least one of N independent tests fails by chance with a probability of
// 0.01, where N is the number of pixels. As in Mitsuba's tests, up to 0.25 % of the channels may
// fail. The variance of the difference is the sum of two variances. The first is the variance of
// the rendered image. It is the larger of two values: the reference's variance of one sample (at
// least 1e-4) over the number of samples, and the variance that the seeds show. The second is the
// variance of the reference image, which has 32,000 samples.

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "renderlib/base/atomic_file.h"
#include "renderlib/base/file.h"
#include "renderlib/base/pool.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/image/png.h"
#include "renderlib/image/srgb.h"
#include "renderlib/import/image/decode_image.h"
#include "renderlib/import/import.h"
#include "renderlib/package/settings_of.h"
#include "renderlib/render/render_band.h"
#include "renderlib/scene/scene.h"

namespace bandsaw {
namespace {
namespace fs = std::filesystem;

struct Options {
  std::string folder;
  std::string only;           ///< part of a scene's path; empty: all scenes
  std::string out;            ///< empty: no images are written
  std::uint64_t samples = 0;  ///< per pixel, of all seeds together; 0: as the budget allows
  std::uint64_t budget = 2'000'000;
  int seeds = 16;
};

/// The result of rendering with several seeds. The vectors have a number for each channel of each
/// pixel, unless stated otherwise.
struct Rendered {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint64_t samples = 0;  ///< samples of a pixel, all seeds together
  std::vector<double> mean;
  std::vector<double> variance;  ///< of the mean
  std::vector<double> whole;     ///< for each seed, the mean of the whole image
  std::vector<std::string> warnings;
};

/// Renders a scene of Mitsuba with all seeds. Fails if the scene cannot be imported, built or
/// rendered.
absl::StatusOr<Rendered> render(const std::string& path, const Options& options, Pool& pool) {
  ImportChoices choices;
  choices.folder = options.folder;
  ASSIGN_OR_RETURN(ImportedScene imported, import_scene(path, choices));
  RenderSettings settings = settings_of(imported.info, std::nullopt, std::nullopt);
  Rendered out;
  out.width = settings.width;
  out.height = settings.height;
  out.warnings = imported.info.warnings;
  const std::uint64_t pixels = std::uint64_t{settings.width} * settings.height;
  const std::uint64_t all = options.samples > 0 ? options.samples : options.budget / pixels;
  const std::uint64_t each =
      std::max<std::uint64_t>(1, all / static_cast<std::uint64_t>(options.seeds));
  out.samples = each * static_cast<std::uint64_t>(options.seeds);
  ASSIGN_OR_RETURN(const auto scene, Scene::build(std::move(imported.scene), pool));
  const std::atomic<bool> stop = false;
  std::vector<double> sum(3 * pixels);
  std::vector<double> squares(3 * pixels);
  for (int seed = 0; seed < options.seeds; ++seed) {
    settings.seed = static_cast<std::uint64_t>(seed);
    std::vector<double> sums(3 * pixels);
    // A node is an aligned range of samples that render_band() can add up in one call.
    for (const SampleRange& node : maximal_nodes(each)) {
      ASSIGN_OR_RETURN(const BandPixels band,
                       render_band(*scene, settings, {node, {0, settings.height}}, pool, stop,
                                   [](std::uint32_t) {}));
      for (std::size_t i = 0; i < sums.size(); ++i) {
        sums[i] += band.sums[i];
      }
    }
    double whole = 0;
    for (std::size_t i = 0; i < sums.size(); ++i) {
      const double value = sums[i] / static_cast<double>(each);
      sum[i] += value;
      squares[i] += value * value;
      whole += value;
    }
    out.whole.push_back(whole / static_cast<double>(sums.size()));
  }
  const double n = options.seeds;
  for (std::size_t i = 0; i < sum.size(); ++i) {
    const double mean = sum[i] / n;
    out.mean.push_back(mean);
    out.variance.push_back(std::max(0.0, squares[i] / n - mean * mean) / std::max(1.0, n - 1));
  }
  return out;
}

/// Reads and decodes an image file. Fails if the file cannot be read or decoded.
absl::StatusOr<Image> read_image(const std::string& path) {
  ASSIGN_OR_RETURN(const std::string bytes, read_whole_file(path, kMaxImageFileBytes));
  return decode_picture(bytes);
}

/// Returns channel number i of the image. The three channels of a pixel have consecutive numbers.
float channel_of(const Image& image, std::size_t i) {
  const Rgb& c = image.pixels[i / 3];
  return i % 3 == 0 ? c.r : i % 3 == 1 ? c.g : c.b;
}

struct Comparison {
  double failing = 0;  ///< share of the channels that fail the test
  /// Share of the channels that fail if the variance of the difference is only the reference's
  /// variance of one sample over the number of samples, as in Mitsuba's tests.
  double strictly = 0;
  double relative = 0;  ///< mean of the rendered image over the mean of the reference, minus 1
  double error = 0;     ///< standard error of `relative`
  std::array<double, 3> channels = {};  ///< `relative` of each channel
  std::vector<double> z;                ///< difference over its standard deviation, of each channel
};

/// Compares the rendered image with the reference, by the test that the comment at the top of this
/// file describes. `variance`: the reference's variance of one sample.
Comparison compare(const Rendered& ours, const Image& reference, const Image& variance) {
  constexpr double kReferenceSamples = 32000;
  const std::size_t channels = ours.mean.size();
  const double pixels = static_cast<double>(channels) / 3;
  const double level = 1 - std::pow(1 - 0.01, 1 / pixels);
  Comparison out;
  double mean = 0;
  double theirs = 0;
  double reference_variance = 0;
  std::array<double, 3> mean_of = {};
  std::array<double, 3> theirs_of = {};
  for (std::size_t i = 0; i < channels; ++i) {
    const double of_one = std::max(1e-4, double{channel_of(variance, i)});
    const double difference = ours.mean[i] - channel_of(reference, i);
    // `alone` is the variance of the difference in Mitsuba's tests. `both` is the variance that the
    // comment at the top of this file describes.
    const double alone = of_one / static_cast<double>(ours.samples);
    const double both = std::max(alone, ours.variance[i]) + of_one / kReferenceSamples;
    // Returns the p-value of the difference if its variance is v.
    const auto p_value = [&](double v) {
      return std::erfc(std::abs(difference) / std::sqrt(2 * v));
    };
    out.failing += p_value(both) < level ? 1 : 0;
    out.strictly += p_value(alone) < level ? 1 : 0;
    out.z.push_back(difference / std::sqrt(both));
    mean += ours.mean[i];
    theirs += channel_of(reference, i);
    mean_of[i % 3] += ours.mean[i];
    theirs_of[i % 3] += channel_of(reference, i);
    reference_variance += of_one / kReferenceSamples;
  }
  out.failing /= static_cast<double>(channels);
  out.strictly /= static_cast<double>(channels);
  out.relative = theirs > 0 ? mean / theirs - 1 : 0;
  for (std::size_t c = 0; c < 3; ++c) {
    out.channels[c] = theirs_of[c] > 0 ? mean_of[c] / theirs_of[c] - 1 : 0;
  }
  double spread = 0;
  for (const double whole : ours.whole) {
    const double off = whole - mean / static_cast<double>(channels);
    spread += off * off;
  }
  const double n = static_cast<double>(ours.whole.size());
  const double of_mean = spread / (n * std::max(1.0, n - 1));
  const double of_reference = reference_variance / (static_cast<double>(channels) * channels);
  out.error = std::sqrt(of_mean + of_reference) * static_cast<double>(channels) / theirs;
  return out;
}

/// Writes the rendered image, the reference and z side by side. z is shown in red where the
/// rendered image is brighter, and in blue where the rendered image is darker. The value of the
/// colour is a fifth of the absolute mean of z over the three channels.
void write_images(const std::string& path, const Rendered& ours, const Image& reference,
                  const Comparison& found) {
  Image all{3 * ours.width, ours.height, {}};
  all.pixels.resize(std::size_t{all.width} * all.height);
  for (std::size_t i = 0; i < reference.pixels.size(); ++i) {
    const std::size_t row = i / ours.width;
    const std::size_t at = row * all.width + i % ours.width;
    const auto color = [&](const std::vector<double>& v) {
      return Rgb{static_cast<float>(v[3 * i]), static_cast<float>(v[3 * i + 1]),
                 static_cast<float>(v[3 * i + 2])};
    };
    all.pixels[at] = color(ours.mean);
    all.pixels[at + ours.width] = reference.pixels[i];
    const Rgb z = color(found.z);
    const float sum = (z.r + z.g + z.b) / 15;
    all.pixels[at + 2 * ours.width] = sum > 0 ? Rgb{sum, 0, 0} : Rgb{0, 0, -sum};
  }
  std::vector<std::uint8_t> codes;
  for (const Rgb& c : all.pixels) {
    for (const float channel : {c.r, c.g, c.b}) {
      codes.push_back(srgb_encode(channel));
    }
  }
  const auto png = encode_png(all.width, all.height, codes);
  if (png.ok()) {
    write_file_atomically(path, *png).IgnoreError();
  }
}

/// Returns "test_spot" for "test_spot_direct".
std::string reference_name(const std::string& stem) { return stem.substr(0, stem.rfind('_')); }

/// Prints a row of the table. Returns false if the scene fails; a scene without a reference passes.
bool run_one(const fs::path& scene, const Options& options, Pool& pool) {
  const std::string stem = scene.stem().string();
  const std::string name = (scene.parent_path().filename() / stem).string();
  const auto ours = render(scene.string(), options, pool);
  if (!ours.ok()) {
    std::printf("| %s | | error | %s | | | |\n", name.c_str(),
                std::string(ours.status().message()).c_str());
    return false;
  }
  for (const std::string& warning : ours->warnings) {
    std::fprintf(stderr, "  %s\n", warning.c_str());
  }
  const std::string base =
      (scene.parent_path() / "refs" / (reference_name(stem) + "_ref_rgb")).string();
  const auto reference = read_image(base + ".exr");
  const auto variance = read_image(base + "_var.exr");
  if (!reference.ok() || !variance.ok()) {
    double mean = 0;
    for (const double whole : ours->whole) {
      mean += whole / static_cast<double>(ours->whole.size());
    }
    std::printf("| %s | %llu | no reference | mean %.4g | | | |\n", name.c_str(),
                static_cast<unsigned long long>(ours->samples), mean);
    return true;
  }
  if (reference->width != ours->width || reference->height != ours->height) {
    std::printf("| %s | | other size | | | | |\n", name.c_str());
    return false;
  }
  const Comparison found = compare(*ours, *reference, *variance);
  const bool passes = found.failing <= 0.0025;
  std::printf(
      "| %s | %llu | %s | %+.2f %% ± %.2f %% | %+.1f, %+.1f, %+.1f %% | %.2f %% | %.2f %% |\n",
      name.c_str(), static_cast<unsigned long long>(ours->samples), passes ? "pass" : "fail",
      100 * found.relative, 100 * found.error, 100 * found.channels[0], 100 * found.channels[1],
      100 * found.channels[2], 100 * found.failing, 100 * found.strictly);
  if (!options.out.empty()) {
    write_images(options.out + "/" + stem + ".png", *ours, *reference, found);
  }
  std::fflush(stdout);
  return passes;
}

/// Renders and compares all selected scenes and prints the table. Returns the exit code: 1 if a
/// scene fails.
int run(const Options& options) {
  std::vector<fs::path> scenes;
  for (const auto& entry : fs::recursive_directory_iterator(options.folder + "/tests/scenes")) {
    const bool in_scene_folder =
        fs::exists(entry.path().parent_path().parent_path().parent_path() / "scenes") &&
        entry.path().parent_path().parent_path().filename() == "scenes";
    if (entry.path().extension() == ".xml" && in_scene_folder &&
        entry.path().string().find(options.only) != std::string::npos) {
      scenes.push_back(entry.path());
    }
  }
  std::sort(scenes.begin(), scenes.end());
  std::printf(
      "| scene | samples a pixel | result | difference of the means | of each channel | "
      "failing channels | failing channels with the reference's variance alone |\n"
      "|---|---|---|---|---|---|---|\n");
  Pool pool(2);
  int failed = 0;
  for (const fs::path& scene : scenes) {
    failed += run_one(scene, options, pool) ? 0 : 1;
  }
  std::printf("\n%d of %zu scenes failed\n", failed, scenes.size());
  return failed == 0 ? 0 : 1;
}

}  // namespace
}  // namespace bandsaw

int main(int argc, char** argv) {
  bandsaw::Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument.rfind("--", 0) != 0) {
      options.folder = std::filesystem::absolute(argument).string();
      continue;
    }
    if (++i == argc) {
      options.folder.clear();
      break;
    }
    const std::string value = argv[i];
    if (argument == "--only") {
      options.only = value;
    } else if (argument == "--out") {
      options.out = value;
    } else if (argument == "--samples") {
      options.samples = std::strtoull(value.c_str(), nullptr, 10);
    } else if (argument == "--budget") {
      options.budget = std::strtoull(value.c_str(), nullptr, 10);
    } else if (argument == "--seeds") {
      options.seeds = std::max(2, std::atoi(value.c_str()));
    }
  }
  if (options.folder.empty()) {
    std::fprintf(stderr,
                 "usage: mitsuba_refs FOLDER [--only NAME] [--samples N] [--budget N] "
                 "[--seeds N] [--out FOLDER]\n");
    return 2;
  }
  return bandsaw::run(options);
}
