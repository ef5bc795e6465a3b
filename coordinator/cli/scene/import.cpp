// The command `bandsaw import`: converts a scene of pbrt or Mitsuba, or a model, to a scene file,
// and writes it with the meshes and images that it names.

#include <atomic>
#include <filesystem>
#include <span>

#include "absl/strings/str_cat.h"
#include "coordinator/cli/base/json.h"
#include "coordinator/cli/options/commands.h"
#include "coordinator/cli/scene/import_scene_file.h"
#include "renderlib/base/atomic_file.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMaxFileBytes = std::uint64_t{8} << 30;  // of a mesh or an image

/// A file to write beside the scene file.
struct Output {
  fs::path from;  ///< file with the bytes
  fs::path to;    ///< where they are written
};

/// Returns the path of the scene file to write: -o, or the name of the scene with .textproto in the
/// current folder.
fs::path output_of(const ImportOptions& options) {
  if (!options.output.empty()) {
    return options.output;
  }
  const fs::path name = fs::path(options.scene).filename();
  const fs::path unpacked = name.extension() == ".gz" ? name.stem() : name;
  return unpacked.stem() += ".textproto";
}

/// Returns the files to write beside the scene file: those that the importer has written, and those
/// that are in the folder of the converted scene. The files of this folder are omitted if the scene
/// file is written to the same folder. PERMISSION_DENIED: a file that should be in the folder of
/// the converted scene is not there, for example because a symbolic link leads out of this folder.
absl::StatusOr<std::vector<Output>> outputs_of(const SceneFiles& files, const std::string& scene,
                                               const fs::path& target_folder) {
  std::error_code error;
  const fs::path old_folder = fs::canonical(scene, error).parent_path();
  const bool stays = fs::equivalent(old_folder, target_folder, error);
  std::vector<Output> outputs;
  for (const ListedFile& file : files.list) {
    const fs::path to = target_folder / file.name;
    if (file.number != ListedFile::kOld) {
      outputs.push_back({fs::path(files.folder_path) / absl::StrCat(file.number), to});
      continue;
    }
    const fs::path from = fs::canonical(old_folder / file.name, error);
    const fs::path within = from.lexically_relative(old_folder);
    if (error || within.empty() || *within.begin() == "..") {
      return absl::PermissionDeniedError(
          absl::StrCat(file.name, ": is not in the scene's folder any more"));
    }
    if (!stays) {
      outputs.push_back({from, to});
    }
  }
  return outputs;
}

/// Writes the file, unless a file with the same bytes is at the target already. ALREADY_EXISTS: a
/// file with other bytes is at the target, and `force` is false.
absl::Status write_output(const Output& output, bool force) {
  ASSIGN_OR_RETURN(const std::string bytes, read_whole_file(output.from, kMaxFileBytes));
  if (file_exists(output.to)) {
    const auto there = read_whole_file(output.to, kMaxFileBytes);
    if (there.ok() && *there == bytes) {
      return absl::OkStatus();
    }
    if (!force) {
      return absl::AlreadyExistsError(
          absl::StrCat(output.to.string(), " exists; --force replaces it"));
    }
  }
  std::error_code error;
  fs::create_directories(output.to.parent_path(), error);
  if (error) {
    return errno_status(error.value(), output.to.parent_path());
  }
  return write_file_atomically(output.to, std::as_bytes(std::span(bytes)));
}

/// Converts the scene and writes all files. The scene file is written last, so that it never names
/// a file that is missing. Returns the number of files beside the scene file. CANCELLED: a signal
/// came.
absl::StatusOr<std::size_t> import_to(const fs::path& target, const ImportOptions& options,
                                      Process& process) {
  if (!options.force && file_exists(target)) {
    return absl::AlreadyExistsError(absl::StrCat(target.string(), " exists; --force replaces it"));
  }
  RETURN_IF_ERROR(check_can_be_written(target));
  std::atomic<bool> stop{false};
  const Interrupts::Listener listener(process.interrupts, [&] { stop = true; });
  ImportLimits limits;
  limits.stop = &stop;
  ASSIGN_OR_RETURN(const SceneFiles files,
                   scene_files_in_process(options.scene, limits, options.choices));
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  ASSIGN_OR_RETURN(const std::vector<Output> outputs, outputs_of(files, options.scene, folder));
  for (const Output& output : outputs) {
    if (stop) {
      return absl::CancelledError("interrupted");
    }
    RETURN_IF_ERROR(write_output(output, options.force));
  }
  RETURN_IF_ERROR(write_file_atomically(target, std::as_bytes(std::span(files.text))));
  print_warnings(files.warnings, options.verbosity, process);
  return outputs.size();
}

}  // namespace

ExitCode run(const ImportOptions& options, Process& process) {
  const fs::path target = output_of(options);
  const auto count = import_to(target, options, process);
  if (!count.ok()) {
    return process.console.fail(import_exit_code(count.status()),
                                std::string(count.status().message()));
  }
  if (options.verbosity.json) {
    process.console.line(JsonObject()
                             .text("event", "done")
                             .text("output", target.string())
                             .whole("files", *count)
                             .str());
  } else {
    process.console.line(absl::StrCat(
        "wrote ", target.string(),
        *count == 0
            ? ""
            : absl::StrCat(" and ", *count, *count == 1 ? " file" : " files", " beside it")));
  }
  return ExitCode::kDone;
}

}  // namespace bandsaw::coordinator
