#include "coordinator/web/scenes.h"

#include <sys/random.h>

#include <algorithm>
#include <array>

#include "absl/cleanup/cleanup.h"
#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "coordinator/web/reply.h"
#include "renderlib/base/check.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

RenderSettings settings_of(const PackageInfo& scene, std::uint32_t width) {
  RenderSettings settings{.width = scene.width,
                          .height = scene.height,
                          .max_depth = scene.max_depth,
                          .integrator = scene.integrator};
  if (width != 0) {
    const double height = double{1} * width * scene.height / scene.width;
    settings.width = width;
    settings.height =
        static_cast<std::uint32_t>(std::clamp(height + 0.5, 1.0, double{1} + kMaxSide));
  }
  return settings;
}

}  // namespace

std::string random_digits() {
  std::array<char, 8> bytes{};
  BANDSAW_CHECK(getentropy(bytes.data(), bytes.size()) == 0,
                "Linux gives up to 256 random bytes at any time");
  return absl::BytesToHexString({bytes.data(), bytes.size()});
}

absl::StatusOr<SubmittedScene> Scenes::submit(const std::string& path, const Wanted& wanted) {
  const absl::Cleanup done = [this] { --reading_; };
  if (++reading_ > kAtOnce) {
    return absl::ResourceExhaustedError("other scenes are being read; try again in a moment");
  }
  ASSIGN_OR_RETURN(SceneOnFarm scene, bring_(path, stop_));
  const JobSpec spec{
      .request_id = wanted.request_id.empty() ? "dashboard-" + random_digits() : wanted.request_id,
      .name = scene.info.name,
      .manifest = scene.manifest,
      .settings = settings_of(scene.info, wanted.width),
      .stop = wanted.stop};
  RETURN_IF_ERROR(validate(spec.settings));
  using Answer = absl::StatusOr<JobId>;
  ASSIGN_OR_RETURN(const JobId job,
                   ask<Answer>([&](auto answer) { engine_.submit(spec, answer); }));
  return SubmittedScene{job, std::move(scene.info.warnings)};
}

}  // namespace bandsaw::coordinator
