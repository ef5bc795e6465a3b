// Runs bandsaw-import as a child with a temporary folder for its output, and reads that output: a
// package (a scene as a manifest and arrays), a converted scene or a picture. A zip file is
// unpacked first, by the same program.

#include "coordinator/cli/scene/import_process.h"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <utility>
#include <variant>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_split.h"
#include "absl/strings/strip.h"
#include "coordinator/cli/base/child_process.h"
#include "coordinator/cli/base/coprocess.h"
#include "coordinator/cli/base/program_folder.h"
#include "coordinator/store/scratch_folder.h"
#include "proto/wire/limits.h"
#include "renderlib/base/atomic_file.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/render/settings.h"

namespace bandsaw::coordinator {
namespace fs = std::filesystem;

absl::StatusOr<std::string> import_program(const ImportLimits& limits) {
  const std::string program =
      limits.program.empty() ? program_folder() + "/bandsaw-import" : limits.program;
  if (access(program.c_str(), X_OK) != 0) {
    return absl::FailedPreconditionError(
        absl::StrCat("the program bandsaw-import, which reads scenes, is missing (looked for ",
                     program, "); install it beside bandsaw"));
  }
  return program;
}

namespace {

// Parses an error in the form "NOT_FOUND: message", which the importer prints. Returns OK for any
// other text. The codes of absl::StatusCode are 1 to 16.
absl::Status reported(const std::string& output) {
  for (int code = 1; code <= 16; ++code) {
    const auto status_code = static_cast<absl::StatusCode>(code);
    const std::string prefix = absl::StrCat(absl::StatusCodeToString(status_code), ": ");
    if (output.compare(0, prefix.size(), prefix) == 0) {
      const std::size_t end = output.find_last_not_of('\n');
      return absl::Status(status_code, output.substr(prefix.size(), end + 1 - prefix.size()));
    }
  }
  return absl::OkStatus();
}

// Returns the error if the importer has failed or was killed, otherwise OK. `file`: the file that
// the importer read. `seconds`: its time limit.
absl::Status judge(const ChildOutcome& outcome, const std::string& file, double seconds) {
  const std::string name = fs::path(file).filename().string();
  const bool signalled = WIFSIGNALED(outcome.wait_status);
  const int signal = signalled ? WTERMSIG(outcome.wait_status) : 0;
  if (outcome.end == ChildOutcome::End::kStopped || signal == SIGINT || signal == SIGTERM) {
    return absl::CancelledError(absl::StrCat(name, ": reading it was interrupted"));
  }
  if (outcome.end == ChildOutcome::End::kTimedOut || signal == SIGXCPU) {
    return absl::DeadlineExceededError(absl::StrFormat(
        "%s: reading it took longer than %g s; it is damaged or too large", name, seconds));
  }
  if (signal == SIGXFSZ) {
    return absl::ResourceExhaustedError(
        absl::StrCat(name, ": a file that the importer makes of it is too large"));
  }
  if (signalled) {
    return absl::DataLossError(absl::StrCat(name, ": the importer crashed (signal ", signal, ", ",
                                            strsignal(signal),
                                            ") while reading this file; it is damaged or not "
                                            "supported"));
  }
  if (WEXITSTATUS(outcome.wait_status) == 0) {
    return absl::OkStatus();
  }
  const absl::Status status = reported(outcome.output);
  return !status.ok() ? status
                      : absl::DataLossError(absl::StrCat(name, ": the importer ended with code ",
                                                         WEXITSTATUS(outcome.wait_status),
                                                         " while reading this file"));
}

// Returns the choices as arguments of the importer (renderlib/import/main.cpp).
std::vector<std::string> arguments_of(const SceneChoices& choices) {
  std::vector<std::string> arguments;
  const auto add = [&](const char* key, const std::string& value) {
    if (!value.empty()) {
      arguments.push_back(absl::StrCat(key, "=", value));
    }
  };
  add("environment", choices.environment);
  add("camera", choices.camera);
  add("folder", choices.folder);
  add("animation", choices.animation);
  if (choices.strict) {
    arguments.push_back("strict");
  }
  for (const std::string& parameter : choices.parameters) {
    arguments.push_back(absl::StrCat("define:", parameter));
  }
  if (choices.frame) {
    add("frame", absl::StrCat(*choices.frame));
    add("fps", choices.fps ? absl::StrFormat("%.17g", *choices.fps) : "");
    add("shutter", choices.shutter ? absl::StrFormat("%.17g", *choices.shutter) : "");
  }
  return arguments;
}

// Returns the command that runs the importer. `what`: the task of the importer ("scene", "frames",
// "text", "image" or "unzip"). `folder`: the folder for its output.
std::vector<std::string> importer_arguments(const std::string& program, const char* what,
                                            const std::string& file, const std::string& folder,
                                            std::uint64_t cpu_seconds, const ImportLimits& limits,
                                            const SceneChoices& choices) {
  std::vector<std::string> arguments = {
      program, what, file, folder, absl::StrCat(cpu_seconds), absl::StrCat(limits.memory_bytes)};
  for (std::string& argument : arguments_of(choices)) {
    arguments.push_back(std::move(argument));
  }
  return arguments;
}

// Runs the importer on `file`. `what`: its task, as for importer_arguments(). Returns the folder
// with its output.
absl::StatusOr<std::unique_ptr<const ScratchFolder>> run_importer(
    const char* what, const std::string& file, const ImportLimits& limits,
    const SceneChoices& choices = {}) {
  ASSIGN_OR_RETURN(const std::string program, import_program(limits));
  ASSIGN_OR_RETURN(std::unique_ptr<const ScratchFolder> folder,
                   ScratchFolder::make("import", limits.scratch));
  const auto cpu_seconds = static_cast<std::uint64_t>(std::ceil(std::max(limits.seconds, 1.0)));
  ASSIGN_OR_RETURN(const ChildOutcome outcome,
                   run_child(importer_arguments(program, what, file, folder->path(), cpu_seconds,
                                                limits, choices),
                             limits.seconds, limits.stop));
  RETURN_IF_ERROR(judge(outcome, file, limits.seconds));
  return folder;
}

// Returns the paths that have the smallest number of folders in them, for example "a.obj" and not
// "models/b.obj".
std::vector<std::string> outermost(std::vector<std::string> names) {
  const auto depth = [](const std::string& name) {
    return std::count(name.begin(), name.end(), '/');
  };
  auto least = std::numeric_limits<std::ptrdiff_t>::max();
  for (const std::string& name : names) {
    least = std::min(least, depth(name));
  }
  std::erase_if(names, [&](const std::string& name) { return depth(name) > least; });
  return names;
}

// Parses `list`, which the importer has written (renderlib/import/main.cpp). Each line has a name
// after the word "made" (the importer has written the file) or "found" (the importer has not
// written the file). The names are checked, because a foreign file may have taken control of the
// importer.
absl::StatusOr<std::vector<ListedFile>> read_file_list(const std::string& list) {
  std::vector<ListedFile> files;
  int made = 0;
  for (absl::string_view line : absl::StrSplit(list, '\n', absl::SkipEmpty())) {
    ListedFile file;
    if (absl::ConsumePrefix(&line, "made ")) {
      file.number = made++;
    } else if (!absl::ConsumePrefix(&line, "found ")) {
      return absl::DataLossError("the importer left a broken list of files");
    }
    file.name = std::string(line);
    const fs::path path(file.name);
    const bool goes_up = std::find(path.begin(), path.end(), "..") != path.end();
    if (path.is_absolute() || goes_up || path.empty()) {
      return absl::DataLossError("the importer left a broken list of files");
    }
    files.push_back(std::move(file));
  }
  return files;
}

// Reads a file that the importer has written, of at most `max_bytes`.
absl::StatusOr<std::string> read_output(const std::string& path, std::uint64_t max_bytes) {
  absl::StatusOr<std::string> bytes = read_whole_file(path, max_bytes);
  return bytes.ok() ? std::move(bytes)
                    : absl::DataLossError(absl::StrCat("the importer did not leave ", path, " (",
                                                       bytes.status().message(), ")"));
}

// Returns the package that the importer has written to the folder.
absl::StatusOr<ImportedPackage> package_in(std::shared_ptr<const ScratchFolder> folder) {
  ASSIGN_OR_RETURN(std::string manifest,
                   read_output(folder->path() + "/manifest", wire::kManifestBytes));
  ASSIGN_OR_RETURN(PackageInfo info, package_info(manifest));
  return ImportedPackage(std::move(folder), std::move(manifest), std::move(info));
}

bool is_zip(const std::string& path) { return absl::EndsWithIgnoreCase(path, ".zip"); }

// Returns the only scene in the archive, by the rules of import_in_process(). INVALID_ARGUMENT:
// there is no scene, or there are several. In the second case, the message names two of them.
absl::StatusOr<std::string> only_scene(const std::vector<ListedFile>& files) {
  const auto named = [&](std::initializer_list<const char*> suffixes) {
    std::vector<std::string> found;
    for (const ListedFile& file : files) {
      if (std::any_of(suffixes.begin(), suffixes.end(), [&](const char* suffix) {
            return absl::EndsWithIgnoreCase(file.name, suffix);
          })) {
        found.push_back(file.name);
      }
    }
    return outermost(std::move(found));
  };
  // .pbrt.gz files come after .pbrt files, because they are mostly parts of a scene. .json files
  // come after glTF files, because beside a glTF file they mostly hold notes about it.
  for (const auto& found : {named({".textproto"}), named({".pbrt", ".xml"}), named({".pbrt.gz"}),
                            named({".glb", ".gltf"}), named({".json"}),
                            named({".obj", ".fbx", ".dae", ".3ds", ".ply", ".stl"})}) {
    if (found.size() == 1) {
      return found.front();
    }
    if (found.size() > 1) {
      return absl::InvalidArgumentError(
          absl::StrCat("holds ", found.size(), " scenes, ", found[0], " and ", found[1],
                       found.size() > 2 ? " among them" : "", "; name one of them"));
    }
  }
  return absl::InvalidArgumentError(
      "holds no scene: .textproto, .json, .pbrt, .pbrt.gz, .xml, or a model");
}

// Unpacks an archive to `to`, an empty folder. Returns the path of the unpacked scene. `wanted`:
// the name of the scene in the archive; empty: the archive's only scene.
absl::StatusOr<std::string> unpack_scene(const std::string& zip, const std::string& wanted,
                                         const std::string& to, const ImportLimits& limits) {
  const std::string name = fs::path(zip).filename().string();
  ASSIGN_OR_RETURN(const auto folder, run_importer("unzip", zip, limits));
  constexpr std::uint64_t kMaxListBytes = std::uint64_t{64} << 20;
  ASSIGN_OR_RETURN(const std::string list, read_output(folder->path() + "/list", kMaxListBytes));
  ASSIGN_OR_RETURN(const std::vector<ListedFile> files, read_file_list(list));
  for (const ListedFile& file : files) {
    if (file.number == ListedFile::kOld) {
      return absl::DataLossError(absl::StrCat(name, ": the importer left a broken list of files"));
    }
    const fs::path target = fs::path(to) / file.name;
    std::error_code error;
    fs::create_directories(target.parent_path(), error);
    if (!error) {
      fs::rename(fs::path(folder->path()) / absl::StrCat(file.number), target, error);
    }
    if (error) {
      return absl::InvalidArgumentError(
          absl::StrCat(name, ": \"", file.name, "\" cannot be unpacked: ", error.message()));
    }
  }
  const auto scene = wanted.empty() ? only_scene(files) : wanted;
  if (!scene.ok()) {
    return absl::InvalidArgumentError(absl::StrCat(name, ": ", scene.status().message()));
  }
  if (std::none_of(files.begin(), files.end(),
                   [&](const ListedFile& file) { return file.name == *scene; })) {
    return absl::NotFoundError(absl::StrCat(name, ": there is no \"", *scene, "\" in it"));
  }
  if (is_zip(*scene)) {  // an archive may contain itself
    return absl::InvalidArgumentError(absl::StrCat(name, ": \"", *scene, "\" is no scene"));
  }
  return (fs::path(to) / *scene).string();
}

}  // namespace

ImportedPackage::ImportedPackage(std::shared_ptr<const ScratchFolder> folder, std::string manifest,
                                 PackageInfo info)
    : folder_(std::move(folder)),
      manifest_(std::move(manifest)),
      info_(std::move(info)),
      blobs_(folder_->path()) {}

ImportedPackage::~ImportedPackage() = default;
ImportedPackage::ImportedPackage(ImportedPackage&&) noexcept = default;
ImportedPackage& ImportedPackage::operator=(ImportedPackage&&) noexcept = default;

double import_timeout_s(const std::string& path, double seconds) {
  constexpr double kBytesPerSecond = 4e6;
  double bytes = 0;
  std::error_code error;
  for (fs::recursive_directory_iterator entry(fs::path(path).parent_path(), error), end;
       entry != end; entry.increment(error)) {
    const bool is_file = entry->is_regular_file(error);
    const std::uintmax_t size = is_file ? entry->file_size(error) : 0;
    bytes += error ? 0 : static_cast<double>(size);
  }
  return seconds + bytes / kBytesPerSecond;
}

absl::StatusOr<ImportedPackage> import_in_process(const std::string& scene_path,
                                                  const ImportLimits& limits,
                                                  const SceneChoices& choices) {
  if (is_zip(scene_path)) {
    ASSIGN_OR_RETURN(const auto unpacked, ScratchFolder::make("import", limits.scratch));
    ASSIGN_OR_RETURN(const std::string inside,
                     unpack_scene(scene_path, choices.inside, unpacked->path(), limits));
    return import_in_process(inside, limits, choices);
  }
  ASSIGN_OR_RETURN(auto folder, run_importer("scene", scene_path, limits, choices));
  return package_in(std::move(folder));
}

absl::StatusOr<std::unique_ptr<ImportSession>> ImportSession::start(const std::string& scene_path,
                                                                    const ImportLimits& limits,
                                                                    SceneChoices choices) {
  std::string scene = scene_path;
  std::shared_ptr<const ScratchFolder> unpacked;
  if (is_zip(scene_path)) {
    ASSIGN_OR_RETURN(unpacked, ScratchFolder::make("import", limits.scratch));
    ASSIGN_OR_RETURN(scene, unpack_scene(scene_path, choices.inside, unpacked->path(), limits));
  }
  ASSIGN_OR_RETURN(const std::string program, import_program(limits));
  ASSIGN_OR_RETURN(std::shared_ptr<const ScratchFolder> folder,
                   ScratchFolder::make("import", limits.scratch));
  // import() sends the number of each frame. The number 0 is only needed because arguments_of()
  // omits `fps` and `shutter` if no frame is set.
  choices.frame = 0;
  // This process limits the time of each frame. The importer limits its total CPU time, but does
  // not know how many frames will come. So the limit of its CPU time is larger than any sequence
  // can need.
  constexpr std::uint64_t kCpuSeconds = 100'000'000;
  ASSIGN_OR_RETURN(auto importer,
                   Coprocess::start(importer_arguments(program, "frames", scene, folder->path(),
                                                       kCpuSeconds, limits, choices)));
  return std::unique_ptr<ImportSession>(new ImportSession(std::move(scene), limits.seconds,
                                                          std::move(unpacked), std::move(folder),
                                                          std::move(importer)));
}

ImportSession::ImportSession(std::string scene, double seconds,
                             std::shared_ptr<const ScratchFolder> unpacked,
                             std::shared_ptr<const ScratchFolder> folder,
                             std::unique_ptr<Coprocess> importer)
    : scene_(std::move(scene)),
      seconds_(seconds),
      unpacked_(std::move(unpacked)),
      folder_(std::move(folder)),
      importer_(std::move(importer)) {}

ImportSession::~ImportSession() = default;

absl::StatusOr<ImportedPackage> ImportSession::import(std::int64_t frame,
                                                      const std::atomic<bool>* stop) {
  const auto answer = importer_->exchange(absl::StrCat(frame), seconds_, stop);
  if (const auto* outcome = std::get_if<ChildOutcome>(&answer)) {
    const absl::Status status = judge(*outcome, scene_, seconds_);
    return !status.ok() ? status : absl::InternalError("the importer ended before its last frame");
  }
  if (const std::string& line = std::get<std::string>(answer); line != "done") {
    const absl::Status status = reported(line);
    return !status.ok() ? status : absl::DataLossError("the importer gave a broken answer");
  }
  return package_in(folder_);
}

absl::StatusOr<SceneFiles> scene_files_in_process(const std::string& scene_path,
                                                  const ImportLimits& limits,
                                                  const SceneChoices& choices) {
  constexpr std::uint64_t kMaxListBytes = std::uint64_t{64} << 20;
  ASSIGN_OR_RETURN(auto folder, run_importer("text", scene_path, limits, choices));
  SceneFiles files;
  ASSIGN_OR_RETURN(files.text, read_output(folder->path() + "/text", wire::kBlobBytes));
  ASSIGN_OR_RETURN(const std::string warnings,
                   read_output(folder->path() + "/warnings", kMaxListBytes));
  files.warnings = absl::StrSplit(warnings, '\n', absl::SkipEmpty());
  ASSIGN_OR_RETURN(const std::string list, read_output(folder->path() + "/list", kMaxListBytes));
  ASSIGN_OR_RETURN(files.list, read_file_list(list));
  files.folder_path = folder->path();
  files.folder = std::shared_ptr<const ScratchFolder>(std::move(folder));
  return files;
}

absl::StatusOr<Image> read_image_in_process(const std::string& path, const ImportLimits& limits) {
  ASSIGN_OR_RETURN(const auto folder, run_importer("image", path, limits));
  constexpr std::uint64_t kMaxBytes = (std::uint64_t{12} * kMaxPixels) + 8;
  ASSIGN_OR_RETURN(const std::string bytes, read_output(folder->path() + "/image", kMaxBytes));
  Image image;
  // The file has the width and the height, in 32 bits each, and then the pixels.
  const std::size_t head = 2 * sizeof(std::uint32_t);
  if (bytes.size() >= head) {
    std::memcpy(&image.width, bytes.data(), sizeof(std::uint32_t));
    std::memcpy(&image.height, bytes.data() + sizeof(std::uint32_t), sizeof(std::uint32_t));
  }
  const std::uint64_t pixels = std::uint64_t{image.width} * image.height;
  if (pixels == 0 || pixels > kMaxPixels || bytes.size() != head + pixels * sizeof(Rgb)) {
    return absl::DataLossError(absl::StrCat("the importer left a broken picture of ", path));
  }
  image.pixels.resize(pixels);
  std::memcpy(static_cast<void*>(image.pixels.data()), bytes.data() + head, bytes.size() - head);
  return image;
}

}  // namespace bandsaw::coordinator
