#pragma once

// A model file as Assimp has read it, before its animation is evaluated at a time. A
// LoadedModel is kept while the frames of a sequence are imported (draft/import_memory.h).

#include <assimp/Importer.hpp>

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "renderlib/geometry/mesh.h"
#include "renderlib/import/animation/animation.h"
#include "renderlib/import/model/assimp_files.h"
#include "renderlib/import/model/collada_cameras.h"
#include "renderlib/import/model/gltf_extensions.h"
#include "renderlib/import/model/mtl_options.h"

struct aiScene;

namespace bandsaw {

/// A mesh that no animation changes, converted for the scene.
struct StillMesh {
  std::shared_ptr<const Mesh> mesh;
  std::vector<std::string> warnings;  ///< warnings of the conversion; repeated for each frame
};

/// Still meshes of one model. The key is Assimp's number of the mesh, whether its colours were
/// read, and the numbers of its two uv sets.
using StillMeshes = std::map<std::tuple<unsigned, bool, unsigned, unsigned>, StillMesh>;

struct LoadedModel {
  RefusedFiles refused;
  MtlOptions mtl;             ///< of the MTL files of an OBJ file
  ColladaLenses lenses;       ///< of the cameras of a COLLADA file
  Assimp::Importer importer;  ///< owns the scene
  const aiScene* scene = nullptr;
  GltfExtensions gltf;  ///< set for a glTF file
  std::vector<std::string> animation_names;
  std::optional<Animation> animation;  ///< the chosen animation; std::nullopt: none
  StillMeshes still_meshes;            ///< still meshes that were converted
};

}  // namespace bandsaw
