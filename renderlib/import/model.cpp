#include "renderlib/import/model.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/DefaultLogger.hpp>
#include <assimp/Importer.hpp>

#include <algorithm>
#include <memory>
#include <set>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/strip.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/assimp_files.h"
#include "renderlib/import/model_material.h"
#include "renderlib/import/model_mesh.h"
#include "renderlib/import/model_nodes.h"

namespace bandsaw {
namespace {

// Assimp's reason, or what it was not allowed or able to open, which is mostly the true reason.
absl::Status read_failure(const std::string& name, const RefusedFiles& refused,
                          absl::string_view reason) {
  if (!refused.outside.empty()) {
    return absl::PermissionDeniedError(absl::StrCat(name, ": ", refused.outside.front()));
  }
  if (!refused.missing.empty()) {
    return absl::NotFoundError(
        absl::StrCat(name, ": its file \"", refused.missing.front(), "\" is missing"));
  }
  absl::ConsumePrefix(&reason, "Fatal Error: ");
  return absl::InvalidArgumentError(absl::StrCat(
      name, ": cannot be read: ", reason.empty() ? "it is damaged or not supported" : reason));
}

void warn_of_missing(const std::string& name, RefusedFiles refused, SceneDraft& draft) {
  auto& files = refused.missing;
  std::sort(files.begin(), files.end());
  files.erase(std::unique(files.begin(), files.end()), files.end());
  for (const std::string& file : files) {
    draft.out.info.warnings.push_back(absl::StrCat(name, ": its file \"", file, "\" is missing"));
  }
}

void warn_of_unused(const std::string& name, const aiScene& scene, SceneDraft& draft) {
  const auto warn = [&](unsigned count, absl::string_view what) {
    if (count > 0) {
      draft.out.info.warnings.push_back(absl::StrCat(name, ": ", count, " ", what, " left out"));
    }
  };
  const auto count_meshes = [&](auto has) {
    return static_cast<unsigned>(
        std::count_if(scene.mMeshes, scene.mMeshes + scene.mNumMeshes, has));
  };
  warn(scene.mNumAnimations, "animations are");
  warn(scene.mNumLights, "lights are");
  warn(count_meshes([](const aiMesh* mesh) { return mesh->HasBones(); }),
       "meshes have bones, which are");
  warn(count_meshes([](const aiMesh* mesh) { return mesh->HasVertexColors(0); }),
       "meshes have vertex colours, which are");
}

std::set<unsigned> used_materials(const aiScene& scene) {
  std::set<unsigned> used;
  for (unsigned i = 0; i < scene.mNumMeshes; ++i) {
    if (scene.mMeshes[i]->mMaterialIndex < scene.mNumMaterials) {
      used.insert(scene.mMeshes[i]->mMaterialIndex);
    }
  }
  return used;
}

}  // namespace

bool is_model_file(const std::string& path) {
  const std::string lower = absl::AsciiStrToLower(path);
  return absl::EndsWith(lower, ".gltf") || absl::EndsWith(lower, ".glb") ||
         absl::EndsWith(lower, ".obj");
}

absl::StatusOr<Model> read_model(const std::string& path, bool with_materials, SceneDraft& draft) {
  const std::string name = name_of(path);
  const std::size_t warnings_before = draft.out.info.warnings.size();
  RefusedFiles refused;
  Assimp::Importer importer;
  importer.SetIOHandler(std::make_unique<AssimpFiles>(draft.folder, path, refused).release());
  // Nothing that alters geometry: faces become triangles, that is all.
  const aiScene* scene = importer.ReadFile(path, aiProcess_Triangulate);
  if (scene == nullptr || scene->mRootNode == nullptr || !refused.outside.empty()) {
    return read_failure(name, refused, importer.GetErrorString());
  }
  warn_of_missing(name, refused, draft);
  warn_of_unused(name, *scene, draft);

  std::vector<ModelMaterial> materials(scene->mNumMaterials);
  if (with_materials) {
    // Assimp adds a material of its own, and files hold more than they use; what is not used is not
    // read.
    for (const unsigned used : used_materials(*scene)) {
      ASSIGN_OR_RETURN(materials[used], read_model_material(*scene, used, path, draft));
    }
  } else {
    // The scene's own material may use either.
    std::fill(materials.begin(), materials.end(), ModelMaterial{.second_uv_set = 1});
  }
  ASSIGN_OR_RETURN(const ModelMeshes meshes, add_meshes(*scene, materials, name, draft));
  ASSIGN_OR_RETURN(Model model, read_nodes(*scene, meshes, name, draft.out.info.warnings));
  if (model.instances.empty()) {
    const auto& warnings = draft.out.info.warnings;
    return absl::InvalidArgumentError(
        absl::StrCat(name, ": holds no triangle that can be rendered",
                     warnings.size() > warnings_before ? "; " + warnings.back() : ""));
  }
  return model;
}

}  // namespace bandsaw
