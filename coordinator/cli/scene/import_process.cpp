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
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "coordinator/cli/base/child_process.h"
#include "coordinator/cli/base/program_folder.h"
#include "proto/wire/limits.h"
#include "renderlib/base/atomic_file.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/render/settings.h"

namespace bandsaw::coordinator {
namespace fs = std::filesystem;

class ScratchFolder {
 public:
  explicit ScratchFolder(std::string path) : path_(std::move(path)) {}
  ~ScratchFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

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

absl::StatusOr<std::unique_ptr<ScratchFolder>> make_scratch(const std::string& wanted) {
  std::error_code error;
  const fs::path parent = wanted.empty() ? fs::temp_directory_path(error) : fs::path(wanted);
  std::string pattern = (parent / "bandsaw-import-XXXXXX").string();
  if (error || mkdtemp(pattern.data()) == nullptr) {
    return errno_status(error ? error.value() : errno,
                        absl::StrCat("cannot make a temporary folder in ", parent.string()));
  }
  return std::make_unique<ScratchFolder>(pattern);
}

// Parses an error in the form "NOT_FOUND: message", as printed by the importer.
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

absl::Status judge(const ChildOutcome& outcome, const std::string& file,
                   const ImportLimits& limits) {
  const std::string name = fs::path(file).filename().string();
  const bool signalled = WIFSIGNALED(outcome.wait_status);
  const int signal = signalled ? WTERMSIG(outcome.wait_status) : 0;
  if (outcome.end == ChildOutcome::End::kStopped || signal == SIGINT || signal == SIGTERM) {
    return absl::CancelledError(absl::StrCat(name, ": reading it was interrupted"));
  }
  if (outcome.end == ChildOutcome::End::kTimedOut || signal == SIGXCPU) {
    return absl::DeadlineExceededError(absl::StrFormat(
        "%s: reading it took longer than %g s; it is damaged or too large", name, limits.seconds));
  }
  if (signal == SIGXFSZ) {
    return absl::ResourceExhaustedError(absl::StrCat(name, ": becomes larger than a blob may be"));
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

// Runs the importer on `file`. Returns the folder with its output.
absl::StatusOr<std::unique_ptr<ScratchFolder>> run_importer(const char* what,
                                                            const std::string& file,
                                                            const ImportLimits& limits,
                                                            const SceneChoices& choices = {}) {
  ASSIGN_OR_RETURN(const std::string program, import_program(limits));
  ASSIGN_OR_RETURN(std::unique_ptr<ScratchFolder> folder, make_scratch(limits.scratch));
  const auto cpu_seconds = static_cast<std::uint64_t>(std::ceil(std::max(limits.seconds, 1.0)));
  std::vector<std::string> arguments = {program,
                                        what,
                                        file,
                                        folder->path(),
                                        absl::StrCat(cpu_seconds),
                                        absl::StrCat(limits.memory_bytes)};
  if (!choices.environment.empty() || !choices.camera.empty()) {
    arguments.insert(arguments.end(), {choices.environment, choices.camera});
  }
  ASSIGN_OR_RETURN(const ChildOutcome outcome, run_child(arguments, limits.seconds, limits.stop));
  RETURN_IF_ERROR(judge(outcome, file, limits));
  return folder;
}

// Reads a file that the importer has written, of at most `max_bytes`.
absl::StatusOr<std::string> read_output(const std::string& path, std::uint64_t max_bytes) {
  absl::StatusOr<std::string> bytes = read_whole_file(path, max_bytes);
  return bytes.ok() ? std::move(bytes)
                    : absl::DataLossError(absl::StrCat("the importer did not leave ", path, " (",
                                                       bytes.status().message(), ")"));
}

}  // namespace

ImportedPackage::ImportedPackage(std::unique_ptr<ScratchFolder> folder, std::string manifest,
                                 PackageInfo info)
    : folder_(std::move(folder)),
      manifest_(std::move(manifest)),
      info_(std::move(info)),
      blobs_(folder_->path()) {}

ImportedPackage::~ImportedPackage() = default;
ImportedPackage::ImportedPackage(ImportedPackage&&) noexcept = default;
ImportedPackage& ImportedPackage::operator=(ImportedPackage&&) noexcept = default;

absl::StatusOr<ImportedPackage> import_in_process(const std::string& scene_path,
                                                  const ImportLimits& limits,
                                                  const SceneChoices& choices) {
  ASSIGN_OR_RETURN(auto folder, run_importer("scene", scene_path, limits, choices));
  ASSIGN_OR_RETURN(std::string manifest,
                   read_output(folder->path() + "/manifest", wire::kManifestBytes));
  ASSIGN_OR_RETURN(PackageInfo info, package_info(manifest));
  return ImportedPackage(std::move(folder), std::move(manifest), std::move(info));
}

absl::StatusOr<Image> read_image_in_process(const std::string& path, const ImportLimits& limits) {
  ASSIGN_OR_RETURN(const auto folder, run_importer("image", path, limits));
  constexpr std::uint64_t kMaxBytes = (std::uint64_t{12} * kMaxPixels) + 8;
  ASSIGN_OR_RETURN(const std::string bytes, read_output(folder->path() + "/image", kMaxBytes));
  Image image;
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
