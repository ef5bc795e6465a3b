#pragma once

// Reads the materials of a model. The model's meshes refer to the materials.

#include <optional>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "renderlib/base/ids.h"
#include "renderlib/math/rgb.h"

namespace bandsaw {

struct ModelFile;
class MaterialReader;
struct Alpha;

inline constexpr unsigned kNoUvSet = ~0u;

/// A material of a model that was added to the draft (the scene while it is being read).
struct ModelMaterial {
  MaterialId id{};
  unsigned uv_set = 0;                ///< Assimp's number of the first uv set of its meshes
  unsigned second_uv_set = kNoUvSet;  ///< of the second uv set; kNoUvSet: there is none
  /// The material on a mesh that encloses a volume (KHR_materials_volume).
  struct Glass {
    MaterialId id{};
    Rgb absorption;  ///< absorption of the inside, per scene unit
  };
  std::optional<Glass> glass = std::nullopt;
};

/// Reads the material with Assimp's number `index`. Metallic-roughness materials, including glTF's,
/// become MetallicRoughness; the older kinds become Diffuse, Emissive or MetallicRoughness
/// (model_classic.cpp). Returns NOT_FOUND, PERMISSION_DENIED or INVALID_ARGUMENT for a texture,
/// with the names of the model and the material.
absl::StatusOr<ModelMaterial> read_model_material(ModelFile& file, unsigned index);

/// These functions implement read_model_material() for metallic-roughness and for older materials.
absl::StatusOr<ModelMaterial> read_metallic_roughness(MaterialReader& reader);
absl::StatusOr<ModelMaterial> read_classic(MaterialReader& reader);

/// Sets the alpha of a metallic-roughness or unlit material. Fails as read_model_material() does.
absl::Status read_alpha(MaterialReader& reader, Alpha& to);

}  // namespace bandsaw
