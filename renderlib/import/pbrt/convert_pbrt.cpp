#include "renderlib/import/pbrt/convert_pbrt.h"

#include <algorithm>
#include <functional>
#include <map>
#include <utility>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/pbrt/builder.h"
#include "renderlib/import/pbrt/motion.h"
#include "renderlib/import/pbrt/tokens.h"
#include "renderlib/import/pbrt/view.h"

namespace bandsaw {
namespace pbrt {
namespace {

/// Maximum number of attributes within each other.
constexpr std::size_t kMaxNesting = 1024;

/// Executes the directives of a scene.
class Interpreter {
 public:
  explicit Interpreter(const ForeignScene& from) : builder_(from), tokens_(from.folder) {
    auto surface = std::make_shared<Surface>();
    surface->label = "default";
    set_rgb({0.5, 0.5, 0.5}, surface->material.mutable_diffuse()->mutable_color());
    state_.surface = std::move(surface);
  }

  absl::StatusOr<ConvertedScene> run() {
    RETURN_IF_ERROR(tokens_.include(builder_.from.name, {builder_.from.name, 0}));
    while (true) {
      ASSIGN_OR_RETURN(std::optional<Token> token, tokens_.next());
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
  using Action = absl::Status (Interpreter::*)(const Place&);

  absl::Status execute(const Token& token) {
    static constexpr std::pair<const char*, Action> kActions[] = {
        {"Shape", &Interpreter::shape},
        {"AttributeBegin", &Interpreter::attribute_begin},
        {"AttributeEnd", &Interpreter::attribute_end},
        {"TransformBegin", &Interpreter::attribute_begin},
        {"TransformEnd", &Interpreter::transform_end},
        {"Attribute", &Interpreter::attribute},
        {"Transform", &Interpreter::transform},
        {"ConcatTransform", &Interpreter::concat_transform},
        {"Translate", &Interpreter::translate},
        {"Scale", &Interpreter::scale},
        {"Rotate", &Interpreter::rotate},
        {"LookAt", &Interpreter::look_at},
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
        {"Import", &Interpreter::include}};
    for (const auto& [name, action] : kActions) {
      if (token.text == name) {
        return (this->*action)(token.place);
      }
    }
    return error_at(token.place,
                    absl::StrCat("\"", token.text.substr(0, 80), "\" is no directive of pbrt-v4"));
  }

  // Arguments of directives.

  absl::StatusOr<std::string> word_in_quotes(const Place& place, absl::string_view what) {
    ASSIGN_OR_RETURN(std::optional<Token> token, tokens_.next());
    if (!token || token->kind != Token::Kind::kString) {
      return error_at(place, absl::StrCat(what, " in quotes is expected"));
    }
    return std::move(token->text);
  }

  /// Reads `count` numbers, which may stand in brackets.
  absl::StatusOr<std::vector<double>> numbers(const Place& place, std::size_t count) {
    std::vector<double> out;
    ASSIGN_OR_RETURN(std::optional<Token> token, tokens_.next());
    const bool in_brackets = token && token->kind == Token::Kind::kOpen;
    if (in_brackets) {
      ASSIGN_OR_RETURN(token, tokens_.next());
    }
    while (token && token->kind == Token::Kind::kWord) {
      ASSIGN_OR_RETURN(const double number, number_of(*token));
      out.push_back(number);
      if (out.size() == count) {
        break;
      }
      ASSIGN_OR_RETURN(token, tokens_.next());
    }
    if (out.size() == count && in_brackets) {
      ASSIGN_OR_RETURN(token, tokens_.next());
      if (!token || token->kind != Token::Kind::kClose) {
        out.clear();
      }
    }
    return out.size() == count ? absl::StatusOr<std::vector<double>>(std::move(out))
                               : error_at(place, absl::StrCat(count, " numbers are expected"));
  }

  /// Reads "type" and parameters, with the defaults that Attribute set for `target`.
  absl::StatusOr<std::pair<std::string, Parameters>> typed(const Place& place,
                                                           const std::string& target) {
    ASSIGN_OR_RETURN(std::string type, word_in_quotes(place, "a type"));
    ASSIGN_OR_RETURN(Parameters parameters, read_parameters(tokens_, place));
    add_defaults(target, parameters);
    return std::pair(std::move(type), std::move(parameters));
  }

  void add_defaults(const std::string& target, Parameters& parameters) const {
    if (state_.defaults == nullptr) {
      return;
    }
    std::vector<Parameter> defaults;
    for (const auto& [of, parameter] : *state_.defaults) {
      if (of == target) {
        defaults.push_back(parameter);
      }
    }
    parameters.add_defaults(defaults);
  }

  // Transformations.

  absl::Status apply(const Place& place, const Transform& by) {
    for (std::size_t k = 0; k < 2; ++k) {
      if (state_.is_active[k]) {
        RETURN_IF_ERROR(set(place, k, state_.transforms[k] * by));
      }
    }
    return absl::OkStatus();
  }

  absl::Status set(const Place& place, std::size_t k, const Transform& to) {
    for (const auto& row : to.m) {
      for (const double number : row) {
        if (!(std::abs(number) < 1e30)) {
          return error_at(place, "the transformation has a number beyond 1e30");
        }
      }
    }
    state_.transforms[k] = to;
    return absl::OkStatus();
  }

  /// Reads a matrix of 16 numbers, column by column.
  absl::StatusOr<Transform> read_matrix(const Place& place) {
    ASSIGN_OR_RETURN(const std::vector<double> m, numbers(place, 16));
    if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] == 0) {
      return error_at(place, "the last row of the matrix must be 0 0 0 1: it must be affine");
    }
    Transform out;
    for (std::size_t row = 0; row < 3; ++row) {
      for (std::size_t column = 0; column < 4; ++column) {
        out.m[row][column] = m[column * 4 + row] / m[15];
      }
    }
    return out;
  }

  absl::Status transform(const Place& place) {
    ASSIGN_OR_RETURN(const Transform to, read_matrix(place));
    for (std::size_t k = 0; k < 2; ++k) {
      if (state_.is_active[k]) {
        RETURN_IF_ERROR(set(place, k, to));
      }
    }
    return absl::OkStatus();
  }

  absl::Status concat_transform(const Place& place) {
    ASSIGN_OR_RETURN(const Transform by, read_matrix(place));
    return apply(place, by);
  }

  absl::Status translate(const Place& place) {
    ASSIGN_OR_RETURN(const auto n, numbers(place, 3));
    return apply(place, translation({n[0], n[1], n[2]}));
  }

  absl::Status scale(const Place& place) {
    ASSIGN_OR_RETURN(const auto n, numbers(place, 3));
    return apply(place, scaling({n[0], n[1], n[2]}));
  }

  absl::Status rotate(const Place& place) {
    ASSIGN_OR_RETURN(const auto n, numbers(place, 4));
    const Vec3 axis{n[1], n[2], n[3]};
    if (!(length(axis) > 0)) {
      return error_at(place, "the axis of a rotation must not be zero");
    }
    return apply(place, rotation(axis, n[0]));
  }

  absl::Status look_at(const Place& place) {
    ASSIGN_OR_RETURN(const auto n, numbers(place, 9));
    const Vec3 eye{n[0], n[1], n[2]};
    const Vec3 ahead = Vec3{n[3], n[4], n[5]} - eye;
    const Vec3 up{n[6], n[7], n[8]};
    if (!(length(ahead) > 0) || !(length(cross(up, ahead)) > 1e-9 * length(up) * length(ahead))) {
      return error_at(place, "LookAt needs a direction, and an up that is not parallel to it");
    }
    const Vec3 forward = normalize(ahead);
    const Vec3 right = normalize(cross(normalize(up), forward));
    const Vec3 new_up = cross(forward, right);
    Transform to_world;
    for (std::size_t row = 0; row < 3; ++row) {
      const auto axis = static_cast<int>(row);
      to_world.m[row] = {right[axis], new_up[axis], forward[axis], eye[axis]};
    }
    const auto to_camera = inverse(to_world);
    return to_camera ? apply(place, *to_camera)
                     : error_at(place, "LookAt makes a transformation that is singular");
  }

  absl::Status identity(const Place&) {
    for (std::size_t k = 0; k < 2; ++k) {
      state_.transforms[k] = state_.is_active[k] ? Transform{} : state_.transforms[k];
    }
    return absl::OkStatus();
  }

  absl::Status coordinate_system(const Place& place) {
    ASSIGN_OR_RETURN(const std::string name, word_in_quotes(place, "a name"));
    systems_[name] = state_.transforms;
    return absl::OkStatus();
  }

  absl::Status coord_sys_transform(const Place& place) {
    ASSIGN_OR_RETURN(const std::string name, word_in_quotes(place, "a name"));
    const auto found = systems_.find(name);
    if (found == systems_.end()) {
      builder_.warn(place, absl::StrCat("no coordinate system is called \"", name, "\""));
      return absl::OkStatus();
    }
    state_.transforms = found->second;
    return absl::OkStatus();
  }

  absl::Status active_transform(const Place& place) {
    ASSIGN_OR_RETURN(std::optional<Token> token, tokens_.next());
    const std::string which = token ? token->text : "";
    if (which != "StartTime" && which != "EndTime" && which != "All") {
      return error_at(place, "ActiveTransform is followed by StartTime, EndTime or All");
    }
    state_.is_active[0] = which != "EndTime";
    state_.is_active[1] = which != "StartTime";
    return absl::OkStatus();
  }

  absl::Status transform_times(const Place& place) {
    ASSIGN_OR_RETURN(const auto n, numbers(place, 2));
    if (!(n[0] < n[1] && std::abs(n[0]) <= 1e9 && std::abs(n[1]) <= 1e9)) {
      return error_at(place, "TransformTimes needs two times, the first before the second");
    }
    builder_.start_time = n[0];
    builder_.end_time = n[1];
    return absl::OkStatus();
  }

  // The graphics state.

  absl::Status attribute_begin(const Place& place) {
    if (saved_.size() >= kMaxNesting) {
      return absl::ResourceExhaustedError(absl::StrCat(text_of(place), ": more than ", kMaxNesting,
                                                       " attributes within each other"));
    }
    saved_.push_back(state_);
    return absl::OkStatus();
  }

  absl::Status attribute_end(const Place& place) {
    if (saved_.empty()) {
      return error_at(place, "AttributeEnd without AttributeBegin");
    }
    state_ = std::move(saved_.back());
    saved_.pop_back();
    return absl::OkStatus();
  }

  absl::Status transform_end(const Place& place) {
    if (saved_.empty()) {
      return error_at(place, "TransformEnd without TransformBegin");
    }
    state_.transforms = saved_.back().transforms;
    std::copy(std::begin(saved_.back().is_active), std::end(saved_.back().is_active),
              std::begin(state_.is_active));
    saved_.pop_back();
    return absl::OkStatus();
  }

  absl::Status attribute(const Place& place) {
    ASSIGN_OR_RETURN(const std::string target, word_in_quotes(place, "what it is for"));
    ASSIGN_OR_RETURN(Parameters parameters, read_parameters(tokens_, place));
    if (target != "shape" && target != "light" && target != "material" && target != "medium" &&
        target != "texture") {
      return error_at(place, absl::StrCat("Attribute is for shape, light, material, medium or "
                                          "texture, not \"",
                                          target, "\""));
    }
    auto defaults = state_.defaults == nullptr ? std::vector<std::pair<std::string, Parameter>>()
                                               : *state_.defaults;
    for (Parameter& parameter : parameters.list) {
      std::erase_if(defaults, [&](const auto& old) {
        return old.first == target && old.second.name == parameter.name;
      });
      defaults.emplace_back(target, std::move(parameter));
    }
    if (defaults.size() > kMaxParameters) {
      return error_at(place, "too many attributes");
    }
    state_.defaults =
        std::make_shared<const std::vector<std::pair<std::string, Parameter>>>(std::move(defaults));
    return absl::OkStatus();
  }

  absl::Status reverse_orientation(const Place&) {
    state_.reverse_orientation = !state_.reverse_orientation;
    return absl::OkStatus();
  }

  absl::Status color_space(const Place& place) {
    ASSIGN_OR_RETURN(const std::string name, word_in_quotes(place, "a name"));
    if (name != "srgb" && name != "rec2020" && name != "dci-p3" && name != "aces2065-1") {
      return error_at(place, absl::StrCat("the colour space \"", name, "\" is not known"));
    }
    state_.color_space = name;
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

  absl::Status without_effect(const Place& place) { return typed(place, "").status(); }
  absl::Status nothing(const Place&) { return absl::OkStatus(); }

  absl::Status include(const Place& place) {
    ASSIGN_OR_RETURN(const std::string name, word_in_quotes(place, "a file"));
    return tokens_.include(name, place);
  }

  // Materials, textures, media.

  absl::Status material(const Place& place) {
    ASSIGN_OR_RETURN(const auto read, typed(place, "material"));
    ASSIGN_OR_RETURN(state_.surface,
                     make_surface(read.first, read.first, read.second, state_, builder_));
    return absl::OkStatus();
  }

  absl::Status make_named_material(const Place& place) {
    ASSIGN_OR_RETURN(const auto read, typed(place, "material"));
    const std::string& name = read.first;
    ASSIGN_OR_RETURN(const std::string type, read.second.text("type", ""));
    if (type.empty()) {
      return error_at(place, "MakeNamedMaterial needs \"string type\"");
    }
    ASSIGN_OR_RETURN(auto surface, make_surface(type, name, read.second, state_, builder_));
    if (!builder_.materials.emplace(name, std::move(surface)).second) {
      return error_at(place, absl::StrCat("a material called \"", name, "\" exists"));
    }
    return absl::OkStatus();
  }

  absl::Status named_material(const Place& place) {
    ASSIGN_OR_RETURN(const std::string name, word_in_quotes(place, "a name"));
    const auto found = builder_.materials.find(name);
    if (found == builder_.materials.end()) {
      return error_at(place, absl::StrCat("no material is called \"", name, "\""));
    }
    state_.surface = found->second;
    return absl::OkStatus();
  }

  absl::Status texture(const Place& place) {
    ASSIGN_OR_RETURN(const std::string name, word_in_quotes(place, "a name"));
    ASSIGN_OR_RETURN(const std::string type, word_in_quotes(place, "a type"));
    ASSIGN_OR_RETURN(auto read, typed(place, "texture"));
    return add_texture(name, type, read.first, std::move(read.second), state_, builder_);
  }

  absl::Status make_named_medium(const Place& place) {
    ASSIGN_OR_RETURN(auto read, typed(place, "medium"));
    ASSIGN_OR_RETURN(const std::string type, read.second.text("type", ""));
    if (read.first.empty() || type.empty()) {
      return error_at(place, "MakeNamedMedium needs a name and \"string type\"");
    }
    // pbrt-v4 refuses a second one of the name; so old scenes are converted nevertheless.
    builder_.media[read.first] = {type, std::move(read.second), state_.color_space,
                                  state_.transforms[0]};
    return absl::OkStatus();
  }

  absl::Status medium_interface(const Place& place) {
    ASSIGN_OR_RETURN(state_.inside, word_in_quotes(place, "a medium"));
    ASSIGN_OR_RETURN(std::optional<Token> token, tokens_.next());
    state_.outside = state_.inside;
    if (token && token->kind == Token::Kind::kString) {
      state_.outside = std::move(token->text);
    } else if (token) {
      tokens_.put_back(*std::move(token));
    }
    return absl::OkStatus();
  }

  // Shapes and lights.

  absl::Status shape(const Place& place) {
    ASSIGN_OR_RETURN(const auto read, typed(place, "shape"));
    RETURN_IF_ERROR(in_world(place, "Shape"));
    return add_shape(read.first, read.second, state_, builder_);
  }

  absl::Status area_light_source(const Place& place) {
    ASSIGN_OR_RETURN(auto read, typed(place, "light"));
    if (read.first != "diffuse") {
      return error_at(place, absl::StrCat("the area light \"", read.first, "\" is not known"));
    }
    read.second.ignore({"L", "scale", "power", "twosided", "filename"});
    builder_.warn_of_unused(read.second);
    state_.area_light = std::make_shared<const AreaLight>(AreaLight{std::move(read.second)});
    return absl::OkStatus();
  }

  absl::Status light_source(const Place& place) {
    ASSIGN_OR_RETURN(const auto read, typed(place, "light"));
    RETURN_IF_ERROR(in_world(place, "LightSource"));
    return add_light(read.first, read.second, state_, builder_);
  }

  absl::Status object_begin(const Place& place) {
    ASSIGN_OR_RETURN(const std::string name, word_in_quotes(place, "a name"));
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
    ASSIGN_OR_RETURN(const std::string name, word_in_quotes(place, "a name"));
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
    if (!inverse(state_.transforms[0])) {
      return error_at(place, "the transformation of the object is singular");
    }
    scene::Instance& instance = *builder_.out.add_instance();
    instance.set_of(absl::StrCat("object ", name));
    place_instance(place, state_.transforms, instance, builder_);
    return absl::OkStatus();
  }

  absl::Status in_world(const Place& place, absl::string_view what) const {
    return is_in_world_ ? absl::OkStatus()
                        : error_at(place, absl::StrCat(what, " must come after WorldBegin"));
  }

  // The image.

  absl::Status camera(const Place& place) {
    ASSIGN_OR_RETURN(view_.camera, typed(place, ""));
    RETURN_IF_ERROR(before_world(place, "Camera"));
    view_.to_camera = state_.transforms;
    view_.medium = state_.outside;
    view_.medium_place = place;
    for (std::size_t k = 0; k < 2; ++k) {
      const auto to_world = inverse(state_.transforms[k]);
      if (!to_world) {
        return error_at(place, "the camera's transformation is singular");
      }
      systems_["camera"][k] = *to_world;
    }
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

  absl::Status before_world(const Place& place, absl::string_view what) const {
    return !is_in_world_ ? absl::OkStatus()
                         : error_at(place, absl::StrCat(what, " must come before WorldBegin"));
  }

  absl::Status world_begin(const Place& place) {
    RETURN_IF_ERROR(before_world(place, "WorldBegin"));
    is_in_world_ = true;
    RETURN_IF_ERROR(set_view(view_, builder_));
    state_.transforms = {};
    state_.is_active[0] = state_.is_active[1] = true;
    systems_["world"] = state_.transforms;
    return absl::OkStatus();
  }

  // The end.

  /// Fills the box around the scene with each medium that is bounded from one side only.
  absl::Status fill_open_media() {
    for (const auto& [name, place] : builder_.open_media) {
      if (name == view_.medium) {
        continue;
      }
      const bool is_known = builder_.media.count(name) > 0;
      ASSIGN_OR_RETURN(const std::string medium, medium_name(name, place, {}, builder_));
      if (medium.empty() || !is_known) {
        continue;
      }
      builder_.warn(place, absl::StrCat("the medium \"", name,
                                        "\" is bounded by open surfaces: it fills the box around "
                                        "the scene's shapes"));
      const Vec3 size = builder_.extent.high - builder_.extent.low;
      const double margin = 1e-4 * max_abs(size);
      const Vec3 edge{margin, margin, margin};
      scene::Shape& box = *builder_.out.add_shape();
      set_vec3(builder_.extent.low - edge, box.mutable_box()->mutable_min());
      set_vec3(builder_.extent.high + edge, box.mutable_box()->mutable_max());
      box.set_interior(medium);
      open_.push_back(medium);
    }
    return absl::OkStatus();
  }

  /// Orders the media: later ones replace earlier ones where they overlap.
  void order_media() {
    auto& media = *builder_.out.mutable_medium();
    const auto rank = [this](const scene::Medium& medium) {
      return std::find(open_.begin(), open_.end(), medium.name()) != open_.end() ? 0
             : medium.name() == kVacuum                                          ? 2
                                                                                 : 1;
    };
    std::stable_sort(
        media.pointer_begin(), media.pointer_end(),
        [&](const scene::Medium* a, const scene::Medium* b) { return rank(*a) < rank(*b); });
  }

  absl::StatusOr<ConvertedScene> finish() {
    if (!is_in_world_) {
      return absl::InvalidArgumentError(
          absl::StrCat(builder_.from.name, ": has no WorldBegin; it is no pbrt-v4 scene"));
    }
    if (!saved_.empty()) {
      builder_.warnings.push_back(absl::StrCat(builder_.from.name, ": ", saved_.size(),
                                               " AttributeEnd are missing at the end"));
    }
    if (!view_.medium.empty()) {
      ASSIGN_OR_RETURN(const std::string fog,
                       medium_name(view_.medium, view_.medium_place, {}, builder_));
      builder_.out.set_fog(fog);
    }
    RETURN_IF_ERROR(fill_open_media());
    if (builder_.needs_vacuum) {
      builder_.out.add_medium()->set_name(kVacuum);
    }
    order_media();
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

  Builder builder_;
  Tokens tokens_;
  State state_;
  std::vector<State> saved_;
  std::map<std::string, Transforms> systems_;
  std::map<std::string, int> objects_;  ///< number of things in each
  std::string object_;                  ///< between ObjectBegin and ObjectEnd
  ViewSource view_;
  bool is_in_world_ = false;
  std::vector<std::string> open_;  ///< media that fill the box around the scene
};

}  // namespace
}  // namespace pbrt

absl::StatusOr<ConvertedScene> convert_pbrt(const ForeignScene& from) {
  if (!from.parameters.empty()) {
    return absl::InvalidArgumentError(
        absl::StrCat(from.name, ": -D is for Mitsuba's scenes; those of pbrt have no parameters"));
  }
  return pbrt::Interpreter(from).run();
}

}  // namespace bandsaw
