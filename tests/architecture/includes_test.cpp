// Rules about the source text: which folder includes which (the README of each part shows the
// allowed dependencies), which functions renderlib may call, and that each type has one header. An
// id such as Y5 in a test's name is that of a case in tests/hard_cases/cases.txt.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "tests/support/hard_case.h"

namespace {

namespace fs = std::filesystem;

// For each folder: the other folders whose headers it may include. A folder may also include its
// own headers, and all headers that the named folders may include.
const std::map<std::string, std::set<std::string>> kMayInclude = {
    {"proto/wire", {}},
    {"proto/link", {"proto/wire"}},
    {"proto/convert", {"renderlib/render"}},
    {"renderlib/base", {}},
    {"renderlib/math", {"renderlib/base"}},
    {"renderlib/sampling", {"renderlib/math"}},
    {"renderlib/geometry", {"renderlib/math"}},
    {"renderlib/accel", {"renderlib/geometry"}},
    {"renderlib/image", {"renderlib/math"}},
    {"renderlib/texture", {"renderlib/image"}},
    {"renderlib/material", {"renderlib/texture", "renderlib/sampling", "renderlib/geometry"}},
    {"renderlib/camera", {"renderlib/geometry", "renderlib/sampling"}},
    {"renderlib/medium", {"renderlib/sampling"}},
    {"renderlib/guiding", {"renderlib/sampling"}},
    {"renderlib/light", {"renderlib/material", "renderlib/geometry", "renderlib/sampling"}},
    {"renderlib/scene",
     {"renderlib/accel", "renderlib/light", "renderlib/camera", "renderlib/medium",
      "renderlib/guiding"}},
    {"renderlib/integrate", {"renderlib/scene"}},
    {"renderlib/denoise", {"renderlib/image"}},
    {"renderlib/render", {"renderlib/integrate", "renderlib/denoise"}},
    {"renderlib/compare", {"renderlib/render"}},
    {"renderlib/package", {"renderlib/render", "proto/wire"}},
    {"renderlib/import/files", {"renderlib/base"}},
    {"renderlib/import/image", {"renderlib/package"}},
    {"renderlib/import/animation", {"renderlib/math"}},
    {"renderlib/import/draft",
     {"renderlib/import/animation", "renderlib/import/image", "renderlib/import/files"}},
    {"renderlib/import/gltf", {"renderlib/import/animation", "renderlib/import/files"}},
    {"renderlib/import/model", {"renderlib/import/draft", "renderlib/import/gltf"}},
    {"renderlib/import/volume", {"renderlib/medium"}},
    {"renderlib/import/scene_file", {"renderlib/import/model", "renderlib/import/volume"}},
    {"renderlib/import/convert", {"renderlib/import/files", "renderlib/image"}},
    {"renderlib/import/spectrum", {"renderlib/import/files", "renderlib/math"}},
    {"renderlib/import/pbrt",
     {"renderlib/import/convert", "renderlib/import/spectrum", "renderlib/import/image"}},
    {"renderlib/import/mitsuba",
     {"renderlib/import/convert", "renderlib/import/spectrum", "renderlib/import/image"}},
    {"renderlib/import",
     {"renderlib/import/scene_file", "renderlib/import/pbrt", "renderlib/import/mitsuba"}},
    {"renderlib/gallery", {"renderlib/texture", "renderlib/light"}},
    {"coordinator/scheduler/api", {"renderlib/render", "proto/wire"}},
    {"coordinator/scheduler/model", {"coordinator/scheduler/api"}},
    {"coordinator/scheduler/context", {"coordinator/scheduler/model"}},
    {"coordinator/scheduler/dispatch", {"coordinator/scheduler/context"}},
    {"coordinator/scheduler/jobs", {"coordinator/scheduler/dispatch"}},
    {"coordinator/scheduler/liveness", {"coordinator/scheduler/jobs"}},
    {"coordinator/scheduler/trust", {"coordinator/scheduler/liveness"}},
    {"coordinator/scheduler/views", {"coordinator/scheduler/liveness"}},
    {"coordinator/scheduler/replay", {"coordinator/scheduler/trust"}},
    {"coordinator/scheduler", {"coordinator/scheduler/replay", "coordinator/scheduler/views"}},
    {"coordinator/convert", {"coordinator/scheduler/api", "proto/convert"}},
    {"coordinator/store", {"coordinator/scheduler/api", "renderlib/package"}},
    {"coordinator/engine", {"coordinator/store", "coordinator/scheduler"}},
    {"coordinator/rpc", {"coordinator/engine", "coordinator/convert", "proto/link"}},
    {"coordinator/web", {"coordinator/rpc"}},
    {"coordinator/cli/base", {"coordinator/scheduler/model"}},
    {"coordinator/cli/options", {"coordinator/cli/base", "proto/link"}},
    {"coordinator/cli/progress", {"coordinator/cli/options", "coordinator/convert"}},
    // This folder includes `web` because of the add-on for Blender, which is among the files that
    // the dashboard offers.
    {"coordinator/cli/scene", {"coordinator/cli/options", "coordinator/web", "renderlib/package"}},
    {"coordinator/cli/image",
     {"coordinator/cli/progress", "coordinator/cli/scene", "renderlib/compare"}},
    {"coordinator/cli/render", {"coordinator/cli/image", "coordinator/engine"}},
    {"coordinator/cli/farm", {"coordinator/cli/image", "coordinator/engine"}},
    {"coordinator/cli/machines", {"coordinator/cli/farm", "coordinator/web"}},
    {"coordinator/cli/study", {"coordinator/cli/farm"}},
    {"coordinator/cli/serve", {"coordinator/cli/machines"}},
    {"coordinator/cli", {"coordinator/cli/machines", "coordinator/cli/study"}},
    {"worker/cache", {"renderlib/package"}},
    {"worker/executor", {"worker/cache", "renderlib/render"}},
    {"worker/session", {"worker/executor", "proto/convert", "proto/link"}},
    {"worker/browser", {"worker/session"}},
    {"worker", {"worker/session"}},
};

/// Returns the folders whose headers `folder` may include, itself among them.
std::set<std::string> reachable(const std::string& folder) {
  std::set<std::string> seen = {folder};
  std::vector<std::string> open = {folder};
  while (!open.empty()) {
    const std::string next = open.back();
    open.pop_back();
    for (const std::string& to : kMayInclude.at(next)) {
      if (seen.insert(to).second) {
        open.push_back(to);
      }
    }
  }
  return seen;
}

bool is_source(const fs::path& path) {
  return path.extension() == ".h" || path.extension() == ".cpp";
}

std::vector<fs::path> sources() {
  std::vector<fs::path> out;
  for (const char* top : {"proto", "renderlib", "coordinator", "worker"}) {
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(BANDSAW_SOURCE) / top)) {
      if (entry.is_regular_file() && is_source(entry.path())) {
        out.push_back(fs::relative(entry.path(), BANDSAW_SOURCE));
      }
    }
  }
  return out;
}

std::vector<std::string> lines_of(const fs::path& source) {
  std::ifstream file(fs::path(BANDSAW_SOURCE) / source);
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) {
    lines.push_back(line);
  }
  return lines;
}

TEST(Architecture, EveryIncludeFollowsTheAllowedDependencies) {
  const std::regex include("^#include \"([^\"]+)/[^/\"]+\"");
  std::size_t checked = 0;
  for (const fs::path& source : sources()) {
    const std::string folder = source.parent_path().string();
    ASSERT_TRUE(kMayInclude.contains(folder)) << folder << " is not in kMayInclude";
    const std::set<std::string> allowed = reachable(folder);
    for (const std::string& line : lines_of(source)) {
      std::smatch match;
      if (!std::regex_search(line, match, include) || !kMayInclude.contains(match[1])) {
        continue;  // third-party, or generated; the next test checks proto/*.pb.h
      }
      ++checked;
      EXPECT_TRUE(allowed.contains(match[1])) << source << " includes from " << match[1];
    }
  }
  EXPECT_GT(checked, 100u);  // fewer: the pattern has missed some
}

// Only renderlib/package and renderlib/import may use Protobuf. Assimp, too, is allowed in these
// two folders only.
TEST(Architecture, OnlyPackageAndImportUseProtobufInRenderlib) {
  for (const fs::path& source : sources()) {
    const std::string folder = source.parent_path().string();
    if (!folder.starts_with("renderlib/") || folder == "renderlib/package" ||
        folder.starts_with("renderlib/import")) {
      continue;
    }
    for (const std::string& line : lines_of(source)) {
      EXPECT_FALSE(line.starts_with("#include") && (line.find(".pb.h") != std::string::npos ||
                                                    line.find("google/") != std::string::npos ||
                                                    line.find("assimp/") != std::string::npos))
          << source << ": " << line;
    }
  }
}

// Pixels are equal on every machine, so renderlib must not call functions whose results depend on
// the C library, on the standard library's implementation or on hidden state.
TEST(Architecture, Y5_RenderlibCallsNoMachineDependentFunction) {
  const std::regex banned(
      R"(\bstd::(sin|cos|tan|asin|acos|atan|atan2|exp|exp2|expm1|log|log2|log10|log1p|pow|cbrt|hypot)\()"
      R"(|\bstd::(uniform_\w+_distribution|normal_distribution|shuffle|reduce|random_device|mt19937\w*)\b)"
      R"(|(^|[^\w.>])(rand|srand|drand48|time|clock|getenv)\(|_mm\w*_(rcp|rsqrt)|\blong double\b|steady_clock|system_clock)");
  for (const fs::path& source : sources()) {
    if (!source.string().starts_with("renderlib/")) {
      continue;
    }
    for (const std::string& line : lines_of(source)) {
      const std::string code = line.substr(0, line.find("//"));
      EXPECT_FALSE(std::regex_search(code, banned)) << source << ": " << line;
    }
  }
  bandsaw::test::report_hard_case("Y5",
                                  "renderlib calls no approximate reciprocal and no function whose "
                                  "results differ between machines");
}

// Every dimension of a sample has a fixed index (sampling/sampler.h). Rejection sampling would use
// an unknown number of dimensions. The test therefore forbids loops without a count in the folders
// that map samples.
TEST(Architecture, R7_SamplesAreMappedWithoutRejection) {
  const std::regex loop(R"(\b(while|do)\b\s*[({]|for \(;;\))");
  for (const fs::path& source : sources()) {
    const std::string folder = source.parent_path().string();
    if (folder != "renderlib/sampling" && folder != "renderlib/material" &&
        folder != "renderlib/camera") {
      continue;
    }
    for (const std::string& line : lines_of(source)) {
      const std::string code = line.substr(0, line.find("//"));
      EXPECT_FALSE(std::regex_search(code, loop)) << source << ": " << line;
    }
  }
  bandsaw::test::report_hard_case("R7",
                                  "no while, do or endless for loop in the code that maps samples");
}

/// Returns the types that headers define, each as "namespace::name", with their headers.
std::map<std::string, std::set<std::string>> types_of_headers() {
  const std::regex opens(R"(^namespace ([\w:]+) \{$)");
  const std::regex defines(R"(^(?:struct|class|enum class) (?:alignas\(\w+\) )?([\w:]+)[^;]*\{)");
  std::map<std::string, std::set<std::string>> found;
  for (const fs::path& source : sources()) {
    if (source.extension() != ".h") {
      continue;
    }
    std::vector<std::string> within;
    for (const std::string& line : lines_of(source)) {
      std::smatch match;
      if (std::regex_search(line, match, opens)) {
        within.push_back(match[1]);
      } else if (line.starts_with("}  // namespace") && !within.empty()) {
        within.pop_back();
      } else if (std::regex_search(line, match, defines)) {
        std::string name;
        for (const std::string& space : within) {
          name += space + "::";
        }
        found[name + match[1].str()].insert(source.string());
      }
    }
  }
  return found;
}

// If two headers define types of the same name and no file includes both, no compiler reports the
// clash. The linker then treats them as a single type and mixes their inline members.
TEST(Architecture, ATypeIsDefinedInOneHeader) {
  const auto found = types_of_headers();
  EXPECT_GT(found.size(), 300u);  // fewer: the patterns have missed some
  // A type in nested namespaces, as an example: the patterns find it under its full name.
  EXPECT_TRUE(found.contains("bandsaw::coordinator::action::Lease"));
  for (const auto& [name, where] : found) {
    EXPECT_EQ(where.size(), 1u) << name << " is defined in " << *where.begin() << " and in "
                                << *where.rbegin();
  }
}

}  // namespace
