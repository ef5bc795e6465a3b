// bandsaw-import reads one file of unknown origin and writes its content to a folder in a form that
// needs no parser. The client commands and the dashboard start this program
// (coordinator/cli/scene/import_process.h); it can also be run by hand. FOLDER must exist. SECONDS
// and BYTES limit the CPU time and the memory. Each of the following modes is explained below its
// command line.
//
//   bandsaw-import scene FILE FOLDER SECONDS BYTES [CHOICE ...]
//
// This mode imports a scene. It writes FOLDER/manifest, which describes the scene, and
// FOLDER/<digest> for each blob, an array of the scene to which the manifest refers by its digest.
// The choices (import.h, ImportChoices) are environment=FILE, camera=NAME, strict,
// define:NAME=VALUE (a parameter of a Mitsuba scene), folder=OUTER (for a Mitsuba scene: files
// anywhere below OUTER, which contains the scene's own folder, may be read), frame=N, fps=F,
// shutter=SHARE (fps and shutter only after frame) and animation=NAME.
//
//   bandsaw-import frames FILE FOLDER SECONDS BYTES frame=N [CHOICE ...]
//
// This mode imports the frames of a scene, one after the other. It reads the numbers of the frames
// from standard input, one a line. It answers each number with the line "done" when FOLDER has the
// package of that frame, and of no other frame. Models, image textures and a foreign scene (of
// pbrt or Mitsuba) are kept for the next frame; other files of the scene are read again. SECONDS is
// the CPU time for all frames together. The choice frame=N must be given, but its N is not used.
//
//   bandsaw-import text FILE FOLDER SECONDS BYTES [CHOICE ...]
//
// This mode converts a foreign scene or a model to a Bandsaw scene file. It writes FOLDER/text,
// FOLDER/warnings (one a line), and FOLDER/list with a line for each file that the scene names:
// "made NAME" for a file that the converter made, or "found NAME" for a file below the folder of
// FILE. The bytes of the made files are in FOLDER/0, FOLDER/1 and so on, in the order of the list.
//
//   bandsaw-import unzip FILE FOLDER SECONDS BYTES
//
// This mode unpacks a zip archive. It writes FOLDER/list with a line "made NAME" for each file in
// the archive, and the bytes of these files to FOLDER/0, FOLDER/1 and so on, in the order of the
// list.
//
//   bandsaw-import image FILE FOLDER SECONDS BYTES
//
// This mode decodes an image. It writes FOLDER/image: width and height as uint32, then float RGB,
// rows from the top.
//
// bandsaw-import exits with 0 when all is done. Otherwise it writes one line "CODE: message" to
// standard output, with CODE as absl::StatusCodeToString writes it, and exits with 1.

#include <sys/prctl.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <initializer_list>
#include <new>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/str_split.h"
#include "absl/strings/strip.h"
#include "proto/wire/limits.h"
#include "renderlib/base/atomic_file.h"
#include "renderlib/base/clean_text.h"
#include "renderlib/base/file.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/files/confine.h"
#include "renderlib/import/files/scene_folder.h"
#include "renderlib/import/files/zip_archive.h"
#include "renderlib/import/image/decode_image.h"
#include "renderlib/import/import.h"
#include "renderlib/package/blob_folder.h"

namespace bandsaw {
namespace {

// Writes a file. There is no fsync, because the file is read once and removed.
absl::Status write_file(const std::string& path,
                        std::initializer_list<absl::Span<const std::byte>> parts) {
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (file == nullptr) {
    return errno_status(errno, path);
  }
  bool good = true;
  for (const auto part : parts) {
    good = good && std::fwrite(part.data(), 1, part.size(), file) == part.size();
  }
  const int error = errno;
  good = std::fclose(file) == 0 && good;
  return good ? absl::OkStatus() : errno_status(error, path);
}

// The functions import_to, frames_to, read_picture_to, text_to and unzip_to implement the modes
// scene, frames, image, text and unzip.

absl::Status import_to(const std::string& path, const std::string& folder,
                       const ImportChoices& choices) {
  ASSIGN_OR_RETURN(const ImportedScene imported, import_scene(path, choices));
  BlobMap blobs;
  const std::string manifest = encode_package(imported.scene, imported.info, blobs);
  // Checks the limits that a coordinator would check.
  RETURN_IF_ERROR(package_blobs(manifest).status());
  const BlobFolder out(folder);
  for (const auto& [digest, bytes] : blobs.all()) {
    RETURN_IF_ERROR(write_file(out.path_of(digest), {absl::MakeConstSpan(bytes)}));
  }
  return write_file(folder + "/manifest", {std::as_bytes(std::span(manifest))});
}

/// Imports the frames of one scene, one after the other, to a folder.
class FrameImports {
 public:
  FrameImports(std::string path, std::string folder, ImportChoices choices)
      : path_(std::move(path)), folder_(std::move(folder)), choices_(std::move(choices)) {}

  /// Replaces the package in the folder by that of the frame `number`.
  absl::Status import(double number) {
    choices_.frame->number = number;
    ASSIGN_OR_RETURN(const ImportedScene imported, import_scene(path_, choices_, &memory_));
    BlobMap blobs;
    const std::string manifest =
        encode_package(imported.scene, imported.info, blobs, &memory_.encoded);
    ASSIGN_OR_RETURN(const std::vector<BlobRef> refs, package_blobs(manifest));
    std::set<wire::Digest> used;
    for (const BlobRef& ref : refs) {
      used.insert(ref.digest);
    }
    RETURN_IF_ERROR(update_files(blobs, used));
    return write_file(folder_ + "/manifest", {std::as_bytes(std::span(manifest))});
  }

 private:
  /// Writes the blobs that are not yet in the folder, and removes those that this frame does not
  /// use.
  absl::Status update_files(const BlobMap& blobs, const std::set<wire::Digest>& used) {
    const BlobFolder out(folder_);
    for (const wire::Digest& digest : written_) {
      if (used.find(digest) == used.end()) {
        std::remove(out.path_of(digest).c_str());
      }
    }
    for (const auto& [digest, bytes] : blobs.all()) {
      if (written_.find(digest) == written_.end()) {
        RETURN_IF_ERROR(write_file(out.path_of(digest), {absl::MakeConstSpan(bytes)}));
      }
    }
    written_ = used;
    return absl::OkStatus();
  }

  const std::string path_;
  const std::string folder_;
  ImportChoices choices_;
  ImportMemory memory_;
  std::set<wire::Digest> written_;  ///< blobs in the folder
};

/// Imports the frames whose numbers are on standard input, until standard input ends.
absl::Status frames_to(const std::string& path, const std::string& folder,
                       const ImportChoices& choices) {
  FrameImports imports(path, folder, choices);
  std::array<char, 64> line{};
  while (std::fgets(line.data(), line.size(), stdin) != nullptr) {
    double number = 0;
    if (!absl::SimpleAtod(absl::StripTrailingAsciiWhitespace(line.data()), &number) ||
        !std::isfinite(number)) {
      return absl::InvalidArgumentError("standard input must have a frame's number on each line");
    }
    RETURN_IF_ERROR(imports.import(number));
    std::puts("done");
    std::fflush(stdout);
  }
  return absl::OkStatus();
}

absl::Status read_picture_to(const std::string& path, const std::string& folder) {
  ASSIGN_OR_RETURN(const std::string bytes, read_whole_file(path, kMaxImageFileBytes));
  const auto picture = decode_picture(bytes);
  if (!picture.ok()) {
    return absl::Status(picture.status().code(),
                        absl::StrCat(path, ": ", picture.status().message()));
  }
  return write_file(folder + "/image", {std::as_bytes(std::span(&picture->width, 1)),
                                        std::as_bytes(std::span(&picture->height, 1)),
                                        std::as_bytes(std::span(picture->pixels))});
}

absl::Span<const std::byte> bytes_of(const std::string& text) {
  return std::as_bytes(std::span(text));
}

absl::Status text_to(const std::string& path, const std::string& folder,
                     const ImportChoices& choices) {
  ASSIGN_OR_RETURN(const SceneAsText scene, scene_as_text(path, choices));
  std::string list;
  int number = 0;
  for (const auto& [name, bytes] : scene.made_files) {
    absl::StrAppend(&list, "made ", name, "\n");
    RETURN_IF_ERROR(write_file(absl::StrCat(folder, "/", number++), {bytes_of(bytes)}));
  }
  for (const auto& [name, real_path] : scene.found_files) {
    if (!is_safe_name(name)) {
      return absl::InvalidArgumentError(
          absl::StrCat("the file name \"", name, "\" cannot be in a scene file"));
    }
    absl::StrAppend(&list, "found ", name, "\n");
  }
  std::string warnings;
  for (const std::string& warning : scene.warnings) {
    absl::StrAppend(&warnings, absl::StrReplaceAll(warning, {{"\n", " "}}), "\n");
  }
  RETURN_IF_ERROR(write_file(folder + "/text", {bytes_of(scene.text)}));
  RETURN_IF_ERROR(write_file(folder + "/warnings", {bytes_of(warnings)}));
  return write_file(folder + "/list", {bytes_of(list)});
}

absl::Status unzip_to(const std::string& path, const std::string& folder) {
  const auto unzip = [&]() -> absl::Status {
    ASSIGN_OR_RETURN(const std::string bytes, read_whole_file(path, kMaxUnzippedBytes));
    ASSIGN_OR_RETURN(const ZipArchive archive, ZipArchive::open(bytes));
    std::string list;
    int number = 0;
    for (const ZipArchive::Entry& entry : archive.entries()) {
      ASSIGN_OR_RETURN(const std::string file, archive.read(entry));
      absl::StrAppend(&list, "made ", entry.name, "\n");
      RETURN_IF_ERROR(write_file(absl::StrCat(folder, "/", number++), {bytes_of(file)}));
    }
    return write_file(folder + "/list", {bytes_of(list)});
  };
  const absl::Status status = unzip();
  return status.ok()
             ? status
             : absl::Status(status.code(), absl::StrCat(name_of(path), ": ", status.message()));
}

constexpr char kUsage[] =
    "usage: bandsaw-import scene|frames|text|image|unzip FILE FOLDER SECONDS BYTES "
    "[environment=FILE] [camera=NAME] [strict] [define:NAME=VALUE ...] [folder=OUTER] "
    "[frame=N [fps=F] "
    "[shutter=SHARE]] [animation=NAME]";

// Reads a file that the user named on the command line. It may be in any folder, because no file of
// unknown origin has named it. Here its bytes are only copied, not parsed.
absl::StatusOr<GivenFile> read_given(const std::string& path) {
  ASSIGN_OR_RETURN(std::string bytes, read_whole_file(path, kMaxImageFileBytes));
  return GivenFile{name_of(path), std::move(bytes)};
}

// Reads frame=N, fps=F or shutter=SHARE. Returns false if `value` is not a number in the permitted
// range, if `key` is none of these three, or if fps or shutter come before frame.
bool read_frame_choice(absl::string_view key, absl::string_view value, ImportChoices& choices) {
  double number = 0;
  if (!absl::SimpleAtod(value, &number) || !std::isfinite(number)) {
    return false;
  }
  if (key == "frame") {
    choices.frame = FrameChoice{number, std::nullopt, std::nullopt};
  } else if (key == "fps" && choices.frame && number >= 0.01 && number <= 10'000) {
    choices.frame->fps = number;
  } else if (key == "shutter" && choices.frame && number >= 0 && number <= 1) {
    choices.frame->shutter = number;
  } else {
    return false;
  }
  return true;
}

// Reads the arguments after the first six.
absl::StatusOr<ImportChoices> read_choices(int argc, char** argv) {
  ImportChoices choices;
  for (int i = 6; i < argc; ++i) {
    const absl::string_view argument = argv[i];
    const auto [key, value] =
        std::pair<std::string, std::string>(absl::StrSplit(argument, absl::MaxSplits('=', 1)));
    absl::string_view name = key;
    if (argument == "strict") {
      choices.strict = true;
    } else if (key == "environment") {
      ASSIGN_OR_RETURN(choices.environment, read_given(value));
    } else if (key == "camera") {
      choices.camera = value;
    } else if (key == "animation") {
      choices.animation = value;
    } else if (key == "folder") {
      choices.folder = value;
    } else if (absl::ConsumePrefix(&name, "define:")) {
      choices.parameters[std::string(name)] = value;
    } else if (!read_frame_choice(key, value, choices)) {
      return absl::InvalidArgumentError(kUsage);
    }
  }
  return choices;
}

// Reads the arguments, confines this process, and runs the mode. No file of unknown origin is
// parsed before the process is confined.
absl::Status run(int argc, char** argv) {
  Confinement limits;
  const std::string what = argc >= 6 ? argv[1] : "";
  const bool has_choices = what == "scene" || what == "frames" || what == "text";
  const bool is_known = has_choices || ((what == "image" || what == "unzip") && argc == 6);
  if (!is_known || !absl::SimpleAtoi(argv[4], &limits.cpu_seconds) ||
      !absl::SimpleAtoi(argv[5], &limits.memory_bytes)) {
    return absl::InvalidArgumentError(kUsage);
  }
  const std::string path = argv[2];
  ASSIGN_OR_RETURN(const ImportChoices choices, read_choices(argc, argv));
  if (what == "frames" && !choices.frame) {
    return absl::InvalidArgumentError(kUsage);
  }
  ASSIGN_OR_RETURN(const SceneFolder folder, folder_to_read(path, choices));
  limits.read_folder = folder.path();
  limits.write_folder = argv[3];
  limits.file_bytes = wire::kBlobBytes;
  RETURN_IF_ERROR(confine_this_process(limits));
  return what == "scene"    ? import_to(path, argv[3], choices)
         : what == "frames" ? frames_to(path, argv[3], choices)
         : what == "text"   ? text_to(path, argv[3], choices)
         : what == "unzip"  ? unzip_to(path, argv[3])
                            : read_picture_to(path, argv[3]);
}

// Runs the import and converts exceptions of foreign code to errors.
absl::Status run_without_exceptions(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::bad_alloc&) {
    rlimit memory{};
    getrlimit(RLIMIT_AS, &memory);
    std::uint64_t most = memory.rlim_cur;
    if (std::uint64_t given = 0; absl::SimpleAtoi(argv[5], &given)) {
      most = std::min(most, given);
    }
    return absl::ResourceExhaustedError(absl::StrCat(name_of(argv[2]),
                                                     ": needs more memory than the ", most,
                                                     " bytes that reading a file may take"));
  } catch (const std::exception& error) {
    return absl::InvalidArgumentError(
        absl::StrCat(name_of(argv[2]), ": cannot be read: ", error.what()));
  }
}

}  // namespace
}  // namespace bandsaw

int main(int argc, char** argv) {
  // The process is killed when its parent ends, because then nobody would read the result.
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  const absl::Status status = bandsaw::run_without_exceptions(argc, argv);
  if (!status.ok()) {
    const std::string message =
        absl::StrCat(absl::StatusCodeToString(status.code()), ": ",
                     bandsaw::clean_text(std::string(status.message()), 4000));
    std::puts(message.c_str());
  }
  std::fflush(stdout);
  // Exits without destructors, which would free gigabytes of arrays one by one.
  std::_Exit(status.ok() ? 0 : 1);
}
