#pragma once

// The denoiser of Intel's library OpenImageDenoise, version 1 or 2, if it is installed. It is
// loaded at run time; nothing of it is needed to build this program. The declarations are those of
// its documentation (https://www.openimagedenoise.org/documentation.html, "C API").

#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "renderlib/image/image.h"

namespace bandsaw::coordinator {

/// Used by one thread at a time.
class Oidn {
 public:
  /// Loads the library; `file`: its path, empty: where the system finds it. UNAVAILABLE: it is not
  /// installed, or not usable; the message has the cause and the cure.
  static absl::StatusOr<Oidn> load(const std::string& file = "");

  /// Returns the clean image. `albedo` is in [0, 1], `normal` has unit vectors or zeros; all have
  /// the same size. INTERNAL: the library's error.
  absl::StatusOr<Image> filter(const Image& color, const Image& albedo, const Image& normal) const;

 private:
  struct Library;
  explicit Oidn(std::shared_ptr<const Library> library) : library_(std::move(library)) {}
  std::shared_ptr<const Library> library_;
};

}  // namespace bandsaw::coordinator
