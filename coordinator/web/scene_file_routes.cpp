// The handlers for scenes of many files. Programs send such scenes, for example by
// deploy/python/bandsaw.py. Each file is sent once and stays in the coordinator's store as a blob,
// a byte array named by its SHA-256. A scene names its files by these digests.

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "coordinator/store/scratch_folder.h"
#include "coordinator/web/reply.h"
#include "coordinator/web/routes.h"
#include "coordinator/web/scene_request.h"
#include "proto/web.pb.h"
#include "renderlib/base/atomic_file.h"
#include "renderlib/base/clean_text.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxListBytes = 16 << 20;  // JSON with the names and digests of the files
constexpr int kMaxFiles = 100'000;
constexpr std::uint64_t kMaxFileBytes = 2ull << 30;
constexpr std::uint64_t kMaxSceneBytes = 4ull << 30;  // all files together

/// Returns an INVALID_ARGUMENT error that says that `what` may have at most `most` bytes, a whole
/// number of MiB.
absl::Status too_large(const std::string& what, std::uint64_t most) {
  return absl::InvalidArgumentError(absl::StrCat(what, " has at most ", most >> 20,
                                                 " MiB here; `bandsaw submit` takes larger ones"));
}

/// Checks the number of files of a scene.
absl::Status check_count(int files) {
  return files <= kMaxFiles ? absl::OkStatus()
                            : absl::InvalidArgumentError(
                                  absl::StrCat("a scene has at most ", kMaxFiles, " files"));
}

/// Reads a list of digests from the body. Returns the digests for which the store has no blob.
absl::StatusOr<web::FileDigests> missing_files(Engine& engine, const HttpBody& body) {
  web::FileDigests list;
  RETURN_IF_ERROR(read_json(body, list, kMaxListBytes));
  RETURN_IF_ERROR(check_count(list.sha256_size()));
  web::FileDigests missing;
  for (const std::string& hex : list.sha256()) {
    ASSIGN_OR_RETURN(const wire::Digest digest, wire::digest_from_hex(hex));
    if (!engine.has_blob(digest)) {
      missing.add_sha256(hex);
    }
  }
  return missing;
}

/// The bytes of a body, in the pieces that the caller asks for.
class BodyReader {
 public:
  explicit BodyReader(const HttpBody& body) : body_(body) {}

  /// Returns the bytes up to the next newline, without the newline; empty at the end of the body.
  /// INVALID_ARGUMENT: the line is longer than `most` bytes.
  absl::StatusOr<std::string> line(std::size_t most) {
    std::string text;
    while (true) {
      RETURN_IF_ERROR(fill());
      if (rest_.empty()) {
        return text;
      }
      const char c = rest_.front();
      rest_.remove_prefix(1);
      if (c == '\n') {
        return text;
      }
      if (text.size() == most) {
        return absl::InvalidArgumentError("a file must begin with the line SHA256 SIZE");
      }
      text.push_back(c);
    }
  }
  /// Returns 1 to `most` bytes, valid until the next call. INVALID_ARGUMENT: the body has ended.
  absl::StatusOr<absl::string_view> bytes(std::uint64_t most) {
    RETURN_IF_ERROR(fill());
    if (rest_.empty()) {
      return absl::InvalidArgumentError("the body ends within a file");
    }
    const absl::string_view piece = rest_.substr(0, std::min<std::uint64_t>(most, rest_.size()));
    rest_.remove_prefix(piece.size());
    return piece;
  }

 private:
  /// Gets the next piece of the body if `rest_` is empty.
  absl::Status fill() {
    if (rest_.empty() && !ended_) {
      ASSIGN_OR_RETURN(rest_, body_());
      ended_ = rest_.empty();
    }
    return absl::OkStatus();
  }

  const HttpBody& body_;
  absl::string_view rest_;
  bool ended_ = false;
};

/// Stores one file of the body. `head`: the line "SHA256 SIZE" before the file's bytes. The bytes
/// of a file that is in the store already are read and dropped.
absl::Status take_file(Engine& engine, const std::string& head, BodyReader& reader) {
  const std::vector<std::string> words = absl::StrSplit(head, ' ');
  std::uint64_t size = 0;
  if (words.size() != 2 || !absl::SimpleAtoi(words[1], &size)) {
    return absl::InvalidArgumentError("a file must begin with the line SHA256 SIZE");
  }
  ASSIGN_OR_RETURN(const wire::Digest digest, wire::digest_from_hex(words[0]));
  if (size > kMaxFileBytes) {
    return too_large("a file of a scene", kMaxFileBytes);
  }
  std::unique_ptr<Engine::BlobWriter> writer;  // nullptr: the file is in the store already
  if (!engine.has_blob(digest)) {
    ASSIGN_OR_RETURN(writer, engine.write_blob(digest, size));
  }
  while (size > 0) {
    ASSIGN_OR_RETURN(const absl::string_view bytes, reader.bytes(size));
    size -= bytes.size();
    if (writer != nullptr) {
      RETURN_IF_ERROR(writer->append(
          absl::MakeConstSpan(reinterpret_cast<const std::byte*>(bytes.data()), bytes.size())));
    }
  }
  return writer != nullptr ? writer->commit() : absl::OkStatus();
}

/// Stores the files of a body. Each file is a line "SHA256 SIZE", followed by SIZE bytes. Returns
/// the digests of the files.
absl::StatusOr<web::FileDigests> take_files(Engine& engine, const HttpBody& body) {
  constexpr std::size_t kMaxHead = 64 + 1 + 20;  // a digest, a space, a number of 64 bits
  web::FileDigests taken;
  BodyReader reader(body);
  while (true) {
    ASSIGN_OR_RETURN(const std::string head, reader.line(kMaxHead));
    if (head.empty()) {
      return taken;
    }
    RETURN_IF_ERROR(take_file(engine, head, reader));
    taken.add_sha256(head.substr(0, head.find(' ')));
  }
}

constexpr std::size_t kMaxName = 500;

/// Returns true for a relative path that stays within its folder: it has no parts "", "." or "..",
/// and neither backslashes nor control characters. It has at most kMaxName bytes.
bool is_safe(const std::string& name) {
  if (clean_text(name, kMaxName) != name || absl::StrContains(name, '\\')) {
    return false;
  }
  const std::vector<std::string> parts = absl::StrSplit(name, '/');
  return std::none_of(parts.begin(), parts.end(), [](const std::string& part) {
    return part.empty() || part == "." || part == "..";
  });
}

/// Writes the bytes to a new file at `path`.
absl::Status write_copy(const fs::path& path, absl::Span<const std::byte> bytes) {
  std::FILE* const file = std::fopen(path.c_str(), "wb");
  if (file == nullptr) {
    return errno_status(errno, "cannot keep the scene");
  }
  const bool written = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
  const int error = errno;
  if (std::fclose(file) != 0 || !written) {
    return errno_status(written ? errno : error, "cannot keep the scene");
  }
  return absl::OkStatus();
}

/// Writes the files of a scene into a folder, from which the importer reads them.
/// FAILED_PRECONDITION: a file has to be sent again.
absl::Status lay_out(Engine& engine, const web::SceneFiles& files, const fs::path& folder) {
  std::uint64_t left = kMaxSceneBytes;
  for (const web::SceneFiles::File& file : files.file()) {
    if (!is_safe(file.name())) {
      return absl::InvalidArgumentError(absl::StrCat(
          "'", clean_text(file.name(), kMaxName), "' is not a file name: it must be a path within ",
          "the scene's folder, without backslashes and control characters, of at most ", kMaxName,
          " bytes"));
    }
    ASSIGN_OR_RETURN(const wire::Digest digest, wire::digest_from_hex(file.sha256()));
    if (!engine.has_blob(digest)) {
      return absl::FailedPreconditionError(
          absl::StrCat("the file ", file.name(), " is not here; send it again"));
    }
    ASSIGN_OR_RETURN(const std::unique_ptr<BlobBytes> bytes, engine.blobs().get(digest));
    if (bytes->bytes().size() > left) {
      return too_large("a scene", kMaxSceneBytes);
    }
    left -= bytes->bytes().size();
    const fs::path path = folder / file.name();
    std::error_code error;
    fs::create_directories(path.parent_path(), error);
    if (error) {
      return errno_status(error.value(), "cannot keep the scene");
    }
    RETURN_IF_ERROR(write_copy(path, bytes->bytes()));
  }
  return absl::OkStatus();
}

/// Submits the scene that the body, a web::SceneFiles in JSON, describes. All its files must be in
/// the store.
absl::StatusOr<web::Submitted> submit_files(Engine& engine, Scenes& scenes,
                                            const HttpRequest& request, const HttpBody& body) {
  ASSIGN_OR_RETURN(const SceneRequest wanted, scene_request(request));
  web::SceneFiles files;
  RETURN_IF_ERROR(read_json(body, files, kMaxListBytes));
  RETURN_IF_ERROR(check_count(files.file_size()));
  const auto is_scene = [&](const auto& file) { return file.name() == files.scene(); };
  if (std::none_of(files.file().begin(), files.file().end(), is_scene)) {
    return absl::InvalidArgumentError("scene: must be the name of one of the files");
  }
  ASSIGN_OR_RETURN(const auto folder, ScratchFolder::make("files"));
  RETURN_IF_ERROR(lay_out(engine, files, folder->path()));
  return scenes.submit((fs::path(folder->path()) / files.scene()).string(), wanted);
}

}  // namespace

void add_scene_files(Router& router, Engine& engine, Scenes& scenes) {
  router.post("/api/files/missing", [&engine](const HttpRequest&, const HttpBody& body) {
    return answer(missing_files(engine, body));
  });
  router.post("/api/files", [&engine](const HttpRequest&, const HttpBody& body) {
    return answer(take_files(engine, body));
  });
  router.post("/api/scenes/files",
              [&engine, &scenes](const HttpRequest& request, const HttpBody& body) {
                return answer(submit_files(engine, scenes, request, body));
              });
}

}  // namespace bandsaw::coordinator
