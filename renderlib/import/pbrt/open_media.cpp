// pbrt bounds media by single surfaces, which need not be closed. In Bandsaw a medium with open
// surfaces fills the box around the scene. Media are ordered so that inside a closed shape, the
// medium of the shape replaces the medium that fills the box.

#include "renderlib/import/pbrt/open_media.h"

#include <algorithm>
#include <set>
#include <utility>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/pbrt/mesh_shapes.h"

namespace bandsaw::pbrt {
namespace {

/// Adds the vertices of the unchanged files to the extent of the scene. They are read only if a
/// medium needs the extent.
absl::Status add_unchanged_files(Builder& builder) {
  for (const UnchangedFile& file : std::exchange(builder.unchanged_files, {})) {
    ASSIGN_OR_RETURN(const auto mesh, mesh_of("plymesh", file.parameters, builder));
    if (mesh) {
      for (const auto& p : mesh->positions) {
        builder.extent.add(file.to_world.point({p[0], p[1], p[2]}));
      }
    }
  }
  return absl::OkStatus();
}

/// Fills the box around the scene with each medium that an open surface bounds, except the camera's
/// medium. Returns the names that these media have in our scene.
absl::StatusOr<std::set<std::string>> fill_open_media(const std::string& of_camera,
                                                      Builder& builder) {
  std::set<std::string> filled;
  for (const auto& [name, place] : builder.open_media) {
    if (name == of_camera) {
      continue;
    }
    const bool is_known = builder.media.count(name) > 0;
    ASSIGN_OR_RETURN(const std::string medium, medium_name(name, place, {}, builder));
    if (medium.empty() || !is_known) {
      continue;
    }
    builder.warn(place, absl::StrCat("the medium \"", name,
                                     "\" is bounded by open surfaces: it fills the box around "
                                     "the scene's shapes"));
    RETURN_IF_ERROR(add_unchanged_files(builder));
    const Vec3 size = builder.extent.high - builder.extent.low;
    const double margin = 1e-4 * max_abs(size);
    const Vec3 edge{margin, margin, margin};
    scene::Shape& box = *builder.out.add_shape();
    set_vec3(builder.extent.low - edge, box.mutable_box()->mutable_min());
    set_vec3(builder.extent.high + edge, box.mutable_box()->mutable_max());
    box.set_interior(medium);
    filled.insert(medium);
  }
  return filled;
}

/// Orders the media, because a later medium replaces an earlier one where they overlap. The media
/// in `filled`, which fill the box around the scene, come first. The vacuum, which is the empty
/// medium inside of clear glass that lies in a medium, comes last.
void order_media(const std::set<std::string>& filled, Builder& builder) {
  auto& media = *builder.out.mutable_medium();
  const auto rank = [&filled](const scene::Medium& medium) {
    return filled.contains(medium.name()) ? 0 : medium.name() == kVacuum ? 2 : 1;
  };
  std::stable_sort(
      media.pointer_begin(), media.pointer_end(),
      [&](const scene::Medium* a, const scene::Medium* b) { return rank(*a) < rank(*b); });
}

}  // namespace

absl::Status finish_media(const std::string& of_camera, Builder& builder) {
  ASSIGN_OR_RETURN(const std::set<std::string> filled, fill_open_media(of_camera, builder));
  if (builder.needs_vacuum) {
    builder.out.add_medium()->set_name(kVacuum);
  }
  order_media(filled, builder);
  return absl::OkStatus();
}

}  // namespace bandsaw::pbrt
