#include "renderlib/import/use_camera.h"

#include <algorithm>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/numbers.h"

namespace bandsaw {
namespace {

std::string known(const SceneDraft& draft) {
  std::vector<std::string> names;
  for (const FoundCamera& camera : draft.cameras) {
    names.push_back(absl::StrCat("\"", camera.name, "\" (", camera.model, ")"));
  }
  return names.empty() ? "the scene's models bring none"
                       : absl::StrCat("there are ", absl::StrJoin(names, ", "));
}

absl::Status set_lens(const Field& in, const scene::Camera& from, PerspectiveCamera& camera) {
  camera.aperture = from.aperture();
  RETURN_IF_ERROR(check_range(in, "aperture", camera.aperture, 0, kMostLens));
  if (camera.aperture > 0 && !from.has_focus_distance()) {
    return in.error("focus_distance", "is required where a model's camera gets an aperture");
  }
  if (from.has_focus_distance()) {
    camera.focus_distance = from.focus_distance();
    RETURN_IF_ERROR(
        check_range(in, "focus_distance", camera.focus_distance, kLeastFocus, kMostLens));
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<Camera> use_camera(const Field& root, const scene::Scene& from,
                                  const SceneDraft& draft) {
  const Field in = root.child("camera");
  const scene::Camera& written = from.camera();
  if (!written.position().empty() || !written.look_at().empty() || !written.up().empty() ||
      written.rotate_size() > 0 || written.has_vertical_fov() || written.has_orthographic()) {
    return in.error("use",
                    "stands instead of position, look_at, up, rotate, vertical_fov and "
                    "orthographic: write one or the other");
  }
  const auto found =
      std::find_if(draft.cameras.begin(), draft.cameras.end(),
                   [&](const FoundCamera& camera) { return camera.name == written.use(); });
  if (found == draft.cameras.end()) {
    return in.error("use", absl::StrCat("no model brings a camera called \"", written.use(),
                                        "\"; ", known(draft)));
  }
  Camera camera = found->camera;
  std::visit([&](auto& c) { c.shutter = draft.shutter; }, camera);
  if (auto* perspective = std::get_if<PerspectiveCamera>(&camera)) {
    RETURN_IF_ERROR(set_lens(in, written, *perspective));
  } else if (written.has_aperture() || written.has_focus_distance()) {
    return in.error("aperture", "is of a perspective camera; this one is orthographic");
  }
  return camera;
}

}  // namespace bandsaw
