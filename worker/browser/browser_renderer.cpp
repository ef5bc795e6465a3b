// Collects the blobs of a scene after begin_scene(), decodes the blobs and builds the scene. Rows
// are rendered by a pool with one thread.

#include "worker/browser/browser_renderer.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/image/srgb.h"
#include "renderlib/render/render_band.h"
#include "renderlib/render/tile_pattern.h"

namespace bandsaw::worker {
namespace {

/// The bytes of one blob.
class HeldBytes : public BlobBytes {
 public:
  explicit HeldBytes(SharedBytes bytes) : bytes_(std::move(bytes)) {}
  absl::Span<const std::byte> bytes() const override { return bytes_.span(); }

 private:
  SharedBytes bytes_;
};

/// The blobs of one package. Their digests were checked before.
class HeldBlobs : public BlobSource {
 public:
  explicit HeldBlobs(const std::map<wire::Digest, SharedBytes>& blobs) : blobs_(blobs) {}
  absl::StatusOr<std::unique_ptr<BlobBytes>> get(const wire::Digest& digest) override {
    const auto found = blobs_.find(digest);
    if (found == blobs_.end()) {
      return absl::NotFoundError(absl::StrCat("blob ", digest.hex(), " is missing"));
    }
    return std::make_unique<HeldBytes>(found->second);
  }

 private:
  const std::map<wire::Digest, SharedBytes>& blobs_;
};

absl::Status not_loaded() { return absl::NotFoundError("the scene is not loaded"); }

}  // namespace

absl::StatusOr<std::vector<BlobRef>> BrowserRenderer::begin_scene(const wire::Digest& manifest,
                                                                  std::string text) {
  begun_.reset();
  parts_.forget_unused();
  ASSIGN_OR_RETURN(const std::vector<BlobRef> blobs, missing_blobs(text, parts_));
  begun_ = std::make_unique<Begun>();
  begun_->manifest = manifest;
  begun_->text = std::move(text);
  for (const BlobRef& blob : blobs) {
    begun_->sizes[blob.digest] = blob.size;
  }
  return blobs;
}

absl::Status BrowserRenderer::add_blob(const wire::Digest& digest, SharedBytes bytes) {
  if (begun_ == nullptr) {
    return absl::FailedPreconditionError("no scene was begun");
  }
  const auto expected = begun_->sizes.find(digest);
  if (expected == begun_->sizes.end() || expected->second != bytes.size()) {
    return absl::InvalidArgumentError(
        absl::StrCat("the scene has no blob ", digest.hex(), " of ", bytes.size(), " bytes"));
  }
  begun_->blobs[digest] = std::move(bytes);
  return absl::OkStatus();
}

absl::Status BrowserRenderer::build_scene() {
  if (begun_ == nullptr) {
    return absl::FailedPreconditionError("no scene was begun");
  }
  const std::unique_ptr<Begun> begun = std::move(begun_);
  ASSIGN_OR_RETURN(const PackageInfo info, package_info(begun->text));
  HeldBlobs blobs(begun->blobs);
  ASSIGN_OR_RETURN(SceneDescription description, decode_package(begun->text, blobs, &parts_));
  begun->blobs.clear();  // the scene holds the blobs that it uses
  std::vector<std::shared_ptr<const Scene>> earlier;
  for (const auto& [digest, loaded] : scenes_) {
    earlier.push_back(loaded.scene);
  }
  ASSIGN_OR_RETURN(std::shared_ptr<const Scene> scene,
                   Scene::build(std::move(description), pool_, /*forced=*/{}, Traversal::kBvh,
                                /*kernel=*/nullptr, earlier));
  scenes_[begun->manifest] = {.scene = std::move(scene), .display = info.display};
  return absl::OkStatus();
}

absl::StatusOr<std::uint32_t> BrowserRenderer::row_step(const wire::Digest& manifest) const {
  const auto found = scenes_.find(manifest);
  if (found == scenes_.end()) {
    return not_loaded();
  }
  return found->second.scene->reuses_paths() ? kTileSide : 1;
}

absl::StatusOr<BandPixels> BrowserRenderer::render(const Task& task, const RowRange& rows,
                                                   const std::function<void()>& step) {
  const auto found = scenes_.find(task.manifest);
  if (found == scenes_.end()) {
    return not_loaded();
  }
  if (rows.first < task.band.rows.first || rows.last > task.band.rows.last ||
      rows.first >= rows.last) {
    return absl::InvalidArgumentError(
        absl::StrCat("rows ", rows.first, ":", rows.last, " do not lie in the band"));
  }
  const std::atomic<bool> never{false};  // render_band() is never stopped
  // render_band() reports 0 rows after each step of its preparation.
  const auto progress = [&](std::uint32_t rows_done) {
    if (rows_done == 0) {
      step();
    }
  };
  return render_band(*found->second.scene, task.settings,
                     {.samples = task.band.samples, .rows = rows}, pool_, never, progress,
                     task.tiles);
}

std::vector<std::uint8_t> BrowserRenderer::picture(const Task& task,
                                                   const BandPixels& pixels) const {
  const auto found = scenes_.find(task.manifest);
  const Display display = found != scenes_.end() ? found->second.display : Display{};
  std::vector<std::uint8_t> bytes;
  bytes.reserve(pixels.sums.size() / 3 * 4);
  const double* sum = pixels.sums.data();
  for (std::uint32_t y = pixels.band.rows.first; y < pixels.band.rows.last; ++y) {
    for (std::uint32_t x = 0; x < pixels.width; ++x, sum += 3) {
      const std::uint64_t samples = task.tiles.of_pixel(x, y, task.band.samples).samples();
      const double scale = samples > 0 ? 1.0 / static_cast<double>(samples) : 0.0;
      const Rgb light =
          shown({static_cast<float>(sum[0] * scale), static_cast<float>(sum[1] * scale),
                 static_cast<float>(sum[2] * scale)},
                display);
      bytes.insert(bytes.end(),
                   {srgb_encode(light.r), srgb_encode(light.g), srgb_encode(light.b), 255});
    }
  }
  return bytes;
}

}  // namespace bandsaw::worker
