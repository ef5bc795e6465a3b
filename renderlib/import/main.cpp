// bandsaw-import: reads one foreign file and leaves it in a folder in a form that needs no parser,
// or one error on standard output. Started by the client commands
// (coordinator/cli/scene/import_process.h); can be run by hand.
//
//   bandsaw-import scene FILE FOLDER SECONDS BYTES [ENVIRONMENT [CAMERA]]
//
// leaves FOLDER/manifest and FOLDER/<digest> for each blob; an empty ENVIRONMENT is none;
//
//   bandsaw-import image FILE FOLDER SECONDS BYTES
//
// leaves FOLDER/image: width and height as uint32, then float RGB, rows from the top.
//
// Exit 0: done. Exit 1: "CODE: message" on standard output, CODE as absl::StatusCodeToString writes
// it.

#include <sys/prctl.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <initializer_list>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "proto/wire/limits.h"
#include "renderlib/base/atomic_file.h"
#include "renderlib/base/clean_text.h"
#include "renderlib/base/file.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/files/confine.h"
#include "renderlib/import/files/scene_folder.h"
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

absl::Status run(int argc, char** argv) {
  Confinement limits;
  const std::string what =
      argc == 6 || (argc > 6 && argc <= 8 && argv[1] == std::string("scene")) ? argv[1] : "";
  if ((what != "scene" && what != "image") || !absl::SimpleAtoi(argv[4], &limits.cpu_seconds) ||
      !absl::SimpleAtoi(argv[5], &limits.memory_bytes)) {
    return absl::InvalidArgumentError(
        "usage: bandsaw-import scene|image FILE FOLDER SECONDS BYTES [ENVIRONMENT [CAMERA]]");
  }
  const std::string path = argv[2];
  ASSIGN_OR_RETURN(const SceneFolder folder, SceneFolder::of(path));
  limits.read_folder = folder.path();
  limits.write_folder = argv[3];
  limits.file_bytes = wire::kBlobBytes;
  // The user named this file, not another file, so it may be in any folder. Here it is only copied.
  ImportChoices choices;
  if (argc > 6 && argv[6][0] != '\0') {
    ASSIGN_OR_RETURN(std::string bytes, read_whole_file(argv[6], kMaxImageFileBytes));
    choices.environment = GivenFile{name_of(argv[6]), std::move(bytes)};
  }
  choices.camera = argc > 7 ? argv[7] : "";
  RETURN_IF_ERROR(confine_this_process(limits));
  return what == "scene" ? import_to(path, argv[3], choices) : read_picture_to(path, argv[3]);
}

// Runs the import and converts exceptions of foreign code to errors.
absl::Status run_without_exceptions(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::bad_alloc&) {
    return absl::ResourceExhaustedError(absl::StrCat(name_of(argv[2]),
                                                     ": needs more memory than the ", argv[5],
                                                     " bytes that reading a file may take"));
  } catch (const std::exception& error) {
    return absl::InvalidArgumentError(
        absl::StrCat(name_of(argv[2]), ": cannot be read: ", error.what()));
  }
}

}  // namespace
}  // namespace bandsaw

int main(int argc, char** argv) {
  // Without a parent process nobody would read the result.
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
