// Reads the XML of a Mitsuba scene as a tree of objects. Reader parses each file with pugixml,
// replaces the parameters ("$name") in attributes, and makes an Object of each element. When all
// files are read, it resolves references. Size, nesting and the number of objects have bounds.

#include "renderlib/import/mitsuba/read_scene_tree.h"

#include <algorithm>
#include <cctype>
#include <functional>
#include <pugixml.hpp>
#include <set>
#include <utility>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/mitsuba/read_values.h"

namespace bandsaw::mitsuba {

std::string text_of(const Place& place) { return absl::StrCat(*place.file, ":", place.line); }

absl::Status error_at(const Place& place, const std::string& what) {
  return absl::InvalidArgumentError(absl::StrCat(text_of(place), ": ", what));
}

absl::Status at_place(const Place& place, const absl::Status& why) {
  if (absl::StartsWith(why.message(), absl::StrCat(*place.file, ":"))) {
    return why;
  }
  return absl::Status(why.code(), absl::StrCat(text_of(place), ": ", why.message()));
}

namespace {

constexpr std::uint64_t kMaxXmlBytes = std::uint64_t{64} << 20;  ///< total size of all files
constexpr int kMaxIncludeDepth = 15;
constexpr int kMaxIncludes = 1000;
/// Longest text of an attribute after its parameters are replaced, in bytes.
constexpr std::size_t kMaxAttribute = std::size_t{1} << 20;
constexpr std::uint64_t kMaxParts = 10'000;  ///< objects in a bsdf, a texture, a medium, …
constexpr std::uint64_t kMaxSpectrumBytes = std::uint64_t{1} << 20;

/// Returns "to_world" for "toWorld" and "int_ior" for "intIOR", as Mitsuba 2 and 3 do when they
/// read a scene of version 0.x.
std::string with_underscores(const std::string& name) {
  std::string out;
  const auto upper = [&](std::size_t i) {
    return i < name.size() && std::isupper(static_cast<unsigned char>(name[i])) != 0;
  };
  const auto lower = [&](std::size_t i) {
    return std::islower(static_cast<unsigned char>(name[i])) != 0;
  };
  for (std::size_t i = 0; i < name.size(); ++i) {
    if (i > 0 && lower(i - 1) && upper(i)) {
      out += '_';
      for (; upper(i); ++i) {
        out += static_cast<char>(std::tolower(static_cast<unsigned char>(name[i])));
      }
      --i;
    } else {
      out += name[i];
    }
  }
  return out;
}

/// One XML file while it is read.
struct Source {
  const std::string* name;  ///< owned by the tree
  std::string path;
  std::vector<std::size_t> line_starts = {};  ///< offsets, without that of the first line

  /// Returns the place of a byte of the file.
  Place at(std::ptrdiff_t offset) const {
    const auto after =
        std::upper_bound(line_starts.begin(), line_starts.end(),
                         static_cast<std::size_t>(std::max<std::ptrdiff_t>(offset, 0)));
    return {name, static_cast<int>(after - line_starts.begin()) + 1};
  }
  Place at(const pugi::xml_node& node) const { return at(node.offset_debug()); }
};

std::vector<std::size_t> line_starts_of(const std::string& text) {
  std::vector<std::size_t> starts;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\n') {
      starts.push_back(i + 1);
    }
  }
  return starts;
}

/// Returns a node that is nested too deeply, or an empty node if there is none. Does not recurse,
/// so deep nesting cannot exhaust the stack.
pugi::xml_node too_deep(const pugi::xml_node& root) {
  pugi::xml_node at = root;
  int depth = 0;
  while (at) {
    if (depth > kMaxNesting) {
      return at;
    }
    if (at.first_child()) {
      at = at.first_child();
      ++depth;
      continue;
    }
    while (at && at != root && !at.next_sibling()) {
      at = at.parent();
      --depth;
    }
    if (!at || at == root) {
      break;
    }
    at = at.next_sibling();
  }
  return {};
}

/// Returns the tags of elements that are objects of Mitsuba, even without a type.
const std::set<std::string>& object_tags() {
  static const std::set<std::string> tags = {
      "scene", "bsdf",    "shape",   "emitter", "luminaire", "sensor", "camera", "integrator",
      "film",  "rfilter", "sampler", "texture", "medium",    "phase",  "volume", "subsurface"};
  return tags;
}

class Reader {
 public:
  Reader(const ForeignScene& from, Files& files, SceneTree& tree)
      : files_(files), tree_(tree), parameters_(from.parameters.begin(), from.parameters.end()) {
    for (const auto& [name, value] : parameters_) {
      unused_.insert(name);
    }
  }

  /// Reads the scene's file.
  absl::Status read(const ForeignScene& from) {
    ASSIGN_OR_RETURN(const pugi::xml_node root, open(from.path, from.name));
    const Source source = *sources_.back();
    if (std::string(root.name()) != "scene") {
      return error_at(source.at(root),
                      absl::StrCat("the root element must be <scene>, is <", root.name(), ">"));
    }
    tree_.is_old = root.attribute("version").as_double(3) < 2;
    ASSIGN_OR_RETURN(tree_.root, read_object(root, source));
    return resolve_references();
  }

  /// Returns INVALID_ARGUMENT if the user gave a parameter that no file uses.
  absl::Status check_parameters(const std::string& name) const {
    return unused_.empty()
               ? absl::OkStatus()
               : absl::InvalidArgumentError(absl::StrCat(name, ": has no parameter \"",
                                                         *unused_.begin(), "\", which -D sets"));
  }

 private:
  /// A <ref> element. When all files are read, the value of in->properties[property] becomes the
  /// object with this id.
  struct Reference {
    Object* in;
    std::size_t property;
    std::string id;
  };

  /// Reads and parses an XML file, appends it to sources_ and returns its root element.
  absl::StatusOr<pugi::xml_node> open(const std::string& path, const std::string& name) {
    const auto text = Files::read({name, path}, kMaxXmlBytes - std::min(bytes_, kMaxXmlBytes));
    if (!text.ok()) {
      return absl::Status(text.status().code(),
                          absl::StrCat(name, ": ", text.status().message(),
                                       " (all XML files together may have at most 64 MB)"));
    }
    bytes_ += text->size();
    tree_.files.push_back(std::make_unique<std::string>(name));
    sources_.push_back(
        std::make_unique<Source>(Source{tree_.files.back().get(), path, line_starts_of(*text)}));
    documents_.push_back(std::make_unique<pugi::xml_document>());
    pugi::xml_document& document = *documents_.back();
    const pugi::xml_parse_result result =
        document.load_buffer(text->data(), text->size(), pugi::parse_default, pugi::encoding_utf8);
    const Source& source = *sources_.back();
    if (!result) {
      return error_at(source.at(result.offset), absl::StrCat("is not XML: ", result.description()));
    }
    if (const pugi::xml_node deep = too_deep(document.document_element())) {
      return error_at(source.at(deep),
                      absl::StrCat("elements are nested more than ", kMaxNesting, " deep"));
    }
    return document.document_element();
  }

  /// Returns the attribute with each parameter ("$name") replaced by its value.
  absl::StatusOr<std::string> attribute(const pugi::xml_node& node, const char* name,
                                        const Source& source) {
    std::string value = node.attribute(name).value();
    std::size_t at = value.find('$');
    while (at != std::string::npos) {
      // If several parameters match, the longest name counts.
      const std::pair<const std::string, std::string>* best = nullptr;
      for (const auto& parameter : parameters_) {
        const bool fits = value.compare(at + 1, parameter.first.size(), parameter.first) == 0;
        if (fits && (best == nullptr || parameter.first.size() > best->first.size())) {
          best = &parameter;
        }
      }
      if (best == nullptr) {
        return error_at(source.at(node),
                        absl::StrCat("parameter in \"", value.substr(0, 60),
                                     "\" is not defined: give it with -D NAME=VALUE"));
      }
      unused_.erase(best->first);
      if (value.size() + best->second.size() > kMaxAttribute) {
        return error_at(source.at(node), "an attribute with its parameters is longer than 1 MB");
      }
      value.replace(at, best->first.size() + 1, best->second);
      at = value.find('$', at + best->second.size());
    }
    return value;
  }

  /// Reads an element that is an object, with its children, and appends the object to the tree.
  absl::StatusOr<const Object*> read_object(const pugi::xml_node& node, const Source& source) {
    Object& object = tree_.objects.emplace_back();
    object.tag = node.name();
    object.place = source.at(node);
    ASSIGN_OR_RETURN(object.type, attribute(node, "type", source));
    ASSIGN_OR_RETURN(object.id, attribute(node, "id", source));
    if (!object.id.empty()) {
      const auto [other, is_new] = by_id_.emplace(object.id, &object);
      if (!is_new) {
        return error_at(object.place, absl::StrCat("id \"", object.id, "\" is also at ",
                                                   text_of(other->second->place)));
      }
    }
    for (const pugi::xml_node& child : node.children()) {
      RETURN_IF_ERROR(read_child(child, source, object));
    }
    return &object;
  }

  /// Reads an element inside of `in`: a directive, a reference, an object or a value.
  absl::Status read_child(const pugi::xml_node& node, const Source& source, Object& in) {
    if (node.type() != pugi::node_element) {
      return absl::OkStatus();
    }
    const std::string tag = node.name();
    const Place place = source.at(node);
    if (tag == "include" || tag == "default" || tag == "path" || tag == "alias") {
      return read_directive(tag, node, source, in);
    }
    ASSIGN_OR_RETURN(const std::string written, attribute(node, "name", source));
    Property property{with_underscores(written), false, place};
    if (tag == "ref") {
      ASSIGN_OR_RETURN(const std::string id, attribute(node, "id", source));
      references_.push_back({&in, in.properties.size(), id});
      property.value = static_cast<const Object*>(nullptr);
      in.properties.push_back(std::move(property));
      return absl::OkStatus();
    }
    if (object_tags().count(tag) > 0 || node.attribute("type")) {
      ASSIGN_OR_RETURN(property.value, read_object(node, source));
      in.properties.push_back(std::move(property));
      return absl::OkStatus();
    }
    auto value = read_value(tag, node, source);
    if (absl::IsNotFound(value.status())) {
      tree_.warnings.push_back(
          absl::StrCat(text_of(place), ": element <", tag, "> is not known and is left out"));
      return absl::OkStatus();
    }
    if (!value.ok()) {
      return at_place(place, value.status());
    }
    property.value = *std::move(value);
    in.properties.push_back(std::move(property));
    return absl::OkStatus();
  }

  /// Reads <default>, <path>, <alias> or <include>.
  absl::Status read_directive(const std::string& tag, const pugi::xml_node& node,
                              const Source& source, Object& in) {
    const Place place = source.at(node);
    if (tag == "default") {
      ASSIGN_OR_RETURN(std::string value, attribute(node, "value", source));
      if (node.attribute("name").empty()) {
        return error_at(place, "<default> needs a name");
      }
      parameters_.emplace(node.attribute("name").value(), std::move(value));
      unused_.erase(node.attribute("name").value());
      return absl::OkStatus();
    }
    if (tag == "path") {
      ASSIGN_OR_RETURN(const std::string value, attribute(node, "value", source));
      const absl::Status added = files_.add_folder(value, source.path);
      return added.ok() ? added : at_place(place, added);
    }
    if (tag == "alias") {
      ASSIGN_OR_RETURN(const std::string id, attribute(node, "id", source));
      ASSIGN_OR_RETURN(const std::string as, attribute(node, "as", source));
      if (by_id_.count(as) > 0 || !aliases_.emplace(as, id).second) {
        return error_at(place, absl::StrCat("id \"", as, "\" exists already"));
      }
      return absl::OkStatus();
    }
    return include(node, source, in);
  }

  /// Reads another file into `in`: the children of its <scene>, or its only object.
  absl::Status include(const pugi::xml_node& node, const Source& source, Object& in) {
    const Place place = source.at(node);
    ASSIGN_OR_RETURN(const std::string name, attribute(node, "filename", source));
    auto file = files_.find(name);
    if (!file.ok()) {
      return at_place(place, file.status());
    }
    const bool cyclic = std::find(open_.begin(), open_.end(), file->path) != open_.end() ||
                        (open_.empty() && file->path == source.path);
    if (cyclic) {
      return error_at(place, absl::StrCat("\"", name, "\" includes itself"));
    }
    if (open_.size() >= kMaxIncludeDepth || ++includes_ > kMaxIncludes) {
      return error_at(place, absl::StrCat("files include each other more than ", kMaxIncludeDepth,
                                          " deep, or more than ", kMaxIncludes, " are included"));
    }
    open_.push_back(source.path);
    ASSIGN_OR_RETURN(const pugi::xml_node root, open(file->path, file->name));
    const Source included = *sources_.back();
    if (std::string(root.name()) == "scene") {
      for (const pugi::xml_node& child : root.children()) {
        RETURN_IF_ERROR(read_child(child, included, in));
      }
    } else {
      RETURN_IF_ERROR(read_child(root, included, in));
    }
    open_.pop_back();
    return absl::OkStatus();
  }

  /// Reads an element that is neither an object, a reference nor a directive. Returns NOT_FOUND if
  /// its tag is not known.
  absl::StatusOr<Value> read_value(const std::string& tag, const pugi::xml_node& node,
                                   const Source& source) {
    if (tag == "transform") {
      return read_transform(node, source);
    }
    if (tag == "vector" || tag == "point") {
      ASSIGN_OR_RETURN(const Vec3 vector, read_components(node, source, 0));
      return vector;
    }
    if (tag == "blackbody") {
      return read_black_body(node, source);
    }
    ASSIGN_OR_RETURN(const std::string text, attribute(node, "value", source));
    if (tag == "spectrum") {
      return read_spectrum_of(text, node, source);
    }
    if (tag == "string") {
      return Value(text);
    }
    const auto as_value = [](auto result) -> absl::StatusOr<Value> {
      if (!result.ok()) {
        return result.status();
      }
      return Value(*result);
    };
    return tag == "float"     ? as_value(read_number(text))
           : tag == "integer" ? as_value(read_integer(text))
           : tag == "boolean" ? as_value(read_boolean(text))
           : tag == "rgb"     ? as_value(read_rgb(text))
           : tag == "srgb"    ? as_value(read_srgb(text))
                              : absl::StatusOr<Value>(absl::NotFoundError(tag));
  }

  /// Reads a <spectrum>, whose values are in the file that it names or in `text`.
  absl::StatusOr<Value> read_spectrum_of(const std::string& text, const pugi::xml_node& node,
                                         const Source& source) {
    if (node.attribute("filename").empty()) {
      // In version 0.x, three numbers are an RGB colour.
      if (parts_of(text).size() == 3 && !absl::StrContains(text, ':')) {
        ASSIGN_OR_RETURN(const Rgb rgb, read_rgb(text));
        return Value(rgb);
      }
      ASSIGN_OR_RETURN(const Spectrum spectrum, read_spectrum(text));
      return Value(spectrum);
    }
    ASSIGN_OR_RETURN(const std::string name, attribute(node, "filename", source));
    ASSIGN_OR_RETURN(const FoundFile file, files_.find(name));
    ASSIGN_OR_RETURN(const std::string bytes, Files::read(file, kMaxSpectrumBytes));
    auto spectrum = read_spectrum_file(bytes);
    if (!spectrum.ok()) {
      return absl::InvalidArgumentError(absl::StrCat(name, ": ", spectrum.status().message()));
    }
    return Value(*spectrum);
  }

  absl::StatusOr<Value> read_black_body(const pugi::xml_node& node, const Source& source) {
    BlackBody body;
    ASSIGN_OR_RETURN(std::string text, attribute(node, "temperature", source));
    text = absl::StrReplaceAll(text, {{"K", ""}, {"k", ""}});
    ASSIGN_OR_RETURN(body.kelvin, read_number(text));
    if (node.attribute("scale")) {
      ASSIGN_OR_RETURN(text, attribute(node, "scale", source));
      ASSIGN_OR_RETURN(body.scale, read_number(text));
    }
    return Value(body);
  }

  /// Reads the attributes x, y and z, or `value` with one, two or three numbers. One number is used
  /// for all components. A component that is absent is `otherwise`.
  absl::StatusOr<Vec3> read_components(const pugi::xml_node& node, const Source& source,
                                       double otherwise) {
    if (node.attribute("value")) {
      ASSIGN_OR_RETURN(const std::string text, attribute(node, "value", source));
      const std::vector<std::string> parts = parts_of(text);
      if (parts.size() == 1) {
        ASSIGN_OR_RETURN(const double all, read_number(parts[0]));
        return Vec3{all, all, all};
      }
      if (parts.size() == 2) {  // a transform in the plane
        ASSIGN_OR_RETURN(const double x, read_number(parts[0]));
        ASSIGN_OR_RETURN(const double y, read_number(parts[1]));
        return Vec3{x, y, otherwise};
      }
      return read_three(text);
    }
    Vec3 to{otherwise, otherwise, otherwise};
    for (const auto& [name, member] :
         {std::pair("x", &Vec3::x), std::pair("y", &Vec3::y), std::pair("z", &Vec3::z)}) {
      if (node.attribute(name)) {
        ASSIGN_OR_RETURN(const std::string text, attribute(node, name, source));
        ASSIGN_OR_RETURN(to.*member, read_number(text));
      }
    }
    return to;
  }

  /// Reads a <transform>, the product of its children. The first child is applied first.
  absl::StatusOr<Value> read_transform(const pugi::xml_node& node, const Source& source) {
    Transform to;
    for (const pugi::xml_node& child : node.children()) {
      if (child.type() != pugi::node_element) {
        continue;
      }
      auto step = read_step(child, source);
      if (!step.ok()) {
        return at_place(source.at(child), step.status());
      }
      to = *step * to;
      for (const auto& row : to.m) {
        for (const double entry : row) {
          if (!(std::abs(entry) <= 1e30)) {
            return error_at(source.at(child), "the transform has numbers above 1e30");
          }
        }
      }
    }
    return Value(to);
  }

  /// Reads one child of a <transform>, such as <rotate>.
  absl::StatusOr<Transform> read_step(const pugi::xml_node& node, const Source& source) {
    const std::string tag = node.name();
    if (tag == "translate") {
      ASSIGN_OR_RETURN(const Vec3 by, read_components(node, source, 0));
      return translation(by);
    }
    if (tag == "scale") {
      ASSIGN_OR_RETURN(const Vec3 by, read_components(node, source, 1));
      return scaling(by);
    }
    if (tag == "rotate") {
      ASSIGN_OR_RETURN(const Vec3 axis, read_components(node, source, 0));
      ASSIGN_OR_RETURN(const std::string text, attribute(node, "angle", source));
      ASSIGN_OR_RETURN(const double degrees, read_number(text));
      if (!(length(axis) > 0)) {
        return absl::InvalidArgumentError("a rotation needs an axis that is not zero");
      }
      return rotation(axis, degrees);
    }
    if (tag == "matrix") {
      ASSIGN_OR_RETURN(const std::string text, attribute(node, "value", source));
      return read_matrix(text);
    }
    if (tag == "lookat" || tag == "lookAt") {
      return read_look_at(node, source);
    }
    return absl::InvalidArgumentError(
        absl::StrCat("<", tag,
                     "> is no step of a transform: write translate, rotate, scale, "
                     "lookat or matrix"));
  }

  /// Returns the transform whose origin is `origin`, whose z axis points to `target`, and whose x
  /// axis is on the left.
  absl::StatusOr<Transform> read_look_at(const pugi::xml_node& node, const Source& source) {
    ASSIGN_OR_RETURN(const std::string origin_text, attribute(node, "origin", source));
    ASSIGN_OR_RETURN(const std::string target_text, attribute(node, "target", source));
    ASSIGN_OR_RETURN(const Vec3 origin, read_three(origin_text));
    ASSIGN_OR_RETURN(const Vec3 target, read_three(target_text));
    if (!(length(target - origin) > 0)) {
      return absl::InvalidArgumentError("origin and target of lookat must differ");
    }
    const Vec3 ahead = normalize(target - origin);
    Vec3 up = std::abs(ahead.x) > std::abs(ahead.y) ? Vec3{0, 1, 0} : Vec3{1, 0, 0};
    if (node.attribute("up")) {
      ASSIGN_OR_RETURN(const std::string up_text, attribute(node, "up", source));
      ASSIGN_OR_RETURN(const Vec3 given, read_three(up_text));
      up = length(given) > 0 ? given : up;
    }
    const Vec3 left = cross(normalize(up), ahead);
    if (!(length(left) > 1e-9)) {
      return absl::InvalidArgumentError("up of lookat must not be parallel to the view");
    }
    const Vec3 x = normalize(left);
    const Vec3 y = cross(ahead, x);
    return Transform{{{{x.x, y.x, ahead.x, origin.x},
                       {x.y, y.y, ahead.y, origin.y},
                       {x.z, y.z, ahead.z, origin.z}}}};
  }

  /// Sets the property of each <ref> to the object that it names, then checks for cycles.
  absl::Status resolve_references() {
    for (const Reference& reference : references_) {
      Property& property = reference.in->properties[reference.property];
      std::string id = reference.id;
      for (std::size_t steps = 0; aliases_.count(id) > 0; ++steps) {
        if (steps > aliases_.size()) {
          return error_at(property.place, absl::StrCat("alias \"", id, "\" refers to itself"));
        }
        id = aliases_.at(id);
      }
      const auto found = by_id_.find(id);
      if (found == by_id_.end()) {
        return error_at(property.place, absl::StrCat("no object has the id \"", id, "\""));
      }
      property.value = static_cast<const Object*>(found->second);
    }
    return check_cycles(*tree_.root, 0);
  }

  /// Checks `object`, the objects that it contains and the objects that it refers to. No object may
  /// contain or refer to itself, even through other objects. Only scenes and shapes may have more
  /// than kMaxParts parts. Stores the size of each object in sizes_.
  absl::Status check_cycles(const Object& object, int depth) {
    if (depth > kMaxNesting) {
      return error_at(object.place, absl::StrCat("objects are nested more than ", kMaxNesting,
                                                 " deep, or one refers to itself"));
    }
    if (!visiting_.insert(&object).second) {
      return error_at(object.place,
                      absl::StrCat("<", object.tag, "> \"", object.id, "\" refers to itself"));
    }
    std::uint64_t size = 1;
    for (const Property& property : object.properties) {
      const auto* const* child = std::get_if<const Object*>(&property.value);
      if (child == nullptr) {
        continue;
      }
      if (visiting_.count(*child) > 0 || sizes_.count(*child) == 0) {
        RETURN_IF_ERROR(check_cycles(**child, depth + 1));
      }
      size += sizes_.at(*child);
    }
    const bool is_group = object.tag == "scene" || object.tag == "shape";
    if (!is_group && size > kMaxParts) {
      return error_at(object.place,
                      absl::StrCat("<", object.tag, "> has more than ", kMaxParts,
                                   " parts; a part counts each time that it is used"));
    }
    visiting_.erase(&object);
    sizes_[&object] = size;
    return absl::OkStatus();
  }

  Files& files_;
  SceneTree& tree_;
  std::map<std::string, std::string> parameters_;
  std::set<std::string> unused_;  ///< parameters of the user that nothing has used yet
  std::uint64_t bytes_ = 0;
  int includes_ = 0;
  std::vector<std::string> open_;  ///< real paths of the files whose <include> is being read
  std::vector<std::unique_ptr<Source>> sources_;
  std::vector<std::unique_ptr<pugi::xml_document>> documents_;
  std::map<std::string, Object*> by_id_;
  std::map<std::string, std::string> aliases_;
  std::vector<Reference> references_;
  std::set<const Object*> visiting_;  ///< objects that check_cycles() is visiting
  /// For each object, 1 plus the sizes of the objects that it contains or refers to.
  std::map<const Object*, std::uint64_t> sizes_;
};

}  // namespace

absl::StatusOr<SceneTree> read_scene_tree(const ForeignScene& from, Files& files) {
  SceneTree tree;
  Reader reader(from, files, tree);
  RETURN_IF_ERROR(reader.read(from));
  RETURN_IF_ERROR(reader.check_parameters(from.name));
  return tree;
}

}  // namespace bandsaw::mitsuba
