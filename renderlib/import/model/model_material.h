#pragma once

#include <optional>

#include "absl/status/statusor.h"
#include "renderlib/base/ids.h"
#include "renderlib/math/rgb.h"

namespace bandsaw {

struct ModelFile;
class MaterialReader;

inline constexpr unsigned kNoUvSet = ~0u;

/// A material of a model in the draft, and which of a mesh's sets of uvs become the two that ours
/// have.
struct ModelMaterial {
  MaterialId id{};
  unsigned uv_set = 0;
  unsigned second_uv_set = kNoUvSet;
  /// What the material becomes on a mesh that encloses a volume (KHR_materials_volume).
  struct Glass {
    MaterialId id{};
    Rgb absorption;  ///< of what is inside, per scene unit
  };
  std::optional<Glass> glass = std::nullopt;
};

/// Metallic-roughness materials, glTF's among them, become Principled; the older kinds become
/// Diffuse, Emissive or Principled (model_classic.cpp). NOT_FOUND, PERMISSION_DENIED,
/// INVALID_ARGUMENT: a texture, with the model's and the material's name.
absl::StatusOr<ModelMaterial> read_model_material(ModelFile& file, unsigned index);

/// The two kinds, for read_model_material.
absl::StatusOr<ModelMaterial> read_metallic_roughness(MaterialReader& reader);
absl::StatusOr<ModelMaterial> read_classic(MaterialReader& reader);

}  // namespace bandsaw
