// Takes the scene's settings, and replaces those for which the user has given an option.

#include "coordinator/cli/scene/image_settings.h"

#include "renderlib/base/status_macros.h"
#include "renderlib/package/settings_of.h"
#include "renderlib/render/frame_seed.h"

namespace bandsaw::coordinator {
absl::StatusOr<RenderSettings> image_settings(const ImageOptions& options,
                                              const PackageInfo& scene) {
  RenderSettings settings = settings_of(scene, options.width, options.height);
  settings.seed = options.choices.frame && !options.fixed_seed
                      ? seed_of_frame(options.seed, *options.choices.frame)
                      : options.seed;
  settings.max_depth = options.depth.value_or(settings.max_depth);
  settings.integrator = options.integrator.value_or(settings.integrator);
  RETURN_IF_ERROR(validate(settings));
  return settings;
}

}  // namespace bandsaw::coordinator
