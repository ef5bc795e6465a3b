#include "renderlib/import/convert/read_ply.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>

#include "absl/strings/ascii.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw {
namespace {

enum class Form { kText, kLittle, kBig };

struct Type {
  const char* names[2];
  std::size_t size;
  char kind;  ///< i: signed, u: unsigned, f: float
};
constexpr Type kTypes[] = {{{"char", "int8"}, 1, 'i'},     {{"uchar", "uint8"}, 1, 'u'},
                           {{"short", "int16"}, 2, 'i'},   {{"ushort", "uint16"}, 2, 'u'},
                           {{"int", "int32"}, 4, 'i'},     {{"uint", "uint32"}, 4, 'u'},
                           {{"float", "float32"}, 4, 'f'}, {{"double", "float64"}, 8, 'f'}};

struct Property {
  std::string name;
  const Type* type = nullptr;
  const Type* count = nullptr;  ///< of a list
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
};

absl::Status broken(absl::string_view what) {
  return absl::InvalidArgumentError(absl::StrCat("is not a PLY file that can be read: ", what));
}

const Type* type_named(absl::string_view name) {
  for (const Type& type : kTypes) {
    if (name == type.names[0] || name == type.names[1]) {
      return &type;
    }
  }
  return nullptr;
}

/// Reads values from the body.
class Body {
 public:
  Body(absl::string_view bytes, Form form) : bytes_(bytes), form_(form) {}

  absl::StatusOr<double> next(const Type& type) {
    if (form_ == Form::kText) {
      return next_word();
    }
    if (bytes_.size() - at_ < type.size) {
      return broken("it is truncated");
    }
    unsigned char raw[8] = {};
    std::memcpy(raw, bytes_.data() + at_, type.size);
    at_ += type.size;
    if ((form_ == Form::kBig) == (std::endian::native == std::endian::little)) {
      std::reverse(raw, raw + type.size);
    }
    return value_of(raw, type);
  }
  std::size_t left() const { return bytes_.size() - at_; }

 private:
  template <class T>
  static double as(const unsigned char* raw) {
    T value;
    std::memcpy(&value, raw, sizeof(T));
    return static_cast<double>(value);
  }
  static double value_of(const unsigned char* raw, const Type& type) {
    switch (type.size) {
      case 1:
        return type.kind == 'i' ? as<std::int8_t>(raw) : as<std::uint8_t>(raw);
      case 2:
        return type.kind == 'i' ? as<std::int16_t>(raw) : as<std::uint16_t>(raw);
      case 4:
        return type.kind == 'f'   ? as<float>(raw)
               : type.kind == 'i' ? as<std::int32_t>(raw)
                                  : as<std::uint32_t>(raw);
      default:
        return as<double>(raw);
    }
  }
  absl::StatusOr<double> next_word() {
    while (at_ < bytes_.size() && absl::ascii_isspace(static_cast<unsigned char>(bytes_[at_]))) {
      ++at_;
    }
    const std::size_t begin = at_;
    while (at_ < bytes_.size() && !absl::ascii_isspace(static_cast<unsigned char>(bytes_[at_]))) {
      ++at_;
    }
    double value = 0;
    if (!absl::SimpleAtod(bytes_.substr(begin, at_ - begin), &value)) {
      return broken(begin == bytes_.size() ? "it is truncated" : "a number is expected");
    }
    return value;
  }

  absl::string_view bytes_;
  Form form_;
  std::size_t at_ = 0;
};

struct Header {
  Form form = Form::kText;
  std::vector<Element> elements;
  std::size_t body_at = 0;
};

absl::StatusOr<Header> read_header(absl::string_view bytes) {
  constexpr std::size_t kMaxHeader = 100'000;
  Header header;
  std::size_t at = 0;
  bool has_form = false;
  for (int number = 0;; ++number) {
    const std::size_t end = bytes.find('\n', at);
    if (end == bytes.npos || end > kMaxHeader) {
      return broken("its header has no end");
    }
    const std::vector<std::string> words =
        absl::StrSplit(bytes.substr(at, end - at), absl::ByAnyChar(" \t\r"), absl::SkipEmpty());
    at = end + 1;
    if (number == 0) {
      if (words.size() != 1 || words[0] != "ply") {
        return broken("it does not begin with \"ply\"");
      }
      continue;
    }
    if (words.empty() || words[0] == "comment" || words[0] == "obj_info") {
      continue;
    }
    if (words[0] == "end_header") {
      header.body_at = at;
      return has_form ? absl::StatusOr<Header>(header) : broken("its format is missing");
    }
    if (words[0] == "format" && words.size() == 3) {
      has_form = true;
      header.form = words[1] == "ascii"                  ? Form::kText
                    : words[1] == "binary_little_endian" ? Form::kLittle
                                                         : Form::kBig;
      if (header.form == Form::kBig && words[1] != "binary_big_endian") {
        return broken("its format is not known");
      }
    } else if (words[0] == "element" && words.size() == 3) {
      Element element{words[1], 0, {}};
      if (!absl::SimpleAtoi(words[2], &element.count)) {
        return broken("the number of an element is wrong");
      }
      header.elements.push_back(std::move(element));
    } else if (words[0] == "property" && !header.elements.empty()) {
      Property property{words.back(), nullptr, nullptr};
      const bool is_list = words.size() == 5 && words[1] == "list";
      property.count = is_list ? type_named(words[2]) : nullptr;
      property.type = is_list             ? type_named(words[3])
                      : words.size() == 3 ? type_named(words[1])
                                          : nullptr;
      if (property.type == nullptr || (is_list && property.count == nullptr)) {
        return broken("a property has a type that is not known");
      }
      header.elements.back().properties.push_back(std::move(property));
    } else {
      return broken("its header has a line that is not known");
    }
  }
}

/// Where a property of a vertex goes.
struct Target {
  char list = ' ';  ///< p, n, t, or a space for none
  std::size_t axis = 0;
};

Target target_of(const std::string& name) {
  constexpr std::pair<const char*, Target> kTargets[] = {
      {"x", {'p', 0}},         {"y", {'p', 1}},         {"z", {'p', 2}},
      {"nx", {'n', 0}},        {"ny", {'n', 1}},        {"nz", {'n', 2}},
      {"u", {'t', 0}},         {"v", {'t', 1}},         {"s", {'t', 0}},
      {"t", {'t', 1}},         {"texture_u", {'t', 0}}, {"texture_v", {'t', 1}},
      {"texture_s", {'t', 0}}, {"texture_t", {'t', 1}}};
  for (const auto& [known, target] : kTargets) {
    if (name == known) {
      return target;
    }
  }
  return {};
}

/// Reads the values of a property; a list's are appended to `list` (which may be nullptr).
absl::StatusOr<double> read_property(const Property& property, Body& body,
                                     std::vector<double>* list) {
  if (property.count == nullptr) {
    return body.next(*property.type);
  }
  ASSIGN_OR_RETURN(const double count, body.next(*property.count));
  if (!(count >= 0 && count <= static_cast<double>(body.left()))) {
    return broken("a list is longer than the file");
  }
  for (double i = 0; i < count; ++i) {
    ASSIGN_OR_RETURN(const double value, body.next(*property.type));
    if (list != nullptr) {
      list->push_back(value);
    }
  }
  return count;
}

absl::Status read_vertices(const Element& element, Body& body, PlyMesh& mesh) {
  std::vector<Target> targets;
  bool has[3] = {};
  for (const Property& property : element.properties) {
    targets.push_back(property.count == nullptr ? target_of(property.name) : Target{});
    has[0] = has[0] || targets.back().list == 'p';
    has[1] = has[1] || targets.back().list == 'n';
    has[2] = has[2] || targets.back().list == 't';
  }
  if (!has[0]) {
    return broken("its vertices have no position");
  }
  for (std::uint64_t i = 0; i < element.count; ++i) {
    std::array<float, 3> p = {};
    std::array<float, 3> n = {};
    std::array<float, 2> t = {};
    for (std::size_t k = 0; k < targets.size(); ++k) {
      ASSIGN_OR_RETURN(const double value, read_property(element.properties[k], body, nullptr));
      const auto number = static_cast<float>(value);
      if (targets[k].list != ' ' && !std::isfinite(number)) {
        return broken("a vertex has a number that is not finite");
      }
      if (targets[k].list == 'p') {
        p[targets[k].axis] = number;
      } else if (targets[k].list == 'n') {
        n[targets[k].axis] = number;
      } else if (targets[k].list == 't') {
        t[targets[k].axis] = number;
      }
    }
    mesh.positions.push_back(p);
    if (has[1]) {
      mesh.normals.push_back(n);
    }
    if (has[2]) {
      mesh.uvs.push_back(t);
    }
  }
  return absl::OkStatus();
}

absl::Status read_faces(const Element& element, Body& body, PlyMesh& mesh) {
  const auto count = static_cast<double>(mesh.positions.size());
  std::vector<double> corners;
  for (std::uint64_t i = 0; i < element.count; ++i) {
    corners.clear();
    for (const Property& property : element.properties) {
      const bool is_face = property.name == "vertex_indices" || property.name == "vertex_index";
      RETURN_IF_ERROR(read_property(property, body, is_face ? &corners : nullptr).status());
    }
    for (const double corner : corners) {
      if (!(corner >= 0 && corner < count)) {
        return broken("a face has a corner that is no vertex");
      }
    }
    for (std::size_t k = 2; k < corners.size(); ++k) {
      mesh.triangles.push_back({static_cast<std::uint32_t>(corners[0]),
                                static_cast<std::uint32_t>(corners[k - 1]),
                                static_cast<std::uint32_t>(corners[k])});
    }
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<PlyMesh> read_ply(absl::string_view bytes) {
  ASSIGN_OR_RETURN(const Header header, read_header(bytes));
  Body body(bytes.substr(header.body_at), header.form);
  PlyMesh mesh;
  for (const Element& element : header.elements) {
    // A value takes a byte or more, so a larger claim is wrong; it would take hours to find out.
    if (element.count > bytes.size() || element.properties.empty()) {
      return broken("it claims more elements than it has bytes");
    }
    if (element.name == "vertex") {
      RETURN_IF_ERROR(read_vertices(element, body, mesh));
    } else if (element.name == "face") {
      RETURN_IF_ERROR(read_faces(element, body, mesh));
    } else {
      for (std::uint64_t i = 0; i < element.count; ++i) {
        for (const Property& property : element.properties) {
          RETURN_IF_ERROR(read_property(property, body, nullptr).status());
        }
      }
    }
  }
  if (mesh.triangles.empty()) {
    return broken("it has no face");
  }
  return mesh;
}

}  // namespace bandsaw
