#include "coordinator/cli/scene/blend_file.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <span>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "coordinator/cli/base/child_process.h"
#include "coordinator/web/page_files.h"
#include "renderlib/base/atomic_file.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

namespace fs = std::filesystem;

constexpr double kPatience_s = 600;
constexpr std::uint64_t kMaxText = 1 << 20;
constexpr char kAddon[] = "bandsaw_blender.zip";
/// Python reads the add-on from its zip. The arguments follow "--".
constexpr char kScript[] =
    "import sys; a = sys.argv[sys.argv.index('--') + 1:]; sys.path.insert(0, a[0]); "
    "from bandsaw_blender import headless; headless.main(*a[1:])";

/// Returns the non-empty lines of a file; none if there is no such file.
std::vector<std::string> lines_of(const fs::path& path) {
  const absl::StatusOr<std::string> text = read_whole_file(path.string(), kMaxText);
  return text.ok() ? absl::StrSplit(*text, '\n', absl::SkipEmpty()) : std::vector<std::string>{};
}

absl::Status write_addon(const std::string& path) {
  for (const PageFile& file : page_files()) {
    if (file.name == kAddon) {
      return write_file_atomically(path, std::as_bytes(std::span(file.bytes)));
    }
  }
  return absl::InternalError("this program does not contain the add-on for Blender");
}

/// Returns the last line of Blender's output that tells of an error, else its last line.
std::string last_words(const std::string& output) {
  const std::vector<std::string> lines = absl::StrSplit(output, '\n', absl::SkipWhitespace());
  const auto error = std::find_if(lines.rbegin(), lines.rend(), [](const std::string& line) {
    return absl::StrContains(line, "Error");
  });
  return lines.empty() ? "it printed nothing" : error != lines.rend() ? *error : lines.back();
}

absl::Status run_blender(const std::string& path, const std::vector<std::string>& arguments,
                         const std::atomic<bool>& stop, std::string& output) {
  const std::string name = fs::path(path).filename().string();
  const absl::StatusOr<ChildOutcome> ran =
      run_child(arguments, kPatience_s, &stop, {.errors_too = true});
  if (absl::IsNotFound(ran.status())) {
    return absl::FailedPreconditionError(
        absl::StrCat(name,
                     ": Blender is not installed on this machine (there is no program `blender` on "
                     "PATH); install it, or render from Blender's window with the add-on"));
  }
  RETURN_IF_ERROR(ran.status());
  if (ran->end == ChildOutcome::End::kStopped) {
    return absl::CancelledError(absl::StrCat(name, ": Blender was interrupted"));
  }
  if (ran->end == ChildOutcome::End::kTimedOut) {
    return absl::DeadlineExceededError(
        absl::StrCat(name, ": Blender took longer than ", kPatience_s, " s"));
  }
  output = ran->output;
  return absl::OkStatus();
}

}  // namespace

bool is_blend_file(const std::string& path) { return absl::EndsWithIgnoreCase(path, ".blend"); }

BlendScene::~BlendScene() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

absl::StatusOr<std::unique_ptr<BlendScene>> scene_of_blend_file(const std::string& path,
                                                                const std::atomic<bool>& stop,
                                                                std::optional<std::int64_t> frame) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) {
    return absl::NotFoundError(absl::StrCat(path, ": there is no such file"));
  }
  const fs::path file = fs::absolute(path, error);
  std::string folder = (fs::temp_directory_path(error) / "bandsaw-blend-XXXXXX").string();
  if (error || mkdtemp(folder.data()) == nullptr) {
    return errno_status(error ? error.value() : errno, "cannot make a temporary folder");
  }
  const std::string stem = file.stem().string();
  auto made = std::make_unique<BlendScene>(folder, absl::StrCat(folder, "/", stem, ".json"));
  const std::string addon = absl::StrCat(folder, "/", kAddon);
  RETURN_IF_ERROR(write_addon(addon));
  std::string output;
  std::vector<std::string> arguments = {"blender", "-b",          "--factory-startup",
                                        "-Y",      file.string(), "--python-expr",
                                        kScript,   "--",          addon,
                                        folder,    stem};
  if (frame) {
    arguments.push_back(absl::StrCat(*frame));
  }
  RETURN_IF_ERROR(run_blender(path, arguments, stop, output));
  for (const std::string& line : lines_of(fs::path(folder) / "error")) {
    return absl::InvalidArgumentError(absl::StrCat(file.filename().string(), ": ", line));
  }
  if (!fs::exists(made->scene, error)) {
    return absl::InvalidArgumentError(absl::StrCat(
        file.filename().string(), ": Blender made no scene of it: ", last_words(output)));
  }
  made->warnings = lines_of(fs::path(folder) / "warnings");
  return made;
}

}  // namespace bandsaw::coordinator
