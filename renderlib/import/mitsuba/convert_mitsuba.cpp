// Converts a Mitsuba scene to a Bandsaw scene file. The objects are converted in the order sensor,
// integrator, shapes, emitters. Materials, textures and media are converted where they are used.

#include "renderlib/import/mitsuba/convert_mitsuba.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/convert/made_files.h"
#include "renderlib/import/mitsuba/conversion.h"
#include "renderlib/import/mitsuba/emitters.h"
#include "renderlib/import/mitsuba/read_scene_tree.h"
#include "renderlib/import/mitsuba/shapes.h"
#include "renderlib/import/mitsuba/view.h"

namespace bandsaw {
namespace mitsuba {
namespace {

/// Converts the <scene> element `root` to `scene`. `to` collects the warnings and the made files.
absl::Status convert(const Object& root, scene::Scene& scene, Conversion& to) {
  const Parameters from(root);
  const auto sensors = [&] {
    auto found = from.objects("sensor");
    return found.empty() ? from.objects("camera") : found;  // "camera": version 0.5
  }();
  if (sensors.empty()) {
    return error_at(root.place, "the scene has no sensor");
  }
  if (sensors.size() > 1) {
    to.warn(sensors[1]->place, "of several sensors the first is shown");
  }
  RETURN_IF_ERROR(set_sensor(*object_in(*sensors.front()), scene, to));
  for (const Property* integrator : from.objects("integrator")) {
    RETURN_IF_ERROR(set_integrator(*object_in(*integrator), scene, to));
  }
  ShapeReader shapes(scene, to);
  for (const Property* shape : from.objects("shape")) {
    RETURN_IF_ERROR(shapes.add(*object_in(*shape)));
  }
  for (const char* tag : {"emitter", "luminaire"}) {
    for (const Property* emitter : from.objects(tag)) {
      RETURN_IF_ERROR(add_emitter(*object_in(*emitter), scene, to));
    }
  }
  // Objects with these tags are converted where they are used. The loop marks them as read.
  for (const char* tag :
       {"bsdf", "texture", "medium", "phase", "volume", "spectrum", "film", "sampler", "rfilter"}) {
    from.objects(tag);
  }
  to.warn_of_unused(from);
  if (!scene.has_background()) {
    for (int i = 0; i < 3; ++i) {  // black, because Bandsaw's default is a sky
      scene.mutable_background()->mutable_constant()->add_rgb(0);
    }
  }
  return absl::OkStatus();
}

}  // namespace
}  // namespace mitsuba

absl::StatusOr<ConvertedScene> convert_mitsuba(const ForeignScene& from) {
  mitsuba::Files files(from);
  ASSIGN_OR_RETURN(mitsuba::SceneTree tree, mitsuba::read_scene_tree(from, files));
  ConvertedScene out;
  out.warnings = std::move(tree.warnings);
  MadeFiles made(from.name);
  mitsuba::Conversion to{files, made, out.warnings};
  to.is_old = tree.is_old;
  RETURN_IF_ERROR(mitsuba::convert(*tree.root, out.scene, to));
  out.made_files = made.take();
  return out;
}

}  // namespace bandsaw
