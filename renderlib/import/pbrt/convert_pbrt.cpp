// Converts a pbrt scene to a Bandsaw scene file. Interpreter reads one directive after the other
// and calls the function of the directive. Such a function changes the graphics state (what the
// following shapes get: transformation, material, media), or adds a material, shape, light or
// medium to the scene (builder.h).

#include "renderlib/import/pbrt/convert_pbrt.h"

#include <algorithm>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/pbrt/builder.h"
#include "renderlib/import/pbrt/graphics_state.h"
#include "renderlib/import/pbrt/motion.h"
#include "renderlib/import/pbrt/open_media.h"
#include "renderlib/import/pbrt/read_arguments.h"
#include "renderlib/import/pbrt/tokens.h"
#include "renderlib/import/pbrt/view.h"

namespace bandsaw {
namespace pbrt {
namespace {

/// Executes the directives of a scene.
class Interpreter {
 public:
  explicit Interpreter(const ForeignScene& from) : builder_(from), tokens_(from.folder) {
    auto surface = std::make_shared<Surface>();
    surface->label = "default";
    set_rgb({0.5, 0.5, 0.5}, surface->material.mutable_diffuse()->mutable_color());
    state().surface = std::move(surface);
  }

  /// Executes all directives of the scene's file and returns the converted scene.
  absl::StatusOr<ConvertedScene> run() {
    RETURN_IF_ERROR(tokens_.include(builder_.from.name, {builder_.from.name, 0}));
    while (true) {
      ASSIGN_OR_RETURN(std::optional<Token> token, tokens_.next());
      end_imports();
      if (!token) {
        break;
      }
      if (token->kind != Token::Kind::kWord) {
        return error_at(token->place, absl::StrCat("a directive is expected, not \"",
                                                   token->text.substr(0, 80), "\""));
      }
      RETURN_IF_ERROR(execute(*token));
    }
    return finish();
  }

 private:
  State& state() { return graphics_.current(); }

  using Action = absl::Status (Interpreter::*)(const Place&);

  /// Executes the directive whose name is `token`.
  absl::Status execute(const Token& token) {
    static constexpr std::pair<const char*, Action> kActions[] = {
        {"Shape", &Interpreter::shape},
        {"AttributeBegin", &Interpreter::attribute_begin},
        {"AttributeEnd", &Interpreter::attribute_end},
        {"TransformBegin", &Interpreter::attribute_begin},
        {"TransformEnd", &Interpreter::transform_end},
        {"Attribute", &Interpreter::attribute},
        {"Transform", &Interpreter::transform},
        {"ConcatTransform", &Interpreter::concatenate<read_matrix>},
        {"Translate", &Interpreter::concatenate<read_translation>},
        {"Scale", &Interpreter::concatenate<read_scaling>},
        {"Rotate", &Interpreter::concatenate<read_rotation>},
        {"LookAt", &Interpreter::concatenate<read_look_at>},
        {"Identity", &Interpreter::identity},
        {"CoordinateSystem", &Interpreter::coordinate_system},
        {"CoordSysTransform", &Interpreter::coord_sys_transform},
        {"ActiveTransform", &Interpreter::active_transform},
        {"TransformTimes", &Interpreter::transform_times},
        {"ReverseOrientation", &Interpreter::reverse_orientation},
        {"Material", &Interpreter::material},
        {"MakeNamedMaterial", &Interpreter::make_named_material},
        {"NamedMaterial", &Interpreter::named_material},
        {"Texture", &Interpreter::texture},
        {"MakeNamedMedium", &Interpreter::make_named_medium},
        {"MediumInterface", &Interpreter::medium_interface},
        {"AreaLightSource", &Interpreter::area_light_source},
        {"LightSource", &Interpreter::light_source},
        {"ObjectBegin", &Interpreter::object_begin},
        {"ObjectEnd", &Interpreter::object_end},
        {"ObjectInstance", &Interpreter::object_instance},
        {"WorldBegin", &Interpreter::world_begin},
        {"WorldEnd", &Interpreter::nothing},
        {"Camera", &Interpreter::camera},
        {"Film", &Interpreter::film},
        {"PixelFilter", &Interpreter::pixel_filter},
        {"Integrator", &Interpreter::integrator},
        {"Sampler", &Interpreter::without_effect},
        {"Accelerator", &Interpreter::without_effect},
        {"ColorSpace", &Interpreter::color_space},
        {"Option", &Interpreter::option},
        {"Include", &Interpreter::include},
        {"Import", &Interpreter::import}};
    for (const auto& [name, action] : kActions) {
      if (token.text == name) {
        return (this->*action)(token.place);
      }
    }
    return error_at(token.place,
                    absl::StrCat("\"", token.text.substr(0, 80), "\" is no directive of pbrt-v4"));
  }

  // Arguments of directives.

  /// Reads "type" and parameters, with the defaults that Attribute set for `target`.
  absl::StatusOr<std::pair<std::string, Parameters>> typed(const Place& place,
                                                           const std::string& target) {
    ASSIGN_OR_RETURN(std::string type, read_quoted(tokens_, place, "a type"));
    ASSIGN_OR_RETURN(Parameters parameters, read_parameters(tokens_, place));
    graphics_.apply_defaults(target, parameters);
    return std::pair(std::move(type), std::move(parameters));
  }

  // Transformations.

  absl::Status transform(const Place& place) {
    ASSIGN_OR_RETURN(const Transform to, read_matrix(tokens_, place));
    return graphics_.set(place, to);
  }

  template <absl::StatusOr<Transform> (*Read)(Tokens&, const Place&)>
  absl::Status concatenate(const Place& place) {
    ASSIGN_OR_RETURN(const Transform by, Read(tokens_, place));
    return graphics_.concatenate(place, by);
  }

  absl::Status identity(const Place& place) { return graphics_.set(place, Transform{}); }

  absl::Status coordinate_system(const Place& place) {
    ASSIGN_OR_RETURN(const std::string name, read_quoted(tokens_, place, "a name"));
    graphics_.define_system(name, state().transforms);
    return absl::OkStatus();
  }

  absl::Status coord_sys_transform(const Place& place) {
    ASSIGN_OR_RETURN(const std::string name, read_quoted(tokens_, place, "a name"));
    if (!graphics_.use_system(name)) {
      builder_.warn(place, absl::StrCat("no coordinate system is called \"", name, "\""));
    }
    return absl::OkStatus();
  }

  absl::Status active_transform(const Place& place) {
    ASSIGN_OR_RETURN(std::optional<Token> token, tokens_.next());
    const std::string which = token ? token->text : "";
    if (which != "StartTime" && which != "EndTime" && which != "All") {
      return error_at(place, "ActiveTransform is followed by StartTime, EndTime or All");
    }
    state().is_active[0] = which != "EndTime";
    state().is_active[1] = which != "StartTime";
    return absl::OkStatus();
  }

  absl::Status transform_times(const Place& place) {
    ASSIGN_OR_RETURN(const auto n, read_numbers(tokens_, place, 2));
    if (!(n[0] < n[1] && std::abs(n[0]) <= 1e9 && std::abs(n[1]) <= 1e9)) {
      return error_at(place, "TransformTimes needs two times, the first before the second");
    }
    builder_.start_time = n[0];
    builder_.end_time = n[1];
    return absl::OkStatus();
  }

  // The graphics state.

  absl::Status attribute_begin(const Place& place) { return graphics_.save(place); }
  absl::Status attribute_end(const Place& place) { return graphics_.restore(place); }
  absl::Status transform_end(const Place& place) { return graphics_.restore_transforms(place); }

  absl::Status attribute(const Place& place) {
    ASSIGN_OR_RETURN(const std::string target, read_quoted(tokens_, place, "a target"));
    ASSIGN_OR_RETURN(Parameters parameters, read_parameters(tokens_, place));
    if (target != "shape" && target != "light" && target != "material" && target != "medium" &&
        target != "texture") {
      return error_at(place, absl::StrCat("Attribute is for shape, light, material, medium or "
                                          "texture, not \"",
                                          target, "\""));
    }
    return graphics_.add_defaults(place, target, std::move(parameters));
  }

  absl::Status reverse_orientation(const Place&) {
    state().reverse_orientation = !state().reverse_orientation;
    return absl::OkStatus();
  }

  absl::Status color_space(const Place& place) {
    ASSIGN_OR_RETURN(const std::string name, read_quoted(tokens_, place, "a name"));
    if (name != "srgb" && name != "rec2020" && name != "dci-p3" && name != "aces2065-1") {
      return error_at(place, absl::StrCat("the colour space \"", name, "\" is not known"));
    }
    state().color_space = name;
    return absl::OkStatus();
  }

  absl::Status option(const Place& place) {
    ASSIGN_OR_RETURN(const Parameters parameters, read_parameters(tokens_, place));
    for (const Parameter& parameter : parameters.list) {
      if (parameter.name == "forcediffuse" || parameter.name == "disabletexturefiltering" ||
          parameter.name == "msereferenceimage") {
        builder_.warn(parameter.place,
                      absl::StrCat("the option \"", parameter.name, "\" is left out"));
      }
    }
    return absl::OkStatus();
  }

  /// Reads a directive that changes nothing in Bandsaw's image.
  absl::Status without_effect(const Place& place) { return typed(place, "").status(); }
  absl::Status nothing(const Place&) { return absl::OkStatus(); }

  absl::Status include(const Place& place) {
    ASSIGN_OR_RETURN(const std::string name, read_quoted(tokens_, place, "a file"));
    return tokens_.include(name, place);
  }

  /// Includes a file. The changes that the file makes to the graphics state end with the file.
  absl::Status import(const Place& place) {
    ASSIGN_OR_RETURN(const std::string name, read_quoted(tokens_, place, "a file"));
    RETURN_IF_ERROR(tokens_.include(name, place));
    graphics_.begin_import();
    imports_.push_back({name, tokens_.depth()});
    return absl::OkStatus();
  }

  /// Restores the graphics state for each imported file that ended before the token read last.
  void end_imports() {
    while (!imports_.empty() && tokens_.depth() < imports_.back().depth) {
      warn_of_missing_ends(imports_.back().name);
      graphics_.end_import();
      imports_.pop_back();
    }
  }

  /// Warns of states that the file `name` has saved and not restored.
  void warn_of_missing_ends(const std::string& name) {
    if (graphics_.depth() > 0) {
      builder_.warnings.push_back(
          absl::StrCat(name, ": ", graphics_.depth(),
                       graphics_.depth() == 1 ? " AttributeEnd is" : " AttributeEnd are",
                       " missing at the end"));
    }
  }

  // Materials, textures, media.

  absl::Status material(const Place& place) {
    ASSIGN_OR_RETURN(const auto read, typed(place, "material"));
    ASSIGN_OR_RETURN(state().surface,
                     make_surface(read.first, read.first, read.second, state(), builder_));
    return absl::OkStatus();
  }

  absl::Status make_named_material(const Place& place) {
    ASSIGN_OR_RETURN(const auto read, typed(place, "material"));
    const std::string& name = read.first;
    ASSIGN_OR_RETURN(const std::string type, read.second.text("type", ""));
    if (type.empty()) {
      return error_at(place, "MakeNamedMaterial needs \"string type\"");
    }
    ASSIGN_OR_RETURN(auto surface, make_surface(type, name, read.second, state(), builder_));
    if (!builder_.materials.emplace(name, std::move(surface)).second) {
      return error_at(place, absl::StrCat("a material called \"", name, "\" exists"));
    }
    return absl::OkStatus();
  }

  absl::Status named_material(const Place& place) {
    ASSIGN_OR_RETURN(const std::string name, read_quoted(tokens_, place, "a name"));
    const auto found = builder_.materials.find(name);
    if (found == builder_.materials.end()) {
      return error_at(place, absl::StrCat("no material is called \"", name, "\""));
    }
    state().surface = found->second;
    return absl::OkStatus();
  }

  absl::Status texture(const Place& place) {
    ASSIGN_OR_RETURN(const std::string name, read_quoted(tokens_, place, "a name"));
    ASSIGN_OR_RETURN(const std::string type, read_quoted(tokens_, place, "a type"));
    ASSIGN_OR_RETURN(auto read, typed(place, "texture"));
    return add_texture(name, type, read.first, std::move(read.second), state(), builder_);
  }

  absl::Status make_named_medium(const Place& place) {
    ASSIGN_OR_RETURN(auto read, typed(place, "medium"));
    ASSIGN_OR_RETURN(const std::string type, read.second.text("type", ""));
    if (read.first.empty() || type.empty()) {
      return error_at(place, "MakeNamedMedium needs a name and \"string type\"");
    }
    // A second medium of the same name replaces the first, because old scenes need it. pbrt-v4
    // refuses the second medium.
    builder_.media[read.first] = {type, std::move(read.second), state().color_space,
                                  state().transforms[0]};
    return absl::OkStatus();
  }

  absl::Status medium_interface(const Place& place) {
    ASSIGN_OR_RETURN(state().inside, read_quoted(tokens_, place, "a medium"));
    ASSIGN_OR_RETURN(std::optional<Token> token, tokens_.next());
    state().outside = state().inside;
    if (token && token->kind == Token::Kind::kString) {
      state().outside = std::move(token->text);
    } else if (token) {
      tokens_.put_back(*std::move(token));
    }
    return absl::OkStatus();
  }

  // Shapes and lights.

  absl::Status shape(const Place& place) {
    ASSIGN_OR_RETURN(const auto read, typed(place, "shape"));
    RETURN_IF_ERROR(in_world(place, "Shape"));
    return add_shape(read.first, read.second, state(), builder_);
  }

  absl::Status area_light_source(const Place& place) {
    ASSIGN_OR_RETURN(auto read, typed(place, "light"));
    if (read.first != "diffuse") {
      return error_at(place, absl::StrCat("the area light \"", read.first, "\" is not known"));
    }
    read.second.ignore({"L", "scale", "power", "twosided", "filename"});
    builder_.warn_of_unused(read.second);
    state().area_light = std::make_shared<const AreaLight>(AreaLight{std::move(read.second)});
    return absl::OkStatus();
  }

  absl::Status light_source(const Place& place) {
    ASSIGN_OR_RETURN(const auto read, typed(place, "light"));
    RETURN_IF_ERROR(in_world(place, "LightSource"));
    return add_light(read.first, read.second, state(), builder_);
  }

  absl::Status object_begin(const Place& place) {
    ASSIGN_OR_RETURN(const std::string name, read_quoted(tokens_, place, "a name"));
    RETURN_IF_ERROR(in_world(place, "ObjectBegin"));
    if (builder_.group != nullptr) {
      return error_at(place, "ObjectBegin within ObjectBegin");
    }
    if (!objects_.emplace(name, 0).second) {
      return error_at(place, absl::StrCat("an object called \"", name, "\" exists"));
    }
    RETURN_IF_ERROR(attribute_begin(place));
    builder_.group = builder_.out.add_group();
    builder_.group->set_name(absl::StrCat("object ", name));
    object_ = name;
    return absl::OkStatus();
  }

  absl::Status object_end(const Place& place) {
    if (builder_.group == nullptr) {
      return error_at(place, "ObjectEnd without ObjectBegin");
    }
    const scene::Group& group = *builder_.group;
    objects_[object_] = group.shape_size() + group.model_size() + group.instance_size();
    if (objects_[object_] == 0) {
      builder_.out.mutable_group()->RemoveLast();
    }
    builder_.group = nullptr;
    return attribute_end(place);
  }

  absl::Status object_instance(const Place& place) {
    ASSIGN_OR_RETURN(const std::string name, read_quoted(tokens_, place, "a name"));
    RETURN_IF_ERROR(in_world(place, "ObjectInstance"));
    const auto found = objects_.find(name);
    if (found == objects_.end() || builder_.group != nullptr) {
      return error_at(place, builder_.group != nullptr
                                 ? "ObjectInstance within ObjectBegin"
                                 : absl::StrCat("no object is called \"", name, "\""));
    }
    if (found->second == 0) {
      return absl::OkStatus();
    }
    if (!inverse(state().transforms[0])) {
      return error_at(place, "the transformation of the object is singular");
    }
    scene::Instance instance;
    instance.set_of(absl::StrCat("object ", name));
    add_placed(place, state().transforms, std::move(instance), builder_);
    return absl::OkStatus();
  }

  /// Returns an error if the directive `what` stands before WorldBegin.
  absl::Status in_world(const Place& place, absl::string_view what) const {
    return is_in_world_ ? absl::OkStatus()
                        : error_at(place, absl::StrCat(what, " must come after WorldBegin"));
  }

  // The image.

  absl::Status camera(const Place& place) {
    ASSIGN_OR_RETURN(view_.camera, typed(place, ""));
    RETURN_IF_ERROR(before_world(place, "Camera"));
    view_.to_camera = state().transforms;
    view_.medium = state().outside;
    view_.medium_place = place;
    Transforms to_worlds;
    for (std::size_t k = 0; k < 2; ++k) {
      const auto to_world = inverse(state().transforms[k]);
      if (!to_world) {
        return error_at(place, "the camera's transformation is singular");
      }
      to_worlds[k] = *to_world;
    }
    graphics_.define_system("camera", to_worlds);
    return absl::OkStatus();
  }
  absl::Status film(const Place& place) {
    ASSIGN_OR_RETURN(view_.film, typed(place, ""));
    return before_world(place, "Film");
  }
  absl::Status pixel_filter(const Place& place) {
    ASSIGN_OR_RETURN(view_.filter, typed(place, ""));
    return before_world(place, "PixelFilter");
  }
  absl::Status integrator(const Place& place) {
    ASSIGN_OR_RETURN(view_.integrator, typed(place, ""));
    return before_world(place, "Integrator");
  }

  /// Returns an error if the directive `what` stands after WorldBegin.
  absl::Status before_world(const Place& place, absl::string_view what) const {
    return !is_in_world_ ? absl::OkStatus()
                         : error_at(place, absl::StrCat(what, " must come before WorldBegin"));
  }

  absl::Status world_begin(const Place& place) {
    RETURN_IF_ERROR(before_world(place, "WorldBegin"));
    is_in_world_ = true;
    RETURN_IF_ERROR(set_view(view_, builder_));
    state().transforms = {};
    state().is_active[0] = state().is_active[1] = true;
    graphics_.define_system("world", state().transforms);
    return absl::OkStatus();
  }

  // The end.

  /// Sets what is known only at the end: fog, media, shutter and background.
  absl::StatusOr<ConvertedScene> finish() {
    if (!is_in_world_) {
      return absl::InvalidArgumentError(
          absl::StrCat(builder_.from.name, ": has no WorldBegin; it is no pbrt-v4 scene"));
    }
    warn_of_missing_ends(builder_.from.name);
    if (!view_.medium.empty()) {
      ASSIGN_OR_RETURN(const std::string fog,
                       medium_name(view_.medium, view_.medium_place, {}, builder_));
      builder_.out.set_fog(fog);
    }
    RETURN_IF_ERROR(finish_media(view_.medium, builder_));
    if (!builder_.has_motion) {
      builder_.out.mutable_camera()->clear_shutter_open();
      builder_.out.mutable_camera()->clear_shutter_close();
    }
    if (builder_.out.background().kind_case() == scene::Background::KIND_NOT_SET) {
      set_rgb({0, 0, 0}, builder_.out.mutable_background()->mutable_constant());
    }
    return ConvertedScene{std::move(builder_.out), builder_.made.take(),
                          std::move(builder_.warnings)};
  }

  /// A file of the directive Import.
  struct ImportedFile {
    std::string name;
    std::size_t depth;  ///< number of open files while its tokens are read
  };

  Builder builder_;
  Tokens tokens_;
  GraphicsState graphics_;
  std::vector<ImportedFile> imports_;   ///< imported files that are open, the innermost last
  std::map<std::string, int> objects_;  ///< name -> number of shapes, models and instances in it
  std::string object_;                  ///< name of the object that ObjectBegin began last
  ViewSource view_;
  bool is_in_world_ = false;
};

}  // namespace
}  // namespace pbrt

absl::StatusOr<ConvertedScene> convert_pbrt(const ForeignScene& from) {
  if (!from.parameters.empty()) {
    return absl::InvalidArgumentError(absl::StrCat(
        from.name, ": -D is for scenes of Mitsuba; scenes of pbrt have no parameters"));
  }
  return pbrt::Interpreter(from).run();
}

}  // namespace bandsaw
