// Runs Blender in the background with the add-on of deploy/blender. The add-on writes the scene
// file, warnings and errors to a temporary folder. BlendSession keeps one Blender running and
// requests one frame after the other from it.

#include "coordinator/cli/scene/blend_file.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <span>
#include <utility>
#include <variant>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "coordinator/cli/base/child_process.h"
#include "coordinator/cli/base/coprocess.h"
#include "coordinator/web/page_files.h"
#include "renderlib/base/atomic_file.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

namespace fs = std::filesystem;

constexpr double kBlenderTimeout_s = 600;
constexpr std::uint64_t kMaxText = 1 << 20;  ///< bytes of a file with warnings or an error
constexpr char kAddon[] = "bandsaw_blender.zip";
/// Prefix of the line with which the add-on reports that a frame is written.
constexpr char kAnswer[] = "bandsaw: ";
/// The script that Blender runs. Python reads the add-on from its zip file, which is the first of
/// the arguments after "--".
constexpr char kScript[] =
    "import sys; a = sys.argv[sys.argv.index('--') + 1:]; sys.path.insert(0, a[0]); "
    "from bandsaw_blender import headless; headless.main(*a[1:])";

/// Returns the non-empty lines of a file; none if there is no such file.
std::vector<std::string> lines_of(const fs::path& path) {
  const absl::StatusOr<std::string> text = read_whole_file(path.string(), kMaxText);
  return text.ok() ? absl::StrSplit(*text, '\n', absl::SkipEmpty()) : std::vector<std::string>{};
}

/// Writes the add-on, which the dashboard offers as a file as well, to `path`.
absl::Status write_addon(const std::string& path) {
  for (const PageFile& file : page_files()) {
    if (file.name == kAddon) {
      return write_file_atomically(path, std::as_bytes(std::span(file.bytes)));
    }
  }
  return absl::InternalError("this program does not contain the add-on for Blender");
}

/// Returns the last line of Blender's output that has the word "Error". If no line has it, returns
/// the last line.
std::string last_error_line(const std::string& output) {
  const std::vector<std::string> lines = absl::StrSplit(output, '\n', absl::SkipWhitespace());
  const auto error = std::find_if(lines.rbegin(), lines.rend(), [](const std::string& line) {
    return absl::StrContains(line, "Error");
  });
  return lines.empty() ? "it printed nothing" : error != lines.rend() ? *error : lines.back();
}

/// Makes the folder to which Blender writes the scene, with the add-on in it.
absl::StatusOr<std::unique_ptr<BlendScene>> empty_scene(const std::string& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) {
    return absl::NotFoundError(absl::StrCat(path, ": there is no such file"));
  }
  ASSIGN_OR_RETURN(auto folder, ScratchFolder::make("blend"));
  auto made = std::make_unique<BlendScene>(std::move(folder), fs::path(path).stem().string());
  RETURN_IF_ERROR(write_addon(absl::StrCat(made->folder(), "/", kAddon)));
  return made;
}

/// Returns the command that runs the add-on on the file: without a window (-b), without the user's
/// settings, and without the scripts in the file (-Y). `last` is the last argument of the add-on:
/// the number of a frame, or "-" if the add-on shall read the numbers of frames from standard
/// input. If `last` is empty, the add-on gets no such argument, and writes the frame that is saved
/// in the file.
std::vector<std::string> blender_command(const std::string& path, const BlendScene& to,
                                         const std::string& last) {
  std::error_code error;
  const fs::path file = fs::absolute(path, error);
  std::vector<std::string> arguments = {"blender",
                                        "-b",
                                        "--factory-startup",
                                        "-Y",
                                        file.string(),
                                        "--python-expr",
                                        kScript,
                                        "--",
                                        absl::StrCat(to.folder(), "/", kAddon),
                                        to.folder(),
                                        file.stem().string()};
  if (!last.empty()) {
    arguments.push_back(last);
  }
  return arguments;
}

std::string name_of(const std::string& path) { return fs::path(path).filename().string(); }

/// Returns the error of a Blender that could not be started.
absl::Status not_started(const std::string& path, const absl::Status& status) {
  return absl::IsNotFound(status)
             ? absl::FailedPreconditionError(absl::StrCat(
                   name_of(path),
                   ": Blender is not installed on this machine (there is no program `blender` on "
                   "PATH); install it, or render from Blender's window with the add-on"))
             : status;
}

/// Returns the error if Blender was killed, otherwise OK.
absl::Status killed(const std::string& path, const ChildOutcome& outcome) {
  if (outcome.end == ChildOutcome::End::kStopped) {
    return absl::CancelledError(absl::StrCat(name_of(path), ": Blender was interrupted"));
  }
  return outcome.end == ChildOutcome::End::kTimedOut
             ? absl::DeadlineExceededError(absl::StrCat(
                   name_of(path), ": Blender took longer than ", kBlenderTimeout_s, " s"))
             : absl::OkStatus();
}

/// Returns the error of a Blender that has written no scene. `output`: the text that it has
/// printed.
absl::Status no_scene(const std::string& path, const std::string& output) {
  return absl::InvalidArgumentError(
      absl::StrCat(name_of(path), ": Blender made no scene of it: ", last_error_line(output)));
}

/// Reads the files that Blender has written beside the scene. Returns the error in them, or stores
/// the warnings in `made`. `output`: the text that Blender has printed.
absl::Status read_result(const std::string& path, const std::string& output, BlendScene& made) {
  for (const std::string& line : lines_of(fs::path(made.folder()) / "error")) {
    return absl::InvalidArgumentError(absl::StrCat(name_of(path), ": ", line));
  }
  std::error_code error;
  if (!fs::exists(made.scene, error)) {
    return no_scene(path, output);
  }
  made.warnings = lines_of(fs::path(made.folder()) / "warnings");
  return absl::OkStatus();
}

}  // namespace

bool is_blend_file(const std::string& path) { return absl::EndsWithIgnoreCase(path, ".blend"); }

absl::StatusOr<std::unique_ptr<BlendScene>> scene_of_blend_file(const std::string& path,
                                                                const std::atomic<bool>& stop,
                                                                std::optional<std::int64_t> frame) {
  ASSIGN_OR_RETURN(std::unique_ptr<BlendScene> made, empty_scene(path));
  const auto ran = run_child(blender_command(path, *made, frame ? absl::StrCat(*frame) : ""),
                             kBlenderTimeout_s, &stop, {.errors_too = true});
  if (!ran.ok()) {
    return not_started(path, ran.status());
  }
  RETURN_IF_ERROR(killed(path, *ran));
  RETURN_IF_ERROR(read_result(path, ran->output, *made));
  return made;
}

absl::StatusOr<std::unique_ptr<BlendSession>> BlendSession::start(const std::string& path) {
  ASSIGN_OR_RETURN(std::unique_ptr<BlendScene> scene, empty_scene(path));
  auto blender = Coprocess::start(blender_command(path, *scene, "-"), kAnswer, /*errors_too=*/true);
  if (!blender.ok()) {
    return not_started(path, blender.status());
  }
  return std::unique_ptr<BlendSession>(
      new BlendSession(path, std::move(scene), *std::move(blender)));
}

BlendSession::BlendSession(std::string path, std::unique_ptr<BlendScene> scene,
                           std::unique_ptr<Coprocess> blender)
    : path_(std::move(path)), scene_(std::move(scene)), blender_(std::move(blender)) {}

BlendSession::~BlendSession() = default;

absl::StatusOr<const BlendScene*> BlendSession::at(std::int64_t frame,
                                                   const std::atomic<bool>& stop) {
  const auto answer = blender_->exchange(absl::StrCat(frame), kBlenderTimeout_s, &stop);
  if (const auto* outcome = std::get_if<ChildOutcome>(&answer)) {
    RETURN_IF_ERROR(killed(path_, *outcome));
    return no_scene(path_, outcome->output);
  }
  RETURN_IF_ERROR(read_result(path_, "", *scene_));
  return scene_.get();
}

}  // namespace bandsaw::coordinator
