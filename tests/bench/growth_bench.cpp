// Measures how time and memory grow with the size of a scene (README.md). Writes a table to
// standard output, and growth.json and growth_*.svg to the folder.
//
//   growth_bench [--quick] FOLDER    --quick omits the largest sizes

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include "coordinator/cli/base/cpu_time.h"
#include "coordinator/cli/base/json.h"
#include "coordinator/cli/study/log_plot.h"
#include "renderlib/package/blob_folder.h"
#include "renderlib/package/package.h"
#include "renderlib/render/render_band.h"
#include "tests/bench/growth_scenes.h"
#include "tests/bench/measured_apart.h"

namespace bandsaw::bench {
namespace {

using coordinator::JsonObject;
using coordinator::Plot;
using coordinator::process_cpu_seconds;

int threads() { return static_cast<int>(std::max(1U, std::thread::hardware_concurrency())); }

double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Returns the value, or exits with the error.
template <class T>
T must(absl::StatusOr<T> result) {
  if (!result.ok()) {
    std::fprintf(stderr, "%s\n", result.status().ToString().c_str());
    std::_Exit(1);
  }
  return *std::move(result);
}

/// Renders the first `rows` rows with the first `samples` samples.
BandPixels rows_of(const Scene& scene, const RenderSettings& settings, std::uint64_t samples,
                   std::uint32_t rows, Pool& pool) {
  const std::atomic<bool> stop = false;
  return must(render_band(scene, settings, {{0, samples}, {0, rows}}, pool, stop, {}));
}

/// Measures the build and the rendering of the scene of this size.
Figures rendered(const Family& family, double size) {
  Pool pool(threads());
  GrownScene grown = family.scene(size);
  Figures out;
  const double start = wall_seconds();
  const auto scene = must(Scene::build(std::move(grown.scene), pool));
  out.build_s = wall_seconds() - start;
  const double cpu_start = process_cpu_seconds();
  const BandPixels pixels =
      rows_of(*scene, grown.settings, grown.samples, grown.settings.height, pool);
  const double ns = 1e9 * (process_cpu_seconds() - cpu_start);
  out.ns_per_ray = ns / static_cast<double>(pixels.counters.rays);
  out.ns_per_sample = ns / (static_cast<double>(grown.settings.width) * grown.settings.height *
                            static_cast<double>(grown.samples));
  return out;
}

/// Writes the scene of this size to the folder as a package, the form in which workers get scenes:
/// a manifest, and blobs (files of data that are named by their digests). Measures nothing.
Figures packed(const Family& family, double size, const std::string& folder) {
  BlobMap blobs;
  GrownScene grown = family.scene(size);
  const std::string manifest = encode_package(grown.scene, {}, blobs);
  std::ofstream(folder + "/manifest", std::ios::binary) << manifest;
  for (const auto& [digest, bytes] : blobs.all()) {
    std::ofstream(BlobFolder(folder).path_of(digest), std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  }
  return {};
}

/// Measures the time from the files of a package, as a worker has them in its cache, to the first
/// eight rows of an image of 600 x 400.
Figures first_rows(const std::string& folder) {
  const double start = wall_seconds();
  Pool pool(threads());
  std::ifstream file(folder + "/manifest", std::ios::binary);
  const std::string manifest{std::istreambuf_iterator<char>(file), {}};
  BlobFolder blobs(folder);
  const auto scene = must(Scene::build(must(decode_package(manifest, blobs)), pool));
  rows_of(*scene, {.width = 600, .height = 400}, 1, 8, pool);
  Figures out;
  out.first_rows_s = wall_seconds() - start;
  return out;
}

/// Measures first_rows() in a process of its own. The package is made in another process, so that
/// making it does not add to the peak memory.
Figures from_disk(const Family& family, double size) {
  const std::string folder =
      (std::filesystem::temp_directory_path() / ("growth-" + std::to_string(getpid()))).string();
  std::filesystem::create_directory(folder);
  measured_apart([&] { return packed(family, size, folder); });
  const Figures out = measured_apart([&] { return first_rows(folder); });
  std::filesystem::remove_all(folder);
  return out;
}

/// Returns the exponent of growth: the slope of the least-squares line through the points
/// (log size, log value).
double exponent(const std::vector<std::pair<double, double>>& points) {
  double x = 0, y = 0, xx = 0, xy = 0;
  for (const auto& [size, value] : points) {
    x += std::log(size);
    y += std::log(value);
    xx += std::log(size) * std::log(size);
    xy += std::log(size) * std::log(value);
  }
  const auto n = static_cast<double>(points.size());
  return (n * xy - x * y) / (n * xx - x * x);
}

/// A column of the table, which is also drawn as a plot.
struct Column {
  const char* name;
  const char* file;  ///< part of the plot's file name
  double Figures::*figure;
  double unit;  ///< factor by which the figure is multiplied
};
constexpr Column kColumns[] = {
    {"build, s", "build", &Figures::build_s, 1},
    {"ns a sample", "sample", &Figures::ns_per_sample, 1},
    {"ns a ray", "ray", &Figures::ns_per_ray, 1},
    {"peak, MB", "memory", &Figures::peak_bytes, 1e-6},
    {"first rows from disk, s", "first_rows", &Figures::first_rows_s, 1}};

/// The figures of one family, by size. An exponent e means that a figure grows as size^e.
struct Grown {
  std::string name;
  std::vector<std::pair<double, Figures>> by_size;

  /// Returns (size, value in the column's unit) for each size at which the figure was measured.
  std::vector<std::pair<double, double>> points(const Column& column) const {
    std::vector<std::pair<double, double>> out;
    for (const auto& [size, figures] : by_size) {
      if (const double value = figures.*column.figure; value > 0) {
        out.push_back({size, value * column.unit});
      }
    }
    return out;
  }
  std::string exponent_of(const Column& column) const {
    const auto known = points(column);
    char text[32] = "–";
    if (known.size() > 1) {
      std::snprintf(text, sizeof text, "n^%.2f", exponent(known));
    }
    return text;
  }
};

void print_row(const std::string& name, const Figures& figures) {
  std::printf("| %s |", name.c_str());
  for (const Column& column : kColumns) {
    const double value = figures.*column.figure * column.unit;
    value > 0 ? std::printf(" %.3g |", value) : std::printf(" – |");
  }
  std::puts("");
  std::fflush(stdout);
}

/// Measures a family at each of its sizes. Prints a row for each size, and a row of exponents.
Grown measure(const Family& family) {
  Grown out{family.name, {}};
  for (const double size : family.sizes) {
    Figures figures = measured_apart([&] { return rendered(family, size); });
    if (family.name == "triangles") {
      const Figures disk = from_disk(family, size);
      figures.first_rows_s = disk.first_rows_s;
      figures.peak_bytes = disk.peak_bytes;  // without the generated mesh
    }
    char name[64];
    std::snprintf(name, sizeof name, "%s: %.0f", family.name.c_str(), size);
    print_row(name, figures);
    out.by_size.push_back({size, figures});
  }
  std::printf("| exponent of growth: %s |", family.name.c_str());
  for (const Column& column : kColumns) {
    std::printf(" %s |", out.exponent_of(column).c_str());
  }
  std::puts("");
  return out;
}

/// Returns the speed of all threads relative to that of one thread. The two take turns, and the
/// minimum time of each counts.
double thread_speedup() {
  const Family cornell = families(true).back();  // "depth": a Cornell box
  GrownScene grown = cornell.scene(8);           // paths of at most 8 scatterings
  Pool one(1);
  Pool all(threads());
  const auto scene = must(Scene::build(std::move(grown.scene), all));
  double least[2] = {1e9, 1e9};
  for (int round = 0; round < 7; ++round) {
    for (int i = 0; i < 2; ++i) {
      const double start = wall_seconds();
      rows_of(*scene, grown.settings, grown.samples, grown.settings.height, i == 0 ? one : all);
      least[i] = std::min(least[i], wall_seconds() - start);
    }
  }
  return least[0] / least[1];
}

void write_json(const std::vector<Grown>& all, double speedup, const std::string& folder) {
  JsonObject json;
  json.text("schema", "bandsaw.growth/1");
  json.whole("threads", static_cast<std::uint64_t>(threads()));
  json.number("speedup_of_threads", speedup);
  for (const Grown& grown : all) {
    std::vector<JsonObject> rows;
    for (const auto& [size, figures] : grown.by_size) {
      JsonObject row;
      row.number("n", size);
      for (const Column& column : kColumns) {
        const double value = figures.*column.figure * column.unit;
        row.known_number(column.name, value > 0 ? value : -1);  // 0: it was not measured
      }
      rows.push_back(row);
    }
    json.objects(grown.name, rows);
  }
  std::ofstream(folder + "/growth.json") << json.lines();
}

/// Writes a plot for each column, with a line for each family.
void draw(const std::vector<Grown>& all, const std::string& folder) {
  for (const Column& column : kColumns) {
    Plot plot{.x = "size", .y = column.name, .panels = {{.title = column.name, .lines = {}}}};
    for (const Grown& grown : all) {
      if (auto points = grown.points(column); !points.empty()) {
        plot.panels[0].lines.push_back({grown.name, grown.exponent_of(column), std::move(points)});
      }
    }
    std::ofstream(folder + "/growth_" + column.file + ".svg") << coordinator::svg_of(plot);
  }
}

void run(bool quick, const std::string& folder) {
  std::filesystem::create_directories(folder);
  std::printf("|  |");
  for (const Column& column : kColumns) {
    std::printf(" %s |", column.name);
  }
  std::puts("\n| --- | --- | --- | --- | --- | --- |");
  std::vector<Grown> all;
  for (const Family& family : families(quick)) {
    all.push_back(measure(family));
  }
  const double speedup = thread_speedup();
  std::printf("\n%d threads: %.2f times the speed of one.\n", threads(), speedup);
  write_json(all, speedup, folder);
  draw(all, folder);
}

}  // namespace
}  // namespace bandsaw::bench

int main(int argc, char** argv) {
  const bool quick = argc > 1 && std::string(argv[1]) == "--quick";
  if (argc != (quick ? 3 : 2)) {
    std::fputs("usage: growth_bench [--quick] FOLDER\n", stderr);
    return 2;
  }
  bandsaw::bench::run(quick, argv[argc - 1]);
  return 0;
}
