// Measures the time until the first pixels of a job arrive, and the accuracy of the reported
// remaining time.

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <regex>

#include "renderlib/base/check.h"
#include "tests/bench/farm_figures.h"
#include "tests/farm/farm_processes.h"

namespace bandsaw::bench {
namespace {

using test::FarmProcesses;
using test::Process;

constexpr int kRuns = 5;   // runs with each scene of first_pixel_figures()
constexpr int kSeeds = 4;  // runs, with different seeds, of each job of time_left_figure()

std::string gallery(const std::string& scene) {
  return std::string(BANDSAW_GALLERY) + "/" + scene + ".textproto";
}

/// Returns the number in a field of a line of JSON; NaN if it is absent or null.
double number(const std::string& line, const std::string& field) {
  std::smatch found;
  const std::regex pattern("\"" + field + "\":([-+.e0-9]+)");
  return std::regex_search(line, found, pattern) ? std::stod(found[1]) : std::nan("");
}

/// Returns the seconds from the start of `bandsaw submit` to its first report of finished samples,
/// and cancels the job.
double first_pixels(const FarmProcesses& farm, const std::string& scene, int seed) {
  static const std::regex some(R"("samples_done":[1-9])");
  const Clock::time_point begin = Clock::now();
  Process client =
      Process::start(farm.command({"submit", scene, "--json", "--samples", "4096", "--seed",
                                   std::to_string(seed), "-o", farm.path("first.pfm")}));
  BANDSAW_CHECK(client.wait_until([](const std::string& out, const std::string&) {
    return std::regex_search(out, some);
  }),
                client.err().c_str());
  const double took = seconds_since(begin);
  const auto job = static_cast<int>(number(client.out(), "job"));
  client.signal(SIGKILL);
  const test::Finished cancelled = test::run(farm.command({"cancel", std::to_string(job)}));
  BANDSAW_CHECK(cancelled.code == 0, cancelled.err.c_str());
  return took;
}

/// Writes a scene with a height field of 522,242 triangles (10 MB as a file, 9.4 MB in the package
/// that is sent to workers). Returns the path of the scene. The scene differs for each `seed`, so
/// that no machine has it already.
std::string hills(const FarmProcesses& farm, int seed) {
  constexpr int kSide = 512;
  const std::string name = "hills" + std::to_string(seed);
  std::ofstream file(farm.path(name + ".ply"), std::ios::binary);
  file << "ply\nformat binary_little_endian 1.0\nelement vertex " << kSide * kSide
       << "\nproperty float x\nproperty float y\nproperty float z\nelement face "
       << 2 * (kSide - 1) * (kSide - 1) << "\nproperty list uchar int vertex_indices\nend_header\n";
  for (int i = 0; i < kSide * kSide; ++i) {
    const float x = static_cast<float>(i % kSide) / kSide - 0.5F;
    const float z = static_cast<float>(i / kSide) / kSide - 0.5F;
    const float place[] = {
        x, 0.05F * std::sin(20 * x + static_cast<float>(seed)) * std::cos(30 * z), z};
    file.write(reinterpret_cast<const char*>(place), sizeof(place));
  }
  for (int y = 0; y + 1 < kSide; ++y) {
    for (int x = 0; x + 1 < kSide; ++x) {
      const std::int32_t a = y * kSide + x;
      for (const auto& corners :
           {std::array{a, a + kSide, a + 1}, std::array{a + 1, a + kSide, a + kSide + 1}}) {
        file.put(3);
        file.write(reinterpret_cast<const char*>(corners.data()), sizeof(corners));
      }
    }
  }
  const std::string scene = farm.path(name + ".textproto");
  std::ofstream(scene) << "camera { position: [0, 0.6, 1] look_at: [0, 0, 0] vertical_fov: 45 }\n"
                          "image { width: 600 height: 400 }\n"
                          "model { file: \"" +
                              name + ".ply\" }\n";
  return scene;
}

struct Job {
  std::string scene;
  std::vector<std::string> options;
};

/// Runs a job to its end. Takes the first report after a quarter of the job's whole time. Returns
/// the relative error of the remaining time in this report; NaN if the report has none.
double error_of_time_left(const FarmProcesses& farm, const Job& job, int seed) {
  std::vector<std::string> arguments = {
      "submit", gallery(job.scene),   "--json", "--seed", std::to_string(seed),
      "-o",     farm.path("left.pfm")};
  arguments.insert(arguments.end(), job.options.begin(), job.options.end());
  const test::Finished finished = test::run(farm.command(arguments));
  BANDSAW_CHECK(finished.code == 0, finished.err.c_str());
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < finished.out.size();) {
    const std::size_t end = std::min(finished.out.find('\n', at), finished.out.size());
    lines.push_back(finished.out.substr(at, end - at));
    at = end + 1;
  }
  const double whole = number(lines.back(), "elapsed_s");
  const auto told = std::find_if(lines.begin(), lines.end(), [&](const std::string& line) {
    return number(line, "elapsed_s") >= whole / 4;
  });
  BANDSAW_CHECK(told != lines.end(), "the last line has the time");
  return number(*told, "remaining_s") / (whole - number(*told, "elapsed_s")) - 1;
}

}  // namespace

std::vector<Figure> first_pixel_figures() {
  Figure known{"first pixels after submit, package known to the workers", "≤ 0.3 s", " s", {}, ""};
  Figure large{
      "first pixels after submit, a scene of 10 MB that nobody has", "≤ 2 s", " s", {}, ""};
  FarmProcesses farm;
  farm.add_worker("one", 1);
  farm.add_worker("two", 1);
  first_pixels(farm, gallery("cornell"), 0);  // after this, the workers have the package
  for (int i = 1; i <= kRuns; ++i) {
    known.measured.push_back(first_pixels(farm, gallery("cornell"), i));
    large.measured.push_back(first_pixels(farm, hills(farm, i), i));
  }
  return {known, large};
}

Figure time_left_figure() {
  const std::vector<Job> jobs = {
      {"cornell", {"--width", "200", "--height", "200", "--samples", "256"}},
      {"spheres", {"--width", "200", "--height", "150", "--samples", "1024"}},
      {"mesh", {"--width", "200", "--height", "150", "--samples", "1024"}},
      {"books/one_weekend", {"--width", "200", "--height", "112", "--samples", "1024"}},
      {"room", {"--width", "160", "--height", "120", "--samples", "256"}},
      {"environment", {"--width", "200", "--height", "150", "--samples", "512"}},
      {"cornell", {"--width", "400", "--height", "400", "--samples", "64"}},
      {"books/one_weekend", {"--width", "400", "--height", "225", "--error", "0.8%"}},
      {"spheres", {"--width", "400", "--height", "300", "--error", "0.7%"}},
      {"cornell", {"--width", "300", "--height", "300", "--error", "2%"}},
  };
  Figure figure{
      "time left after a quarter of the job", "within 15 % on 90 % of jobs", " %", {}, ""};
  FarmProcesses farm;
  farm.add_worker("one", 1);
  farm.add_worker("two", 1);
  std::size_t within = 0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    for (const Job& job : jobs) {
      const double error = error_of_time_left(farm, job, seed);
      if (std::abs(error) <= 0.15) {
        ++within;
      } else {
        figure.remark +=
            job.scene + " " + job.options.back() +
            (std::isnan(error) ? ": no time left was reported; " : ": not within 15 %; ");
      }
      if (!std::isnan(error)) {
        figure.measured.push_back(100 * error);
      }
    }
  }
  figure.remark +=
      std::to_string(within) + " of " + std::to_string(kSeeds * jobs.size()) + " within 15 %";
  return figure;
}

}  // namespace bandsaw::bench
