#pragma once

// Converts the bsdfs and area emitters of Mitsuba's shapes to materials of a Bandsaw scene
// file.

#include <map>
#include <set>
#include <string>
#include <tuple>

#include "absl/status/statusor.h"
#include "proto/scene.pb.h"
#include "renderlib/import/mitsuba/conversion.h"
#include "renderlib/import/mitsuba/textures.h"

namespace bandsaw::mitsuba {

/// The result of converting a surface of Mitsuba.
struct SurfaceMaterial {
  std::string name;  ///< name of the made material; empty: there is no surface (null)
  /// The geometry must be turned over, because the index of refraction is larger outside.
  bool turned = false;
};

/// The materials that have been made so far.
class Materials {
 public:
  /// Materials are added to `scene`. Both MUST outlive this object.
  Materials(scene::Scene& scene, Conversion& to) : scene_(scene), to_(to) {}

  /// Returns the material of a surface, made if it is new. If `bsdf` is nullptr, the material is
  /// Mitsuba's default, a grey diffuse surface. `emitter` is of type area, or nullptr if the
  /// surface does not emit.
  absl::StatusOr<SurfaceMaterial> material_of(const Object* bsdf, const Object* emitter,
                                              const TexturedSurface& surface);
  /// Finds out whether the material of `bsdf` turns its geometry over. Returns a SurfaceMaterial of
  /// which only `turned` is set. Adds no material.
  absl::StatusOr<SurfaceMaterial> sides_of(const Object* bsdf) const;

 private:
  using Key = std::tuple<const Object*, const Object*, UvFrame, std::map<std::string, std::string>>;
  /// Makes a material without a search for a known one. The name stays empty for a "null" bsdf
  /// without an emitter.
  absl::StatusOr<SurfaceMaterial> make(const Object* bsdf, const Object* emitter,
                                       const TexturedSurface& surface);
  /// Adds `material` to the scene, with a name and with the radiance of the emitter.
  absl::StatusOr<SurfaceMaterial> add(scene::Material material, bool turned, const Object* bsdf,
                                      const Object* emitter, const TexturedSurface& surface);
  /// Makes a mixture of the materials of the two bsdfs inside `bsdf`.
  absl::StatusOr<SurfaceMaterial> blend(const Object& bsdf, const Object* emitter,
                                        const TexturedSurface& surface);
  /// Returns the id of `bsdf`, its type if it has no id, or "default" for nullptr. Appends a number
  /// if this name is taken.
  std::string unique_name(const Object* bsdf);

  scene::Scene& scene_;
  Conversion& to_;
  std::map<Key, SurfaceMaterial> known_;
  std::set<std::string> names_;
  /// For each name, how many numbers unique_name() has tried to append. The first number is 2.
  std::map<std::string, int> counts_;
};

/// Returns true if the picture depends on the uv coordinates of the surface. The arguments of this
/// function and of the next two may be nullptr, as in Materials::material_of.
bool needs_uv(const Object* bsdf, const Object* emitter);
/// Returns true if the bsdf, or a bsdf inside it, is a normal map. Then it matters whether the uv
/// frame of the surface is left-handed or right-handed.
bool needs_handedness(const Object* bsdf);
/// Returns true if the bsdf is "null": light passes as if there were no surface.
bool is_null(const Object* bsdf);

}  // namespace bandsaw::mitsuba
