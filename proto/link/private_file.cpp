// Reads and writes files that only their owner may read. The text is written to a temporary file of
// mode 0600, which is synced and then renamed to the target.

#include "proto/link/private_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>

#include "absl/strings/str_cat.h"

namespace bandsaw::link {
namespace {

constexpr std::size_t kMaxSize = 1 << 20;

/// Returns the error "cannot `what` `path`" for the errno `error`.
absl::Status failed(absl::string_view what, const std::string& path, int error) {
  return absl::ErrnoToStatus(error, absl::StrCat("cannot ", what, " ", path));
}

/// Owns a file descriptor, and closes it at the end.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ >= 0) {
      close(fd_);
    }
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return fd_; }

 private:
  int fd_;
};

bool write_all(int fd, const std::string& text) {
  std::size_t done = 0;
  while (done < text.size()) {
    const ssize_t written = write(fd, text.data() + done, text.size() - done);
    if (written < 0 && errno != EINTR) {
      return false;
    }
    done += written > 0 ? static_cast<std::size_t>(written) : 0;
  }
  return true;
}

}  // namespace

absl::Status make_private_folder(const std::string& folder) {
  if (mkdir(folder.c_str(), 0700) == 0) {
    return absl::OkStatus();
  }
  if (errno == ENOENT) {
    const std::filesystem::path parent = std::filesystem::path(folder).parent_path();
    if (!parent.empty() && parent != folder) {
      if (absl::Status status = make_private_folder(parent.string()); !status.ok()) {
        return status;
      }
      if (mkdir(folder.c_str(), 0700) == 0) {
        return absl::OkStatus();
      }
    }
  }
  const int error = errno;
  struct stat found {};
  if (error == EEXIST && stat(folder.c_str(), &found) == 0 && S_ISDIR(found.st_mode)) {
    return absl::OkStatus();
  }
  return failed("make the folder", folder, error);
}

absl::StatusOr<std::string> read_private_file(const std::string& path) {
  const Descriptor file(open(path.c_str(), O_RDONLY | O_CLOEXEC));
  struct stat found {};
  if (file.get() < 0 || fstat(file.get(), &found) != 0) {
    return failed("read", path, errno);
  }
  if ((found.st_mode & (S_IRWXG | S_IRWXO)) != 0) {
    return absl::PermissionDeniedError(
        absl::StrCat(path, " holds secrets, but other users can read it; run chmod 600 on it"));
  }
  std::string text(kMaxSize + 1, '\0');
  std::size_t size = 0;
  while (size < text.size()) {
    const ssize_t got = read(file.get(), text.data() + size, text.size() - size);
    if (got < 0 && errno != EINTR) {
      return failed("read", path, errno);
    }
    if (got == 0) {
      break;
    }
    size += got > 0 ? static_cast<std::size_t>(got) : 0;
  }
  if (size > kMaxSize) {
    return absl::ResourceExhaustedError(
        absl::StrCat(path, " has more than ", kMaxSize, " bytes: it is not the right file"));
  }
  text.resize(size);
  return text;
}

absl::Status write_private_file(const std::string& path, const std::string& text) {
  std::string temporary = path + ".XXXXXX";
  const Descriptor file(mkostemp(temporary.data(), O_CLOEXEC));  // makes it with mode 0600
  if (file.get() < 0) {
    return failed("make a file beside", path, errno);
  }
  if (!write_all(file.get(), text) || fsync(file.get()) != 0 ||
      rename(temporary.c_str(), path.c_str()) != 0) {
    const absl::Status status = failed("write", path, errno);
    unlink(temporary.c_str());
    return status;
  }
  const std::filesystem::path parent = std::filesystem::path(path).parent_path();
  const Descriptor folder(
      open(parent.empty() ? "." : parent.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (folder.get() < 0 || fsync(folder.get()) != 0) {
    return failed("sync", path, errno);
  }
  return absl::OkStatus();
}

}  // namespace bandsaw::link
