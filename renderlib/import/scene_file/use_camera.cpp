// Collects the cameras of a scene's models, and finds one by name. A camera has three names, which
// are tried in this order: the name of its node (the object of the model that carries the camera),
// its own name, and "FILE/NODE".

#include "renderlib/import/scene_file/use_camera.h"

#include <algorithm>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/scene_file/numbers.h"
#include "renderlib/import/scene_file/read_view.h"
#include "renderlib/package/limits.h"

namespace bandsaw {
namespace {

/// Returns the name "FILE/NODE".
std::string with_file(const FoundCamera& camera) {
  return absl::StrCat(camera.model, "/", camera.name);
}

/// Returns the cameras whose node has this name. If there are none, returns the cameras whose own
/// name is this name. If these are missing too, returns the cameras whose "FILE/NODE" is this name.
std::vector<const FoundCamera*> called(const std::string& name,
                                       const std::vector<FoundCamera>& cameras) {
  const auto all = [&](auto name_of) {
    std::vector<const FoundCamera*> found;
    for (const FoundCamera& camera : cameras) {
      if (name_of(camera) == name) {
        found.push_back(&camera);
      }
    }
    return found;
  };
  auto found = all([](const FoundCamera& camera) { return camera.name; });
  if (found.empty()) {
    found = all([](const FoundCamera& camera) { return camera.own_name; });
  }
  return found.empty() ? all(with_file) : found;
}

/// Returns the end of an error message, which lists the names of the cameras.
std::string known_names(const std::vector<FoundCamera>& cameras) {
  const auto quoted = [](std::string* out, const std::string& name) {
    absl::StrAppend(out, "\"", name, "\"");
  };
  return cameras.empty()
             ? "the scene's models have no camera"
             : absl::StrCat("there are ", absl::StrJoin(names_of(cameras), ", ", quoted));
}

/// Returns the only camera called `name`, with the shutter of the draft. Returns INVALID_ARGUMENT,
/// with the names of all cameras, if no camera has this name or several cameras have it.
absl::StatusOr<MovingCamera> find_camera(const std::string& name, const SceneDraft& draft) {
  const auto found = called(name, draft.cameras);
  if (found.size() == 1) {
    return with_shutter(*found.front(), draft.shutter);
  }
  return absl::InvalidArgumentError(
      absl::StrCat(found.empty() ? "no model has a camera" : "several cameras are", " called \"",
                   name, "\"; ", known_names(draft.cameras)));
}

/// Sets aperture and focus distance of `camera` as the scene file gives them.
absl::Status set_lens(const Field& in, const scene::Camera& from, PerspectiveCamera& camera) {
  camera.aperture = from.aperture();
  RETURN_IF_ERROR(check_range(in, "aperture", camera.aperture, 0, kMaxLens));
  if (camera.aperture > 0 && !from.has_focus_distance()) {
    return in.error("focus_distance", "is required if a model's camera gets an aperture");
  }
  if (from.has_focus_distance()) {
    camera.focus_distance = from.focus_distance();
    RETURN_IF_ERROR(check_range(in, "focus_distance", camera.focus_distance, kMinFocus, kMaxLens));
  }
  return absl::OkStatus();
}

}  // namespace

void add_cameras(const std::string& file, const Model& model, const Transform& at_open,
                 const Transform& at_close, SceneDraft& draft) {
  const bool is_known = std::any_of(draft.cameras.begin(), draft.cameras.end(),
                                    [&](const FoundCamera& c) { return c.model == file; });
  if (is_known || draft.placed != &draft.world) {
    return;
  }
  for (const ModelCamera& camera : model.cameras) {
    draft.cameras.push_back({file, camera.name, camera.own_name, placed(camera.camera, at_open)});
    if (camera.at_close || !(at_open == at_close)) {
      draft.cameras.back().at_close = placed(camera.at_close.value_or(camera.camera), at_close);
    }
  }
}

std::vector<std::string> names_of(const std::vector<FoundCamera>& cameras) {
  std::vector<std::string> names;
  for (const FoundCamera& camera : cameras) {
    if (names.size() == kMaxCameraNames) {
      break;
    }
    for (const std::string& name : {camera.name, camera.own_name, with_file(camera)}) {
      const auto found = called(name, cameras);
      if (!name.empty() && found.size() == 1 && found.front() == &camera) {
        names.push_back(name);
        break;
      }
    }
  }
  return names;
}

MovingCamera with_shutter(const FoundCamera& camera, const Shutter& shutter) {
  MovingCamera out{camera.camera, camera.at_close};
  std::visit([&](auto& c) { c.shutter = shutter; }, out.at_open);
  if (out.at_close) {
    std::visit([&](auto& c) { c.shutter = shutter; }, *out.at_close);
  }
  return out;
}

absl::StatusOr<MovingCamera> chosen_camera(const std::string& name, const SceneDraft& draft) {
  auto found = find_camera(name, draft);
  return found.ok()
             ? std::move(found)
             : absl::InvalidArgumentError(absl::StrCat(draft.file, ": ", found.status().message()));
}

absl::StatusOr<MovingCamera> use_camera(const Field& root, const scene::Scene& from,
                                        const SceneDraft& draft) {
  const Field in = root.child("camera");
  const scene::Camera& written = from.camera();
  if (!written.position().empty() || !written.look_at().empty() || !written.up().empty() ||
      written.rotate_size() > 0 || written.has_vertical_fov() || written.has_orthographic()) {
    return in.error("use",
                    "write use, or position, look_at, up, rotate, vertical_fov and orthographic, "
                    "not both");
  }
  auto found = find_camera(written.use(), draft);
  if (!found.ok()) {
    return in.error("use", found.status().message());
  }
  MovingCamera camera = *std::move(found);
  if (auto* perspective = std::get_if<PerspectiveCamera>(&camera.at_open)) {
    RETURN_IF_ERROR(set_lens(in, written, *perspective));
    if (camera.at_close) {
      RETURN_IF_ERROR(set_lens(in, written, std::get<PerspectiveCamera>(*camera.at_close)));
    }
  } else if (written.has_aperture() || written.has_focus_distance()) {
    return in.error("aperture", "is of a perspective camera; this one is orthographic");
  }
  RETURN_IF_ERROR(set_window(in, written, camera.at_open));
  if (camera.at_close) {
    RETURN_IF_ERROR(set_window(in, written, *camera.at_close));
  }
  return camera;
}

}  // namespace bandsaw
