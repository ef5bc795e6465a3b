// Scene files that people drop on the page.

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "coordinator/web/reply.h"
#include "coordinator/web/routes.h"
#include "proto/web.pb.h"
#include "renderlib/base/atomic_file.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMostScene = 512ull << 20;

/// A folder of its own for one file, removed with it: the importer reads below it and nowhere else.
class Upload {
 public:
  Upload() = default;
  ~Upload() {
    if (file_ != nullptr) {
      std::fclose(file_);
    }
    std::error_code ignored;
    if (!folder_.empty()) {
      fs::remove_all(folder_, ignored);
    }
  }
  Upload(const Upload&) = delete;
  Upload& operator=(const Upload&) = delete;

  absl::Status open(const std::string& name) {
    std::error_code error;
    std::string pattern = (fs::temp_directory_path(error) / "bandsaw-drop-XXXXXX").string();
    if (error || mkdtemp(pattern.data()) == nullptr) {
      return errno_status(error ? error.value() : errno, "cannot make a temporary folder");
    }
    folder_ = pattern;
    path_ = folder_ + "/" + name;
    file_ = std::fopen(path_.c_str(), "wb");
    return file_ != nullptr ? absl::OkStatus() : errno_status(errno, "cannot keep the scene");
  }
  absl::Status receive(const httplib::ContentReader& body) {
    std::uint64_t size = 0;
    absl::Status status;
    const bool read = body([&](const char* data, std::size_t count) {
      size += count;
      if (size > kMostScene) {
        status =
            absl::InvalidArgumentError(absl::StrCat("a scene has at most ", kMostScene >> 20,
                                                    " MiB here; bandsaw submit takes larger ones"));
      } else if (std::fwrite(data, 1, count, file_) != count) {
        status = errno_status(errno, "cannot keep the scene");
      }
      return status.ok();
    });
    if (status.ok() && !read) {
      status = absl::InvalidArgumentError("the scene did not come whole");
    }
    if (std::fclose(std::exchange(file_, nullptr)) != 0 && status.ok()) {
      status = errno_status(errno, "cannot keep the scene");
    }
    return status;
  }
  const std::string& path() const { return path_; }

 private:
  std::string folder_;
  std::string path_;
  std::FILE* file_ = nullptr;
};

/// The file's own name as far as it is harmless. INVALID_ARGUMENT: not a kind that stands alone.
absl::StatusOr<std::string> file_name(const std::string& given) {
  constexpr std::size_t kMost = 80;
  std::string name = given.substr(given.find_last_of("/\\") + 1);
  for (char& c : name) {
    c = absl::ascii_isalnum(c) || c == '.' || c == '-' || c == '_' ? c : '_';
  }
  for (const char* suffix : {".glb", ".textproto"}) {
    if (absl::EndsWithIgnoreCase(name, suffix)) {
      const std::string stem = name.substr(0, name.size() - std::string(suffix).size());
      const std::string kept = stem.substr(0, kMost);
      return absl::StrCat(kept.empty() || kept[0] == '.' ? "scene" : kept, suffix);
    }
  }
  return absl::InvalidArgumentError(
      "a .glb or a .textproto that needs no other file can be dropped here; for all else there is: "
      "bandsaw submit");
}

absl::StatusOr<SceneWish> wanted_of(const httplib::Request& request) {
  SceneWish wanted;
  const std::string width = request.get_param_value("width");
  if (!width.empty() && (!absl::SimpleAtoi(width, &wanted.width) || wanted.width > kMaxSide)) {
    return absl::InvalidArgumentError("width: must be a number of pixels");
  }
  if (const std::string error = request.get_param_value("error"); !error.empty()) {
    StopAtError stop;
    if (!absl::SimpleAtod(error, &stop.relative_rmse) || !(stop.relative_rmse > 0) ||
        stop.relative_rmse > 1) {
      return absl::InvalidArgumentError("error: must be in (0, 1]");
    }
    wanted.stop = stop;
  } else if (const std::string text = request.get_param_value("samples"); !text.empty()) {
    StopAtSamples stop;
    if (!absl::SimpleAtoi(text, &stop.samples) || stop.samples < 1 || stop.samples > kMaxSamples) {
      return absl::InvalidArgumentError("samples: must be a number of samples a pixel");
    }
    wanted.stop = stop;
  }
  return wanted;
}

absl::StatusOr<web::Submitted> take_scene(Scenes& scenes, const httplib::Request& request,
                                          const httplib::ContentReader& body) {
  ASSIGN_OR_RETURN(const std::string name, file_name(request.get_param_value("name")));
  ASSIGN_OR_RETURN(const SceneWish wanted, wanted_of(request));
  Upload upload;
  RETURN_IF_ERROR(upload.open(name));
  RETURN_IF_ERROR(upload.receive(body));
  return scenes.submit(upload.path(), wanted);
}

}  // namespace

void add_scenes(HttpServer& server, Scenes& scenes) {
  server.Post("/api/scenes", [&scenes](const httplib::Request& request, httplib::Response& response,
                                       const httplib::ContentReader& body) {
    answer(response, take_scene(scenes, request, body));
  });
}

}  // namespace bandsaw::coordinator
