#pragma once

// Removes noise by Intel's library OpenImageDenoise, version 1 or 2, for --denoise=oidn. The
// library is loaded at run time, if it is installed; nothing of it is needed to build this program.
// Its functions are those of https://www.openimagedenoise.org/documentation.html, "C API".

#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "renderlib/image/image.h"

namespace bandsaw::coordinator {

/// The loaded library. An object may be used by one thread at a time.
class Oidn {
 public:
  /// Loads the library. `file` is its path; if it is empty, the system searches for the library.
  /// UNAVAILABLE: it is not installed, or not usable; the message states the cause and the remedy.
  static absl::StatusOr<Oidn> load(const std::string& file = "");

  /// Returns `color` without noise. `color` has linear values, `albedo` values in [0, 1], `normal`
  /// unit vectors or zeros. All MUST have the same size. INTERNAL: the library's error.
  absl::StatusOr<Image> filter(const Image& color, const Image& albedo, const Image& normal) const;

 private:
  struct Library;
  explicit Oidn(std::shared_ptr<const Library> library) : library_(std::move(library)) {}
  std::shared_ptr<const Library> library_;
};

}  // namespace bandsaw::coordinator
