#pragma once

// Reads one material of a model: its numbers, colours and textures as Assimp stores them. Used by
// model_classic.cpp and model_metallic_roughness.cpp, which decide what the values mean.

#include <assimp/material.h>

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "renderlib/import/model/model_file.h"
#include "renderlib/import/model/model_material.h"
#include "renderlib/import/model/model_textures.h"
#include "renderlib/math/rgb.h"

namespace bandsaw {

class MaterialReader {
 public:
  /// `file` MUST outlive this object; `index` is Assimp's number of the material.
  MaterialReader(ModelFile& file, unsigned index);

  const aiMaterial& material() const { return material_; }
  ModelKind kind() const { return file_.kind; }
  /// Returns the material in the JSON of glTF 2; nullptr for other formats, and for a material that
  /// Assimp made.
  const GltfMaterial* gltf() const;
  SceneDraft& draft() const { return file_.draft; }

  /// Returns the number under Assimp's key, such as "$mat.opacity", clamped to [least, most];
  /// std::nullopt if it is absent or not finite.
  std::optional<double> number(const char* key, double least, double most) const;
  /// Returns a colour of the material, each channel clamped to [0, most]; std::nullopt if it is
  /// absent.
  std::optional<Rgb> color(const char* key, float most) const;
  /// Returns the alpha of the colour under Assimp's key, clamped to [0, 1]; 1 if it is absent.
  double alpha_of(const char* key) const;

  /// Returns true if a mesh of this material has vertex colours.
  bool has_vertex_colors() const;
  /// Returns true if Assimp made the material for the parts of an OBJ file that have none.
  bool is_default_of_obj() const;

  /// A texture of the material, by Assimp's kind and its number within the kind.
  struct Slot {
    aiTextureType type;
    unsigned index = 0;
  };
  /// The meaning of a texture's texels: sRGB colours, linear numbers, or numbers in the alpha
  /// channel.
  enum class As { kColor, kNumber, kAlpha };
  /// Returns false if the material does not have the texture. In a model of ModelKind::kOther, also
  /// returns false, after a warning, if the texture's file is missing or must not be read.
  bool has(Slot slot) const;
  /// Returns the texture with its wrap mode, filter, transform and uv set, its texels multiplied by
  /// `factor`; a white texture if has() is false. Errors name the material.
  absl::StatusOr<TextureId> map(Slot slot, As as, const Rgb& factor = {1, 1, 1});
  absl::StatusOr<TextureId> white() const { return file_.draft.textures.constant({1, 1, 1}); }
  /// Returns an opacity map. The opacity is the alpha of the image if the alpha is not 1 everywhere
  /// or if the image is also the colour texture. Otherwise it is the brightness of the image.
  absl::StatusOr<TextureId> opacity_map(Slot slot);
  /// Returns a normal map that is computed from the height map in the slot.
  absl::StatusOr<TextureId> bump_map(Slot slot);
  /// Returns a texture for MetallicRoughness::index_map. With this texture, the
  /// reflectance at normal incidence is F0 times the texel of the slot. F0 is the reflectance at
  /// normal incidence of the index of refraction `index` (> 1).
  absl::StatusOr<TextureId> index_map(Slot slot, double index);
  /// Returns true if the height map in the slot contains normals instead of heights, as is common.
  bool holds_normals(Slot slot) const;

  /// Adds a warning such as "its specular map is left out".
  void unsupported(const std::string& what) { file_.unsupported.add(what, called_); }

  /// Adds the material to the draft, the scene that is being read. Returns its id and the uv sets
  /// that its textures use.
  ModelMaterial add(const Material& material) const;

 private:
  std::string name() const;  ///< as in the file
  /// Returns the name of the texture's file as in the model; "" if there is no texture.
  std::string file_of(Slot slot) const;
  /// Returns the wrap modes, filter, transform and uv set of a texture.
  TextureStore::Use use_of(Slot slot);
  /// Adds the texture in the slot to the draft, as `use` describes.
  absl::StatusOr<TextureId> find(Slot slot, const TextureStore::Use& use);
  /// Returns the material's set for Assimp's number of a uv set. A third set is replaced by the
  /// first, with a warning.
  UvSet uv_set_of(unsigned assimp_set);
  /// Fills dead_files_, with a warning for each file.
  void find_dead_files();
  /// Returns the error with the names of the model and the material before its message.
  absl::Status failed(const absl::Status& why) const;

  ModelFile& file_;
  const unsigned index_;
  const aiMaterial& material_;
  ModelTextures textures_;
  std::string called_;                ///< name in messages: "\"steel\"", or its number
  std::set<std::string> dead_files_;  ///< missing or refused textures, named as in the model
  std::vector<unsigned> uv_sets_;  ///< Assimp's numbers of the two uv sets that the material uses
};

}  // namespace bandsaw
