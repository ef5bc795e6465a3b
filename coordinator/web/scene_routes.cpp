// The handler for a scene that is sent as one file, for example by a user who drops it on the page.

#include <cerrno>
#include <cstdio>
#include <memory>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "coordinator/store/scratch_folder.h"
#include "coordinator/web/reply.h"
#include "coordinator/web/routes.h"
#include "coordinator/web/scene_request.h"
#include "proto/web.pb.h"
#include "renderlib/base/atomic_file.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

constexpr std::uint64_t kMaxUploadBytes = 2048ull << 20;  // of the scene file

/// A file that is received into a temporary folder of its own, because the importer, which reads
/// the file later, can read only below the folder of the file.
class Upload {
 public:
  Upload() = default;
  ~Upload() {
    if (file_ != nullptr) {
      std::fclose(file_);
    }
  }
  Upload(const Upload&) = delete;
  Upload& operator=(const Upload&) = delete;

  /// Creates the folder and the empty file `name` in it.
  absl::Status open(const std::string& name) {
    ASSIGN_OR_RETURN(folder_, ScratchFolder::make("drop"));
    path_ = folder_->path() + "/" + name;
    file_ = std::fopen(path_.c_str(), "wb");
    return file_ != nullptr ? absl::OkStatus() : errno_status(errno, "cannot keep the scene");
  }
  /// Writes the whole body to the file as it arrives, and closes the file.
  absl::Status receive(const HttpBody& body) {
    absl::Status status = copy(body);
    if (std::fclose(std::exchange(file_, nullptr)) != 0 && status.ok()) {
      status = errno_status(errno, "cannot keep the scene");
    }
    return status;
  }
  const std::string& path() const { return path_; }

 private:
  absl::Status copy(const HttpBody& body) const {
    std::uint64_t left = kMaxUploadBytes;
    while (true) {
      ASSIGN_OR_RETURN(const absl::string_view bytes, body());
      if (bytes.empty()) {
        return absl::OkStatus();
      }
      if (bytes.size() > left) {
        return absl::InvalidArgumentError(
            absl::StrCat("a scene has at most ", kMaxUploadBytes >> 20,
                         " MiB here; `bandsaw submit` takes larger scenes"));
      }
      left -= bytes.size();
      if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size()) {
        return errno_status(errno, "cannot keep the scene");
      }
    }
  }

  std::unique_ptr<const ScratchFolder> folder_;
  std::string path_;
  std::FILE* file_ = nullptr;
};

/// Returns the name `given` without its folders, shortened, and with unsafe characters replaced.
/// INVALID_ARGUMENT: a file with this suffix cannot be a complete scene.
absl::StatusOr<std::string> file_name(const std::string& given) {
  constexpr std::size_t kMaxStem = 80;
  std::string name = given.substr(given.find_last_of("/\\") + 1);
  for (char& c : name) {
    c = absl::ascii_isalnum(c) || c == '.' || c == '-' || c == '_' ? c : '_';
  }
  for (const char* suffix : {".glb", ".textproto", ".pbrt", ".xml", ".zip"}) {
    if (absl::EndsWithIgnoreCase(name, suffix)) {
      const std::string stem = name.substr(0, name.size() - std::string(suffix).size());
      const std::string kept = stem.substr(0, kMaxStem);
      return absl::StrCat(kept.empty() || kept[0] == '.' ? "scene" : kept, suffix);
    }
  }
  return absl::InvalidArgumentError(
      "a .zip of a scene with its files can be dropped here, or a .glb, .textproto, .pbrt or .xml "
      "that needs no other file; `bandsaw submit` takes all other scenes");
}

/// Receives the scene file in the body and submits its job.
absl::StatusOr<web::Submitted> take_scene(Scenes& scenes, const HttpRequest& request,
                                          const HttpBody& body) {
  ASSIGN_OR_RETURN(const std::string name, file_name(request.parameter("name")));
  ASSIGN_OR_RETURN(const SceneRequest wanted, scene_request(request));
  Upload upload;
  RETURN_IF_ERROR(upload.open(name));
  RETURN_IF_ERROR(upload.receive(body));
  return scenes.submit(upload.path(), wanted);
}

}  // namespace

void add_scenes(Router& router, Scenes& scenes) {
  router.post("/api/scenes", [&scenes](const HttpRequest& request, const HttpBody& body) {
    return answer(take_scene(scenes, request, body));
  });
}

}  // namespace bandsaw::coordinator
