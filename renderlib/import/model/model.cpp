// Reads a model file: loads it with Assimp, converts its materials, meshes and nodes in this order,
// and turns it upright. Assimp does not read a glTF file itself, but a plain copy of it without the
// extensions and compression that Assimp does not know (gltf/plain_gltf.h).

#include "renderlib/import/model/model.h"

#include <assimp/DefaultIOSystem.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/DefaultLogger.hpp>
#include <assimp/Importer.hpp>

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/strip.h"
#include "renderlib/base/file.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/gltf/plain_gltf.h"
#include "renderlib/import/model/assimp_animation.h"
#include "renderlib/import/model/assimp_files.h"
#include "renderlib/import/model/collada_cameras.h"
#include "renderlib/import/model/gltf_extensions.h"
#include "renderlib/import/model/loaded_model.h"
#include "renderlib/import/model/model_file.h"
#include "renderlib/import/model/model_glass.h"
#include "renderlib/import/model/model_material.h"
#include "renderlib/import/model/model_mesh.h"
#include "renderlib/import/model/model_nodes.h"

namespace bandsaw {
namespace {

// Returns the error of a model that Assimp could not read. If there are files that Assimp could not
// open, the error names the first, because such a file is usually the cause.
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
  if (absl::StrContains(reason, "bad_alloc")) {
    return absl::ResourceExhaustedError(absl::StrCat(
        name, ": needs more memory than reading a file may take: the file is too large, or it is ",
        "damaged and claims more data than it has"));
  }
  return absl::InvalidArgumentError(absl::StrCat(
      name, ": cannot be read: ", reason.empty() ? "it is damaged or not supported" : reason));
}

// Warns once of each file that Assimp could not open.
void warn_of_missing(const std::string& name, RefusedFiles refused, SceneDraft& draft) {
  auto& files = refused.missing;
  std::sort(files.begin(), files.end());
  files.erase(std::unique(files.begin(), files.end()), files.end());
  for (const std::string& file : files) {
    draft.out.info.warnings.push_back(absl::StrCat(name, ": its file \"", file, "\" is missing"));
  }
}

// Warns of the animations, scenes, ranges of lights, extensions and options that are not used.
void warn_of_unused(const std::vector<std::string>& animations, ModelFile& file) {
  const auto quoted = [](std::string* out, const std::string& each) {
    absl::StrAppend(out, "\"", each, "\"");
  };
  if (!animations.empty() && (!file.animation || animations.size() > 1)) {
    file.warn(absl::StrCat("has the animations ", absl::StrJoin(animations, ", ", quoted),
                           file.animation
                               ? absl::StrCat("; \"", file.animation->name, "\" is shown")
                               : "; the rest pose is shown: --frame shows an animation"));
  }
  if (file.gltf.scenes > 1) {
    const std::size_t others = file.gltf.scenes - 1;
    file.warn(absl::StrCat(others, others == 1 ? " scene" : " scenes", " beside the default one ",
                           others == 1 ? "is" : "are", " left out"));
  }
  if (const std::size_t lights = file.gltf.lights_with_range; lights > 0) {
    file.warn(absl::StrCat("the range of ", lights, lights == 1 ? " light" : " lights",
                           " is left out: light reaches any distance"));
  }
  for (const std::string& extension : file.gltf.ignored) {
    file.warn(absl::StrCat("the extension ", extension, " is left out"));
  }
  for (const std::string& option : file.mtl.ignored) {
    file.warn(absl::StrCat("the option ", option, " of its textures is left out"));
  }
}

// Returns the kind of a model file by the suffix of its name.
ModelKind kind_of(const std::string& path) {
  const std::string lower = absl::AsciiStrToLower(path);
  const auto is = [&](absl::string_view suffix) { return absl::EndsWith(lower, suffix); };
  return is(".gltf") || is(".glb")                ? ModelKind::kGltf
         : is(".obj")                             ? ModelKind::kObj
         : is(".ply") || is(".stl") || is(".off") ? ModelKind::kPlain
                                                  : ModelKind::kOther;
}

// Returns the transform that turns the scene of an FBX file to +y up, +z front and +x right. The
// file's metadata name its axes. Returns the identity if they do not name valid axes. Assimp 5.2
// does not rotate the scene. Assimp 5.4 rotates and scales the scene in the root node. The result
// undoes the transform of the root node, so that all versions give the same scene.
Transform upright(const aiScene& scene) {
  struct Axis {
    const char* name;
    const char* sign;
  };
  constexpr Axis kAxes[] = {
      {"CoordAxis", "CoordAxisSign"}, {"UpAxis", "UpAxisSign"}, {"FrontAxis", "FrontAxisSign"}};
  Transform turned;
  turned.m = {};
  for (std::size_t row = 0; row < 3; ++row) {
    std::int32_t axis = -1;
    std::int32_t sign = 1;
    if (scene.mMetaData == nullptr || !scene.mMetaData->Get(kAxes[row].name, axis) || axis < 0 ||
        axis > 2) {
      return {};
    }
    scene.mMetaData->Get(kAxes[row].sign, sign);
    turned.m[row][static_cast<std::size_t>(axis)] = sign < 0 ? -1 : 1;
  }
  const std::optional<Transform> unturned =
      inverse(bandsaw::transform_of(scene.mRootNode->mTransformation));
  return determinant(turned) == 1 && unturned ? turned * *unturned : Transform{};
}

// Applies `by` to everything that is placed in the model's space.
void turn(const Transform& by, Model& model) {
  for (Frame& frame : model.frames) {
    if (frame.parent == kNoFrame) {
      frame.placement = by * frame.placement;
    }
  }
  for (auto* instances : {&model.instances, &model.filled}) {
    for (Instance& instance : *instances) {
      if (instance.frame == kNoFrame) {
        instance.to_world = by * instance.to_world;
      }
    }
  }
  for (DeltaLight& light : model.lights) {
    light = placed(light, by);
  }
  for (ModelCamera& camera : model.cameras) {
    camera.camera = placed(camera.camera, by);
    if (camera.at_close) {
      camera.at_close = placed(*camera.at_close, by);
    }
  }
}

// Returns the numbers of the materials that meshes use.
std::set<unsigned> used_materials(const aiScene& scene) {
  std::set<unsigned> used;
  for (unsigned i = 0; i < scene.mNumMeshes; ++i) {
    if (scene.mMeshes[i]->mMaterialIndex < scene.mNumMaterials) {
      used.insert(scene.mMeshes[i]->mMaterialIndex);
    }
  }
  return used;
}

// Returns the error `why` of reading a glTF file, with the file's name before the message.
absl::Status gltf_failure(const std::string& name, const absl::Status& why) {
  const bool is_broken = absl::IsInvalidArgument(why);
  return absl::Status(why.code(),
                      absl::StrCat(name, is_broken ? ": cannot be read: " : ": ", why.message()));
}

/// Returns the animation with its nodes keyed by their number in Assimp's tree instead of their
/// index in the file. `numbers` maps the index in the file to the number in Assimp's tree.
std::optional<Animation> renumbered(std::optional<Animation> animation,
                                    const std::map<std::size_t, std::size_t>& numbers) {
  if (!animation) {
    return animation;
  }
  Animation to{.name = std::move(animation->name)};
  for (const auto& [in_file, loaded] : numbers) {
    if (auto motion = animation->nodes.extract(in_file)) {
      to.nodes.emplace(loaded, std::move(motion.mapped()));
    }
    if (auto weights = animation->weights.extract(in_file)) {
      to.weights.emplace(loaded, std::move(weights.mapped()));
    }
  }
  return to;
}

/// Sets the chosen animation and the names of all animations. Returns NOT_FOUND if there is no such
/// animation.
absl::Status choose_animation(const AnimationChoice& choice, const std::string& name,
                              std::optional<gltf::PlainGltf>& plain, LoadedModel& model) {
  if (plain && !plain->is_first_version) {
    model.animation = renumbered(std::move(plain->animation), model.gltf.nodes);
    model.animation_names = std::move(plain->animation_names);
    return absl::OkStatus();
  }
  model.animation_names = animation_names(*model.scene);
  const auto chosen = choose(choice, model.animation_names);
  if (!chosen.ok()) {
    return absl::NotFoundError(absl::StrCat(name, ": ", chosen.status().message()));
  }
  if (*chosen) {
    model.animation = read_animation(*model.scene, **chosen);
  }
  return absl::OkStatus();
}

/// Deletes the file system object through which Assimp read. SetIOHandler(nullptr) would not delete
/// it in Assimp 5.2 (Assimp's pull request 5926), but setting another handler does in all versions.
void forget_files(Assimp::Importer& importer) {
  importer.SetIOHandler(std::make_unique<Assimp::DefaultIOSystem>().release());
}

/// Reads the file with the importer of `model`; returns nullptr on failure. Sets `refused` and
/// `mtl` of `model`. For glTF, Assimp reads only the plain copy (`plain`), whose buffer is
/// freed afterwards.
const aiScene* read_by_assimp(const ModelSource& source, const SceneFolder& folder,
                              std::optional<gltf::PlainGltf>& plain, LoadedModel& model) {
  Assimp::Importer& importer = model.importer;
  // Faces are triangulated; no other post-processing changes the geometry.
  constexpr unsigned kFlags = aiProcess_Triangulate;
  if (!plain || plain->is_first_version) {
    importer.SetIOHandler(
        std::make_unique<AssimpFiles>(folder, source, model.refused, model.mtl).release());
    const aiScene* scene = importer.ReadFile(source.path, kFlags);
    forget_files(importer);
    return scene;
  }
  const std::string json = plain->root.dump();
  importer.SetIOHandler(std::make_unique<PlainGltfFiles>(json, plain->buffer).release());
  const aiScene* scene = importer.ReadFile(PlainGltfFiles::kDocument, kFlags);
  forget_files(importer);
  plain->buffer = {};
  return scene;
}

/// Reads the file, without evaluating its animation.
absl::StatusOr<std::shared_ptr<LoadedModel>> load_model(const ModelSource& source,
                                                        const AnimationChoice& animation,
                                                        const SceneFolder& folder) {
  const std::string name = name_of(source.path);
  std::optional<gltf::PlainGltf> plain;
  if (kind_of(source.path) == ModelKind::kGltf) {
    auto read = gltf::read_plain_gltf(source.path, folder, animation);
    if (!read.ok()) {
      return gltf_failure(name, read.status());
    }
    plain = *std::move(read);
  }
  auto model = std::make_shared<LoadedModel>();
  // Assimp makes no placeholder meshes for the bones of files without meshes.
  model->importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
  model->scene = read_by_assimp(source, folder, plain, *model);
  if (model->scene == nullptr || model->scene->mRootNode == nullptr ||
      !model->refused.outside.empty()) {
    return read_failure(name, model->refused, model->importer.GetErrorString());
  }
  if (plain) {
    model->gltf = read_gltf_extensions(plain->root);
  }
  if (is_collada(source.path) && model->scene->mNumCameras > 0) {
    ASSIGN_OR_RETURN(const std::string text, read_whole_file(source.path, kMaxModelFileBytes));
    model->lenses = read_collada_lenses(text);
  }
  RETURN_IF_ERROR(choose_animation(animation, name, plain, *model));
  return model;
}

/// Returns the loaded file. The LoadedModel is kept in `draft.memory`, so that further frames do
/// not read it.
absl::StatusOr<std::shared_ptr<LoadedModel>> loaded_model(const ModelSource& source,
                                                          const AnimationChoice& animation,
                                                          SceneDraft& draft) {
  if (draft.memory == nullptr) {
    return load_model(source, animation, draft.folder);
  }
  std::shared_ptr<LoadedModel>& known = draft.memory->models[{source.path, animation}];
  if (known == nullptr) {
    ASSIGN_OR_RETURN(known, load_model(source, animation, draft.folder));
  }
  return known;
}

bool has_triangles(const ModelMeshes& meshes) {
  return std::any_of(meshes.begin(), meshes.end(),
                     [](const std::optional<ModelMesh>& mesh) { return mesh.has_value(); });
}

/// Loads a model and converts its materials, meshes and nodes. Implements read_model() and
/// read_made_model().
absl::StatusOr<Model> read_source(const ModelSource& source, const AnimationChoice& animation,
                                  bool with_materials, SceneDraft& draft) {
  const std::string& path = source.path;
  const std::string name = name_of(path);
  const std::size_t warnings_before = draft.out.info.warnings.size();
  ASSIGN_OR_RETURN(const std::shared_ptr<LoadedModel> model_file,
                   loaded_model(source, animation, draft));
  const aiScene* scene = model_file->scene;
  ModelFile file{*scene,
                 path,
                 kind_of(path),
                 model_file->gltf,
                 model_file->mtl,
                 model_file->lenses,
                 model_file->animation,
                 model_file->still_meshes,
                 draft};
  warn_of_missing(name, model_file->refused, draft);
  warn_of_unused(model_file->animation_names, file);

  std::vector<ModelMaterial> materials(scene->mNumMaterials);
  if (with_materials) {
    // Assimp adds a default material, and files contain unused materials. Only materials that a
    // mesh uses are read.
    for (const unsigned used : used_materials(*scene)) {
      ASSIGN_OR_RETURN(materials[used], read_model_material(file, used));
    }
    file.unsupported.add_warnings(name, draft.out.info.warnings);
  } else {
    // The scene's material may use both uv sets.
    std::fill(materials.begin(), materials.end(), ModelMaterial{.second_uv_set = 1});
  }
  ASSIGN_OR_RETURN(const ModelMeshes meshes, add_meshes(file, materials, with_materials));
  ASSIGN_OR_RETURN(Model model, read_nodes(file, meshes));
  // An animation may hide all meshes for a time, by a scale of 0.
  const bool may_be_empty = file.animation && has_triangles(meshes);
  if (model.instances.empty() && !may_be_empty) {
    const auto& warnings = draft.out.info.warnings;
    return absl::InvalidArgumentError(
        absl::StrCat(name, ": holds no triangle that can be rendered",
                     warnings.size() > warnings_before ? "; " + warnings.back() : ""));
  }
  fill_glass(materials, file, model);
  turn(upright(*scene), model);
  return model;
}

}  // namespace

Camera placed(Camera camera, const Transform& placement) {
  if (auto* flat = std::get_if<OrthographicCamera>(&camera)) {
    flat->height *= length(placement.direction(flat->up)) / length(flat->up);
  }
  std::visit(
      [&](auto& c) {
        c.position = placement.point(c.position);
        c.look_at = placement.point(c.look_at);
        c.up = placement.direction(c.up);
      },
      camera);
  return camera;
}

bool is_model_file(const std::string& path) {
  const std::size_t dot = path.rfind('.');
  if (dot == std::string::npos || path.find('/', dot) != std::string::npos) {
    return false;
  }
  return Assimp::Importer().IsExtensionSupported(absl::AsciiStrToLower(path.substr(dot)));
}

absl::StatusOr<Model> read_model(const std::string& path, bool with_materials, SceneDraft& draft,
                                 const AnimationChoice& animation) {
  return read_source({path, std::nullopt}, animation, with_materials, draft);
}

absl::StatusOr<Model> read_made_model(const std::string& name, absl::string_view bytes,
                                      bool with_materials, SceneDraft& draft) {
  return read_source({absl::StrCat(draft.folder.path(), "/", name), bytes}, {}, with_materials,
                     draft);
}

}  // namespace bandsaw
