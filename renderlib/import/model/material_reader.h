#pragma once

// One material of a model: its numbers, colours and textures as Assimp has them.

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
  /// `file` outlives this.
  MaterialReader(ModelFile& file, unsigned index);

  const aiMaterial& material() const { return material_; }
  ModelKind kind() const { return file_.kind; }
  /// Nothing of other formats than glTF 2.
  const GltfMaterial* gltf() const;
  SceneDraft& draft() const { return file_.draft; }

  /// A number that the file gives, brought into [least, most]; one that is not finite is none.
  std::optional<double> number(const char* key, double least, double most) const;
  /// A colour that the file gives, each channel in [0, most].
  std::optional<Rgb> color(const char* key, float most) const;
  /// The fourth number of such a colour, in [0, 1]; 1 where there is none.
  double alpha_of(const char* key) const;

  /// A texture by Assimp's kind and number, and what its texels are.
  struct Slot {
    aiTextureType type;
    unsigned index = 0;
  };
  enum class As { kColor, kNumber, kAlpha };
  /// Not where its file is missing and that is only a warning.
  bool has(Slot slot) const;
  /// Its texture with its wrapping, filter, transform and uv set, or white. Errors name the
  /// material.
  absl::StatusOr<TextureId> map(Slot slot, As as, const Rgb& factor = {1, 1, 1});
  absl::StatusOr<TextureId> white() const { return file_.draft.textures.constant({1, 1, 1}); }
  /// An opacity map: the alpha of its image, else its brightness.
  absl::StatusOr<TextureId> opacity_map(Slot slot);
  /// The normals of a map of heights.
  absl::StatusOr<TextureId> bump_map(Slot slot);
  /// What makes F0 of `index` (> 1) as much as a map says (Principled::index_map).
  absl::StatusOr<TextureId> index_map(Slot slot, double index);
  /// Whether a map of heights in fact holds normals, as files often have it.
  bool holds_normals(Slot slot) const;

  /// A warning: "its specular map is left out".
  void unsupported(const std::string& what) { file_.unsupported.add(what, called_); }

  ModelMaterial add(const Material& material) const;

 private:
  std::string file_of(Slot slot) const;
  TextureStore::Use use_of(Slot slot);
  absl::StatusOr<TextureId> find(Slot slot, const TextureStore::Use& use);
  UvSet uv_set_of(unsigned assimp_set);
  void name_dead_files();
  absl::Status failed(const absl::Status& why) const;

  ModelFile& file_;
  const unsigned index_;
  const aiMaterial& material_;
  ModelTextures textures_;
  std::string called_;                ///< "\"steel\"", or its number
  std::set<std::string> dead_files_;  ///< as the model writes them
  std::vector<unsigned> uv_sets_;     ///< Assimp's numbers of the two that the material uses
};

}  // namespace bandsaw
