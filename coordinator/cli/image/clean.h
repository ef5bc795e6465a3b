#pragma once

// The clean image beside the one as rendered (renderlib/denoise).

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "coordinator/cli/image/layers.h"
#include "renderlib/denoise/denoise.h"
#include "renderlib/image/display.h"
#include "renderlib/render/film.h"
#include "renderlib/render/kernel.h"

namespace bandsaw::coordinator {

/// The guides are rendered with at most this many samples; more do not improve the result.
inline constexpr std::uint64_t kMaxGuideSamples = 32;

/// The parts of an image of `samples` samples per pixel that the denoiser needs.
struct ToClean {
  const Image& mean;                     ///< as rendered
  std::optional<Film::FirstPart> first;  ///< std::nullopt: it is rendered, from half of the samples
  RenderSettings settings;
  std::uint64_t samples = 0;
};

/// Renders the guides, and the first part if it is missing, and removes the noise. Returns
/// FAILED_PRECONDITION if the image has a single sample per pixel, and the errors of `render`.
absl::StatusOr<Denoised> make_clean(ToClean input, const LayerRenderer& render,
                                    const Kernel& kernel, Pool& pool);

/// Returns the files that hold the image as rendered beside these outputs: picture.raw.png beside
/// picture.png. EXR files hold both images and need none.
std::vector<std::string> raw_outputs(const std::vector<std::string>& outputs);

/// Writes the clean image to the outputs and the image as rendered to raw_outputs(). EXR files get
/// the layers `raw` and `error` besides `layers`. Tries all files and returns the first error.
absl::Status write_clean_outputs(const Denoised& clean, const Image& raw,
                                 const std::vector<std::string>& outputs, const Display& display,
                                 Layers layers);

}  // namespace bandsaw::coordinator
