#pragma once

// The renderer of one core of a browser's tab, compiled to WebAssembly. It builds scenes from blobs
// (the data of a scene, as arrays that are named by their SHA-256) and renders rows of bands (a
// band is a range of rows and samples). The page's JavaScript calls the renderer through exports.h,
// fetches the blobs and checks their digests.

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "proto/wire/digest.h"
#include "renderlib/base/pool.h"
#include "renderlib/base/shared_bytes.h"
#include "renderlib/image/display.h"
#include "renderlib/package/decoded_parts.h"
#include "renderlib/package/package.h"
#include "renderlib/render/band.h"
#include "renderlib/scene/scene.h"
#include "worker/executor/task.h"

namespace bandsaw::worker {

class BrowserRenderer {
 public:
  BrowserRenderer() : pool_(1) {}

  /// Begins a scene. `manifest`: the digest of the manifest. `text`: the manifest itself. The
  /// caller has checked that the text has this digest. Returns the blobs that the scene needs, in
  /// the order in which they are used, without the blobs that loaded scenes have already. If
  /// another scene was begun and not built, drops that scene. INVALID_ARGUMENT: the manifest is
  /// broken.
  absl::StatusOr<std::vector<BlobRef>> begin_scene(const wire::Digest& manifest, std::string text);
  /// Takes a blob of the scene that was begun. The caller has checked the digest of the bytes.
  /// INVALID_ARGUMENT: the scene has no blob with this digest and size. FAILED_PRECONDITION: no
  /// scene was begun.
  absl::Status add_blob(const wire::Digest& digest, SharedBytes bytes);
  /// Builds the scene that was begun from its blobs. NOT_FOUND: a blob is missing.
  /// INVALID_ARGUMENT: the package is broken. FAILED_PRECONDITION: no scene was begun.
  absl::Status build_scene();
  /// Frees a scene, if it is loaded.
  void drop_scene(const wire::Digest& manifest) { scenes_.erase(manifest); }
  /// Returns the row step of a scene. A band should be divided only at rows that are multiples of
  /// this step. The step is 16 if pixels share paths, because the 16 rows of a tile then have to be
  /// rendered together. Otherwise the step is 1. NOT_FOUND: the scene is not loaded.
  absl::StatusOr<std::uint32_t> row_step(const wire::Digest& manifest) const;

  /// Renders rows of a task's band. The sums of these rows are the same as if the whole band were
  /// rendered at once.
  /// NOT_FOUND: the scene is not loaded. INVALID_ARGUMENT: the rows do not lie in the band.
  /// `step` is called after each step of the preparation before the first row.
  absl::StatusOr<BandPixels> render(const Task& task, const RowRange& rows,
                                    const std::function<void()>& step);
  /// Returns the rows as 8-bit sRGB with the scene's exposure and tone. A pixel has 4 bytes, of
  /// which the last is 255. Pixels without samples are black. `pixels`: the result of render() with
  /// `task`.
  std::vector<std::uint8_t> picture(const Task& task, const BandPixels& pixels) const;

 private:
  /// `display`: how the scene's radiance is shown as 8-bit colours.
  struct Loaded {
    std::shared_ptr<const Scene> scene;
    Display display;
  };
  /// A scene whose blobs are being collected.
  struct Begun {
    wire::Digest manifest;
    std::string text;
    std::map<wire::Digest, std::uint64_t> sizes;  ///< sizes of the blobs that the scene needs
    std::map<wire::Digest, SharedBytes> blobs;    ///< the blobs that were added so far
  };

  Pool pool_;
  DecodedParts parts_;  ///< meshes and blobs of loaded scenes, which later scenes may share
  std::unique_ptr<Begun> begun_;
  std::map<wire::Digest, Loaded> scenes_;
};

}  // namespace bandsaw::worker
