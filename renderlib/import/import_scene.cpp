// Imports one file as a scene. A scene file is parsed to the message of proto/scene.proto, and a
// foreign scene (of pbrt or Mitsuba) is converted to this message. read_scene() reads the message
// into a SceneDraft (draft/scene_draft.h). A single model is read without a scene file
// (read_model_alone).

#include <algorithm>
#include <filesystem>
#include <utility>
#include <variant>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "proto/wire/limits.h"
#include "renderlib/base/file.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/convert/scene_text.h"
#include "renderlib/import/draft/environment_image.h"
#include "renderlib/import/draft/scene_draft.h"
#include "renderlib/import/import.h"
#include "renderlib/import/mitsuba/convert_mitsuba.h"
#include "renderlib/import/model/framing.h"
#include "renderlib/import/model/model.h"
#include "renderlib/import/pbrt/convert_pbrt.h"
#include "renderlib/import/scene_file/parse_scene.h"
#include "renderlib/import/scene_file/read_groups.h"
#include "renderlib/import/scene_file/read_lights.h"
#include "renderlib/import/scene_file/read_materials.h"
#include "renderlib/import/scene_file/read_media.h"
#include "renderlib/import/scene_file/read_models.h"
#include "renderlib/import/scene_file/read_shapes.h"
#include "renderlib/import/scene_file/read_textures.h"
#include "renderlib/import/scene_file/read_view.h"
#include "renderlib/import/scene_file/tracks.h"
#include "renderlib/import/scene_file/use_camera.h"
#include "renderlib/scene/validate.h"

namespace bandsaw {
namespace {

constexpr std::uint64_t kMaxSceneFileBytes = std::uint64_t{64} << 20;

/// Returns true if the scene has a light source of its own. A MetallicRoughness material that emits
/// does not count, because most models with glowing parts need a sky as well.
bool has_light(const SceneDescription& scene) {
  const std::vector<Medium>& media = scene.media.media;
  return !scene.lights.empty() || std::any_of(media.begin(), media.end(), [](const Medium& medium) {
    return !is_black(medium.emission);
  }) || std::any_of(scene.materials.begin(), scene.materials.end(), [](const Material& material) {
    return std::holds_alternative<Emissive>(material.kind) ||
           (!is_black(material.emission.radiance.factor) &&
            !std::holds_alternative<MetallicRoughness>(material.kind));
  });
}

/// Returns a camera that sees all placed meshes, for the scene's image size.
Camera framed(const ImportedScene& out, const Shutter& shutter) {
  const Geometry& geometry = out.scene.geometry;
  Camera camera =
      frame(geometry, geometry.instances, static_cast<double>(out.info.width) / out.info.height);
  std::visit([&](auto& of_kind) { of_kind.shutter = shutter; }, camera);
  return camera;
}

/// Returns the camera for a scene file without a camera of its own. The first of these that exists
/// is returned: the model's camera that the file names, the first camera of a model, and a camera
/// that frames the only model. If an animation hides the only model, returns the default camera.
/// Returns an error if none of these cameras exists.
absl::StatusOr<MovingCamera> camera_of_a_model(const Field& root, const scene::Scene& from,
                                               const SceneDraft& draft) {
  if (from.has_camera()) {
    return use_camera(root, from, draft);
  }
  if (!draft.cameras.empty()) {
    return with_shutter(draft.cameras.front(), draft.shutter);
  }
  const bool is_empty = draft.out.scene.geometry.instances.empty();
  if (from.model_size() != 1 || (is_empty && from.model(0).boundary_only())) {
    return root.error("camera",
                      "is required, for example camera { position: [0, 1, 5] look_at: [0, 0, 0] }");
  }
  return MovingCamera{framed(draft.out, draft.shutter)};
}

void set_camera(MovingCamera camera, SceneDescription& scene) {
  scene.camera = std::move(camera.at_open);
  scene.camera_at_close = std::move(camera.at_close);
}

/// Reads a scene at one time. Its tracks, which change numbers of the scene file over time, have
/// been evaluated in `from`.
absl::Status read_scene(const Field& root, const scene::Scene& from, SceneDraft& draft) {
  SceneDescription& scene = draft.out.scene;
  RETURN_IF_ERROR(read_settings(root, from, draft.out.info));
  // Cheap checks come before slow ones.
  const bool own_camera = from.has_camera() && from.camera().use().empty();
  if (own_camera) {
    ASSIGN_OR_RETURN(scene.camera, read_camera(root, from, draft.shutter));
  }
  ASSIGN_OR_RETURN(scene.filter, read_filter(root, from));
  ASSIGN_OR_RETURN(scene.local_shading, read_local_shading(root, from));
  if (from.has_background()) {
    ASSIGN_OR_RETURN(scene.background, read_background(root, from, draft));
  }
  RETURN_IF_ERROR(read_textures(root, from, draft));
  RETURN_IF_ERROR(read_materials(root, from, draft));
  RETURN_IF_ERROR(read_media(root, from, draft));
  RETURN_IF_ERROR(read_groups(root, from, draft));
  RETURN_IF_ERROR(read_shapes(root, from.shape(), draft));
  RETURN_IF_ERROR(read_lights(root, from, draft));
  RETURN_IF_ERROR(read_models(root, from.model(), draft));
  RETURN_IF_ERROR(read_instances(root, from.instance(), draft));
  // `seen` are the visible instances, `filled` the closed shapes that media fill.
  scene.geometry.frames = std::move(draft.world.seen.frames);
  scene.geometry.instances = std::move(draft.world.seen.instances);
  scene.media.boundaries.frames = std::move(draft.world.filled.frames);
  scene.media.boundaries.instances = std::move(draft.world.filled.instances);
  if (!own_camera) {
    ASSIGN_OR_RETURN(MovingCamera camera, camera_of_a_model(root, from, draft));
    set_camera(std::move(camera), scene);
  }
  if (!from.has_background() && !has_light(scene)) {
    scene.background = default_sky();
  }
  return absl::OkStatus();
}

/// Returns the shutter interval in seconds of the scene's time; it begins at the frame's time, or
/// at 0 without a frame.
absl::StatusOr<Shutter> shutter_of_frame(const Field& root, const scene::Scene& from,
                                         const std::optional<FrameChoice>& frame) {
  ASSIGN_OR_RETURN(const double own_fps, read_fps(root, from));
  if (!frame) {
    return read_shutter(root, from, 0);
  }
  const double fps = frame->fps.value_or(own_fps);
  const double time = frame->number / fps;
  return frame->shutter ? Shutter{time, time + *frame->shutter / fps}
                        : read_shutter(root, from, time);
}

/// Reads a scene file at a frame. The tracks of objects are evaluated in the middle of the
/// exposure. The tracks of the camera are evaluated at its beginning and end, so that the camera
/// moves. `written` is the scene before its tracks are evaluated. `locations` may be nullptr.
absl::Status read_frame(const scene::Scene& written,
                        const google::protobuf::TextFormat::ParseInfoTree* locations,
                        const ImportChoices& choices, SceneDraft& draft) {
  const Field root(draft.file, written, locations);
  ASSIGN_OR_RETURN(draft.shutter, shutter_of_frame(root, written, choices.frame));
  draft.animation = {choices.animation, choices.frame.has_value()};
  if (written.track_size() == 0) {
    return read_scene(root, written, draft);
  }
  ASSIGN_OR_RETURN(const scene::Scene now, scene_at(root, written, middle_of(draft.shutter)));
  RETURN_IF_ERROR(read_scene(Field(draft.file, now, locations), now, draft));
  if (!moves_camera(written) || !written.camera().use().empty() ||
      draft.shutter.open == draft.shutter.close) {
    return absl::OkStatus();
  }
  ASSIGN_OR_RETURN(const scene::Scene open, scene_at(root, written, draft.shutter.open));
  ASSIGN_OR_RETURN(const scene::Scene close, scene_at(root, written, draft.shutter.close));
  MovingCamera camera;
  ASSIGN_OR_RETURN(camera.at_open,
                   read_camera(Field(draft.file, open, locations), open, draft.shutter));
  ASSIGN_OR_RETURN(camera.at_close,
                   read_camera(Field(draft.file, close, locations), close, draft.shutter));
  set_camera(std::move(camera), draft.out.scene);
  return absl::OkStatus();
}

/// Reads a scene file of Bandsaw, which is JSON if `json` is true, otherwise protobuf text format.
absl::Status read_scene_file(const std::string& path, bool json, const ImportChoices& choices,
                             SceneDraft& draft) {
  ASSIGN_OR_RETURN(const std::string text, read_whole_file(path, kMaxSceneFileBytes));
  auto parsed = json ? parse_json(text, draft.file) : parse_textproto(text, draft.file);
  if (!parsed.ok()) {
    return parsed.status();
  }
  return read_frame(parsed->scene, parsed->locations.get(), choices, draft);
}

/// Returns the gradient of a sky as the message of a scene file.
scene::Background as_proto(const Background& sky) {
  scene::Background out;
  const auto set = [](const Rgb& color, scene::Color* to) {
    for (const float channel : {color.r, color.g, color.b}) {
      to->add_rgb(channel);
    }
  };
  set(sky.bottom, out.mutable_gradient()->mutable_bottom());
  set(sky.top, out.mutable_gradient()->mutable_top());
  return out;
}

/// Returns a scene file that renders to the same image as the model in `draft`, which
/// read_model_alone() has read.
scene::Scene scene_of_model(const SceneDraft& draft) {
  scene::Scene scene;
  scene.add_model()->set_file(draft.file);
  if (!draft.cameras.empty()) {
    scene.mutable_camera()->set_use(
        absl::StrCat(draft.cameras.front().model, "/", draft.cameras.front().name));
  } else {
    const auto& camera = std::get<PerspectiveCamera>(draft.out.scene.camera);
    const auto set = [](const Vec3& v, google::protobuf::RepeatedField<double>* to) {
      to->Add(v.x);
      to->Add(v.y);
      to->Add(v.z);
    };
    set(camera.position, scene.mutable_camera()->mutable_position());
    set(camera.look_at, scene.mutable_camera()->mutable_look_at());
    scene.mutable_camera()->set_vertical_fov(camera.vertical_fov);
  }
  if (!has_light(draft.out.scene)) {
    *scene.mutable_background() = as_proto(default_sky());
  }
  return scene;
}

bool is_pbrt(const std::string& lower) {
  return absl::EndsWith(lower, ".pbrt") || absl::EndsWith(lower, ".pbrt.gz");
}

bool is_mitsuba(const std::string& lower) { return absl::EndsWith(lower, ".xml"); }

bool is_foreign(const std::string& path) {
  const std::string lower = absl::AsciiStrToLower(path);
  return is_pbrt(lower) || is_mitsuba(lower);
}

/// Converts a foreign scene to the message of a scene file. Further frames get the result of the
/// first, which is kept in `draft.memory`.
absl::StatusOr<std::shared_ptr<const ConvertedScene>> convert(const std::string& path,
                                                              const ImportChoices& choices,
                                                              const SceneDraft& draft) {
  if (draft.memory != nullptr && draft.memory->converted != nullptr) {
    return draft.memory->converted;
  }
  const std::string own_folder = std::filesystem::canonical(path).parent_path().string();
  ASSIGN_OR_RETURN(std::string real, draft.folder.resolve(name_of(path), own_folder));
  const ForeignScene from{std::move(real), draft.file, draft.folder, choices.parameters};
  auto converted =
      is_pbrt(absl::AsciiStrToLower(path)) ? convert_pbrt(from) : convert_mitsuba(from);
  RETURN_IF_ERROR(converted.status());
  auto shared = std::make_shared<const ConvertedScene>(*std::move(converted));
  if (draft.memory != nullptr) {
    draft.memory->converted = shared;
  }
  return shared;
}

/// Reads what a converter returned. Its warnings come before those of the reader.
absl::Status read_converted(const std::shared_ptr<const ConvertedScene>& converted,
                            const ImportChoices& choices, SceneDraft& draft) {
  draft.made_files = {converted, &converted->made_files};
  draft.out.info.warnings = converted->warnings;
  return read_frame(converted->scene, nullptr, choices, draft);
}

/// Returns the model's first camera, or one that frames the model if it has no camera. The framing
/// camera does not move in a sequence: it frames an animated model in its pose at time 0, or in its
/// rest pose if the animation hides the model at time 0.
absl::StatusOr<MovingCamera> camera_for_model(const std::string& real,
                                              const AnimationChoice& animation,
                                              const SceneDraft& draft) {
  if (!draft.cameras.empty()) {
    return with_shutter(draft.cameras.front(), draft.shutter);
  }
  if (draft.shutter == Shutter{} && !draft.out.scene.geometry.instances.empty()) {
    return MovingCamera{framed(draft.out, draft.shutter)};
  }
  // The shutter of a new draft opens and closes at time 0, so the model is read in its pose at 0.
  SceneDraft at_zero(draft.folder, draft.file, draft.memory);
  ASSIGN_OR_RETURN(Model model, read_model(real, /*with_materials=*/false, at_zero, animation));
  if (model.instances.empty()) {
    // If the rest pose hides the model too, read_model() returns an error. An empty model then
    // makes framed() return the default camera.
    model = read_model(real, /*with_materials=*/false, at_zero).value_or(Model{});
  }
  at_zero.out.scene.geometry.instances = model.instances;
  return MovingCamera{framed(at_zero.out, draft.shutter)};
}

/// Reads a single model as a scene, with a camera and a light source of its own or default ones.
absl::Status read_model_alone(const std::string& path, const ImportChoices& choices,
                              SceneDraft& draft) {
  ASSIGN_OR_RETURN(const auto real, draft.folder.resolve(name_of(path), draft.folder.path()));
  const scene::Scene defaults;
  const Field root(draft.file, defaults, nullptr);
  ASSIGN_OR_RETURN(draft.shutter, shutter_of_frame(root, defaults, choices.frame));
  const AnimationChoice animation{choices.animation, choices.frame.has_value()};
  ASSIGN_OR_RETURN(const Model model, read_model(real, /*with_materials=*/true, draft, animation));
  draft.out.scene.geometry.frames = model.frames;
  draft.out.scene.geometry.instances = model.instances;
  draft.out.scene.media.boundaries.frames = model.frames;
  draft.out.scene.media.boundaries.instances = model.filled;
  draft.out.scene.lights = model.lights;
  add_cameras(draft.file, model, Transform{}, Transform{}, draft);
  ASSIGN_OR_RETURN(MovingCamera camera, camera_for_model(real, animation, draft));
  set_camera(std::move(camera), draft.out.scene);
  if (!has_light(draft.out.scene)) {
    draft.out.scene.background = default_sky();
  }
  return absl::OkStatus();
}

/// Reads a file of any kind; its suffix tells the kind.
absl::Status read_any(const std::string& path, const ImportChoices& choices, SceneDraft& draft) {
  if (is_foreign(path)) {
    ASSIGN_OR_RETURN(const auto converted, convert(path, choices, draft));
    return read_converted(converted, choices, draft);
  }
  const std::string lower = absl::AsciiStrToLower(path);
  if (absl::EndsWith(lower, ".textproto") || absl::EndsWith(lower, ".json")) {
    return read_scene_file(path, absl::EndsWith(lower, ".json"), choices, draft);
  }
  if (is_model_file(path)) {
    return read_model_alone(path, choices, draft);
  }
  return absl::InvalidArgumentError(absl::StrCat(
      draft.file,
      ": is of a kind that is not read; a scene is .textproto or .json, .pbrt or Mitsuba's .xml, a "
      "model .gltf, .glb, .obj, .fbx, .dae, .3ds, .ply, .stl or another format of Assimp"));
}

/// Runs the checks that need the whole scene. With `strict`, the first warning becomes an error.
absl::Status check_whole(const ImportChoices& choices, const SceneDraft& draft) {
  const std::vector<std::string>& warnings = draft.out.info.warnings;
  if (choices.strict && !warnings.empty()) {
    const std::string others =
        warnings.size() == 1
            ? ""
            : absl::StrCat("; ", warnings.size() - 1, " more, which are warnings without --strict");
    return absl::InvalidArgumentError(absl::StrCat(warnings.front(), others));
  }
  // The meshes of the last frame's package have been checked with that frame.
  const auto is_checked = [&](const Mesh& mesh) {
    return draft.memory != nullptr && draft.memory->encoded.knows(mesh);
  };
  // A scene that a worker would refuse is refused here, before anybody waits for it.
  if (const absl::Status valid = validate(draft.out.scene, MeshVertices::kFinite, is_checked);
      !valid.ok()) {
    return absl::InvalidArgumentError(absl::StrCat(draft.file, ": ", valid.message()));
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<SceneFolder> folder_to_read(const std::string& path, const ImportChoices& choices) {
  if (choices.folder.empty()) {
    return SceneFolder::of(path);
  }
  if (!is_mitsuba(absl::AsciiStrToLower(path))) {
    return absl::InvalidArgumentError(
        absl::StrCat(name_of(path),
                     ": --folder is for scenes of Mitsuba; scenes of other kinds name no "
                     "files outside of their own folder"));
  }
  return SceneFolder::around(path, choices.folder);
}

absl::StatusOr<ImportedScene> import_scene(const std::string& path, const ImportChoices& choices,
                                           ImportMemory* memory) {
  ASSIGN_OR_RETURN(SceneFolder folder, folder_to_read(path, choices));
  SceneDraft draft(std::move(folder), name_of(path), memory);
  draft.out.info.name = std::filesystem::path(path).stem().string();
  RETURN_IF_ERROR(read_any(path, choices, draft));
  draft.out.info.model_cameras = names_of(draft.cameras);
  if (!choices.camera.empty()) {
    ASSIGN_OR_RETURN(MovingCamera camera, chosen_camera(choices.camera, draft));
    set_camera(std::move(camera), draft.out.scene);
  }
  if (const auto& given = choices.environment) {
    ASSIGN_OR_RETURN(const TextureId image,
                     add_environment_image(given->bytes, given->name, draft));
    draft.out.scene.background = {};
    draft.out.scene.background.environment = Environment{.images = {image}};
  }
  RETURN_IF_ERROR(check_whole(choices, draft));
  if (memory != nullptr) {
    memory->images.end_round();
  }
  return std::move(draft.out);
}

absl::StatusOr<SceneAsText> scene_as_text(const std::string& path, const ImportChoices& choices) {
  ASSIGN_OR_RETURN(SceneFolder folder, folder_to_read(path, choices));
  SceneDraft draft(std::move(folder), name_of(path));
  SceneAsText out;
  scene::Scene scene;
  if (is_foreign(path)) {
    ASSIGN_OR_RETURN(const auto converted, convert(path, choices, draft));
    scene = converted->scene;
    draft.folder.record_to(&out.found_files);
    RETURN_IF_ERROR(read_converted(converted, choices, draft));
  } else if (is_model_file(path)) {
    draft.folder.record_to(&out.found_files);
    RETURN_IF_ERROR(read_model_alone(path, choices, draft));
    scene = scene_of_model(draft);
  } else {
    return absl::InvalidArgumentError(absl::StrCat(
        draft.file, ": only scenes of pbrt and Mitsuba and models are converted to a scene file"));
  }
  RETURN_IF_ERROR(check_whole(choices, draft));
  out.text = text_of(scene, draft.file, draft.out.info.warnings);
  out.made_files = *draft.made_files;
  out.warnings = std::move(draft.out.info.warnings);
  return out;
}

}  // namespace bandsaw
