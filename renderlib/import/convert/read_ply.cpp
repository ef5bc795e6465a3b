// Reads PLY files for the converters of other renderers' scenes. The header becomes a list of
// elements and their properties; then PlyReader reads the numbers of each row, text or binary, and
// sorts them into positions, normals, uvs, faces and attributes.

#include "renderlib/import/convert/read_ply.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <optional>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw {
namespace {

static_assert(std::endian::native == std::endian::little);

enum class Type { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat, kDouble };

struct PlyProperty {
  std::string name;
  Type type = Type::kFloat;
  std::optional<Type> count = std::nullopt;  ///< type of a list's length; absent: no list
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties = {};
};

enum class Encoding { kText, kLittle, kBig };

absl::Status damaged(absl::string_view why) {
  return absl::InvalidArgumentError(absl::StrCat("is damaged: ", why));
}

std::size_t size_of(Type type) {
  constexpr std::array<std::size_t, 8> kSizes = {1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

/// Returns the type that a header calls `name`.
absl::StatusOr<Type> type_of(absl::string_view name) {
  static const std::map<absl::string_view, Type> types = {
      {"char", Type::kInt8},     {"int8", Type::kInt8},     {"uchar", Type::kUint8},
      {"uint8", Type::kUint8},   {"short", Type::kInt16},   {"int16", Type::kInt16},
      {"ushort", Type::kUint16}, {"uint16", Type::kUint16}, {"int", Type::kInt32},
      {"int32", Type::kInt32},   {"uint", Type::kUint32},   {"uint32", Type::kUint32},
      {"float", Type::kFloat},   {"float32", Type::kFloat}, {"double", Type::kDouble},
      {"float64", Type::kDouble}};
  const auto found = types.find(name);
  if (found == types.end()) {
    return damaged(absl::StrCat("type \"", name.substr(0, 40), "\" is not known"));
  }
  return found->second;
}

/// Reads the numbers after the header, one after the other.
class Numbers {
 public:
  Numbers(absl::string_view bytes, Encoding encoding) : rest_(bytes), encoding_(encoding) {}

  /// Removes the next number from the rest and returns it. `type` is its type in a binary file.
  absl::StatusOr<double> take(Type type) {
    return encoding_ == Encoding::kText ? take_text() : take_binary(type);
  }
  /// Returns false if the rest is too short for `count` elements of at least `bytes_each` bytes.
  bool may_hold(std::uint64_t count, std::uint64_t bytes_each) const {
    return count <= rest_.size() / std::max<std::uint64_t>(bytes_each, 1);
  }
  bool is_text() const { return encoding_ == Encoding::kText; }

 private:
  absl::StatusOr<double> take_text() {
    std::size_t begin = 0;
    while (begin < rest_.size() && absl::ascii_isspace(static_cast<unsigned char>(rest_[begin]))) {
      ++begin;
    }
    std::size_t end = begin;
    while (end < rest_.size() && !absl::ascii_isspace(static_cast<unsigned char>(rest_[end]))) {
      ++end;
    }
    double value = 0;
    if (begin == end) {
      return damaged("it ends too early");
    }
    if (!absl::SimpleAtod(rest_.substr(begin, end - begin), &value)) {
      return damaged(absl::StrCat("\"", rest_.substr(begin, std::min<std::size_t>(end - begin, 40)),
                                  "\" is not a number"));
    }
    rest_.remove_prefix(end);
    return value;
  }

  template <class T>
  static double as(const std::array<char, 8>& bytes) {
    T value;
    std::memcpy(&value, bytes.data(), sizeof(T));
    return static_cast<double>(value);
  }

  absl::StatusOr<double> take_binary(Type type) {
    const std::size_t size = size_of(type);
    if (rest_.size() < size) {
      return damaged("it ends too early");
    }
    std::array<char, 8> bytes{};
    std::copy_n(rest_.begin(), size, bytes.begin());
    if (encoding_ == Encoding::kBig) {
      std::reverse(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    }
    rest_.remove_prefix(size);
    switch (type) {
      case Type::kInt8:
        return as<std::int8_t>(bytes);
      case Type::kUint8:
        return as<std::uint8_t>(bytes);
      case Type::kInt16:
        return as<std::int16_t>(bytes);
      case Type::kUint16:
        return as<std::uint16_t>(bytes);
      case Type::kInt32:
        return as<std::int32_t>(bytes);
      case Type::kUint32:
        return as<std::uint32_t>(bytes);
      case Type::kFloat:
        return as<float>(bytes);
      case Type::kDouble:
        return as<double>(bytes);
    }
    return damaged("a type is not known");
  }

  absl::string_view rest_;
  Encoding encoding_;
};

struct Header {
  Encoding encoding = Encoding::kText;
  std::vector<Element> elements;
  absl::string_view body;  ///< the bytes after the header
};

/// Adds the property of a header line, given as its words, to the last element of the header.
absl::Status add_property(const std::vector<absl::string_view>& words, Header& header) {
  if (header.elements.empty()) {
    return damaged("a property belongs to no element");
  }
  PlyProperty property;
  if (words.size() == 5 && words[1] == "list") {
    ASSIGN_OR_RETURN(property.count, type_of(words[2]));
    ASSIGN_OR_RETURN(property.type, type_of(words[3]));
  } else if (words.size() == 3) {
    ASSIGN_OR_RETURN(property.type, type_of(words[1]));
  } else {
    return damaged("a property needs a type and a name, or \"list\", two types and a name");
  }
  property.name = std::string(words.back());
  header.elements.back().properties.push_back(property);
  return absl::OkStatus();
}

/// Reads a line that declares the encoding, an element or a property. Skips comments.
absl::Status read_header_line(absl::string_view line, Header& header) {
  const std::vector<absl::string_view> words =
      absl::StrSplit(line, absl::ByAnyChar(" \t"), absl::SkipEmpty());
  if (words.empty() || words[0] == "comment" || words[0] == "obj_info" || words[0] == "ply") {
    return absl::OkStatus();
  }
  if (words[0] == "format" && words.size() == 3) {
    header.encoding = words[1] == "binary_little_endian" ? Encoding::kLittle
                      : words[1] == "binary_big_endian"  ? Encoding::kBig
                                                         : Encoding::kText;
    return header.encoding != Encoding::kText || words[1] == "ascii"
               ? absl::OkStatus()
               : damaged(absl::StrCat("its format is \"", words[1].substr(0, 40), "\""));
  }
  if (words[0] == "element" && words.size() == 3) {
    Element element{std::string(words[1])};
    if (!absl::SimpleAtoi(words[2], &element.count)) {
      return damaged("the count of an element is no number");
    }
    header.elements.push_back(std::move(element));
    return absl::OkStatus();
  }
  return words[0] == "property"
             ? add_property(words, header)
             : damaged(absl::StrCat("its header has \"", words[0].substr(0, 40), "\""));
}

absl::StatusOr<Header> read_header(absl::string_view bytes) {
  if (!absl::StartsWith(bytes, "ply")) {
    return absl::InvalidArgumentError("is not a PLY file");
  }
  constexpr std::size_t kMaxLines = 1000;
  Header header;
  for (std::size_t lines = 0; lines < kMaxLines; ++lines) {
    const std::size_t end = bytes.find('\n');
    if (end == absl::string_view::npos) {
      break;
    }
    const absl::string_view line = absl::StripTrailingAsciiWhitespace(bytes.substr(0, end));
    bytes.remove_prefix(end + 1);
    if (line == "end_header") {
      header.body = bytes;
      return header;
    }
    RETURN_IF_ERROR(read_header_line(line, header));
  }
  return damaged("its header has no end, or more than 1000 lines");
}

/// Groups the numbers of an element: "color_0", "color_1", "color_2" become one attribute "color".
/// Returns the indices of the properties of each group, keyed by the name of the group.
std::map<std::string, std::vector<std::size_t>> groups_of(const Element& element) {
  std::map<std::string, std::vector<std::size_t>> groups;
  for (std::size_t i = 0; i < element.properties.size(); ++i) {
    const std::string& name = element.properties[i].name;
    if (element.properties[i].count) {
      continue;
    }
    const bool color = name == "r" || name == "g" || name == "b" || name == "red" ||
                       name == "green" || name == "blue";
    const std::size_t bar = name.rfind('_');
    groups[color ? "color" : name.substr(0, bar)].push_back(i);
  }
  return groups;
}

template <std::size_t n>
using Columns = std::optional<std::array<std::size_t, n>>;

/// Returns the columns with these names in a row of the element; std::nullopt if one is missing.
template <std::size_t n>
Columns<n> columns_of(const Element& element, const std::array<const char*, n>& names) {
  std::array<std::size_t, n> columns{};
  for (std::size_t k = 0; k < n; ++k) {
    const auto& all = element.properties;
    const auto found = std::find_if(all.begin(), all.end(), [&](const PlyProperty& property) {
      return property.name == names[k] && !property.count;
    });
    if (found == all.end()) {
      return std::nullopt;
    }
    columns[k] = static_cast<std::size_t>(found - all.begin());
  }
  return columns;
}

struct VertexColumns {
  Columns<3> position;
  Columns<3> normal;
  Columns<2> uv;
};

/// Returns the columns of positions, normals and uvs in a row of the element of vertices.
VertexColumns vertex_columns(const Element& element) {
  VertexColumns columns{
      columns_of<3>(element, {"x", "y", "z"}), columns_of<3>(element, {"nx", "ny", "nz"}), {}};
  for (const auto& names : {std::array<const char*, 2>{"u", "v"},
                            {"s", "t"},
                            {"texture_u", "texture_v"},
                            {"texture_s", "texture_t"}}) {
    columns.uv = columns.uv ? columns.uv : columns_of<2>(element, names);
  }
  return columns;
}

/// Appends the numbers in `columns` of `row` to `to`, or nothing if there are no such columns.
/// Returns INVALID_ARGUMENT if a number is not finite.
template <std::size_t n>
absl::Status add_numbers(const Columns<n>& columns, const std::vector<double>& row,
                         std::vector<std::array<float, n>>& to) {
  if (!columns) {
    return absl::OkStatus();
  }
  std::array<float, n> values{};
  for (std::size_t k = 0; k < n; ++k) {
    values[k] = static_cast<float>(row[(*columns)[k]]);
    if (!std::isfinite(values[k])) {
      return damaged("it has a number that is not finite");
    }
  }
  to.push_back(values);
  return absl::OkStatus();
}

/// Reads the elements that the header announces.
class PlyReader {
 public:
  explicit PlyReader(const Header& header)
      : header_(header), numbers_(header.body, header.encoding) {}

  absl::StatusOr<PlyFile> read() {
    for (const Element& element : header_.elements) {
      // The least size of a row in bytes. In text, each number takes a digit and a space.
      std::uint64_t least = 0;
      for (const PlyProperty& property : element.properties) {
        least += numbers_.is_text() ? 2 : size_of(property.count.value_or(property.type));
      }
      // The last number of a text needs no space behind it.
      if (element.count > 0 && !numbers_.may_hold(element.count - 1, least)) {
        return damaged(absl::StrCat("it says that it has ", element.count, " of \"", element.name,
                                    "\", for which it is too short"));
      }
      RETURN_IF_ERROR(read_element(element));
    }
    if (out_.mesh.triangles.empty()) {
      return damaged("it has no triangles");
    }
    for (const auto& triangle : out_.mesh.triangles) {
      for (const std::uint32_t index : triangle) {
        if (index >= out_.mesh.positions.size()) {
          return damaged(absl::StrCat("a triangle refers to vertex ", index,
                                      "; the number of vertices is ", out_.mesh.positions.size()));
        }
      }
    }
    return std::move(out_);
  }

 private:
  /// Reads all rows of an element. Adds vertices and faces, with their attributes, to the result.
  /// Skips the rows of other elements.
  absl::Status read_element(const Element& element) {
    const bool is_vertex = element.name == "vertex";
    const bool is_face = element.name == "face";
    std::vector<MeshAttribute> attributes;
    std::vector<std::vector<std::size_t>> columns;
    if (is_vertex || is_face) {
      for (const auto& [name, members] : groups_of(element)) {
        if ((members.size() == 1 || members.size() == 3) && !is_reserved(name, members, element)) {
          attributes.push_back(
              {absl::StrCat(is_vertex ? "vertex_" : "face_", name), is_face, members.size(), {}});
          columns.push_back(members);
        }
      }
    }
    const VertexColumns vertex = is_vertex ? vertex_columns(element) : VertexColumns{};
    if (is_vertex && !vertex.position) {
      return damaged("its vertices have no x, y and z");
    }
    std::vector<double> row(element.properties.size());
    for (std::uint64_t i = 0; i < element.count; ++i) {
      std::vector<std::uint32_t> corners;
      RETURN_IF_ERROR(read_row(element, row, corners));
      std::size_t copies = 1;  // an attribute of a face is repeated for each of its triangles
      if (is_vertex) {
        RETURN_IF_ERROR(add_vertex(vertex, row));
      } else if (is_face) {
        copies = add_face(corners);
      }
      for (std::size_t a = 0; a < attributes.size(); ++a) {
        for (std::size_t copy = 0; copy < copies; ++copy) {
          for (const std::size_t column : columns[a]) {
            const double scale = element.properties[column].type == Type::kUint8 ? 255 : 1;
            attributes[a].values.push_back(static_cast<float>(row[column] / scale));
          }
        }
      }
    }
    for (MeshAttribute& attribute : attributes) {
      out_.attributes.push_back(std::move(attribute));
    }
    return absl::OkStatus();
  }

  /// Returns true for positions, normals and uvs, which are no attributes.
  static bool is_reserved(const std::string& name, const std::vector<std::size_t>& members,
                          const Element& element) {
    static const std::vector<std::string> names = {"x", "y", "z", "nx", "ny",     "nz",
                                                   "u", "v", "s", "t",  "texture"};
    return element.name == "vertex" && members.size() <= 2 &&
           std::find(names.begin(), names.end(), name) != names.end();
  }

  /// Reads one vertex, face or row of another element. Stores its numbers in `row`, in the order of
  /// the properties, and adds the vertex indices of a face to `corners`.
  absl::Status read_row(const Element& element, std::vector<double>& row,
                        std::vector<std::uint32_t>& corners) {
    constexpr double kMaxCorners = 1e6;
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      const PlyProperty& property = element.properties[i];
      if (!property.count) {
        ASSIGN_OR_RETURN(row[i], numbers_.take(property.type));
        continue;
      }
      ASSIGN_OR_RETURN(const double count, numbers_.take(*property.count));
      if (!(count >= 0 && count <= kMaxCorners)) {
        return damaged(absl::StrCat("a list has ", count, " entries"));
      }
      const bool indices = property.name == "vertex_indices" || property.name == "vertex_index";
      for (double k = 0; k < count; ++k) {
        ASSIGN_OR_RETURN(const double index, numbers_.take(property.type));
        if (indices && !(index >= 0 && index < std::numeric_limits<std::uint32_t>::max())) {
          return damaged(absl::StrCat("a face refers to vertex ", index, ", which cannot exist"));
        }
        if (indices) {
          corners.push_back(static_cast<std::uint32_t>(index));
        }
      }
    }
    return absl::OkStatus();
  }

  absl::Status add_vertex(const VertexColumns& columns, const std::vector<double>& row) {
    RETURN_IF_ERROR(add_numbers(columns.position, row, out_.mesh.positions));
    RETURN_IF_ERROR(add_numbers(columns.normal, row, out_.mesh.normals));
    return add_numbers(columns.uv, row, out_.mesh.uvs);
  }

  /// Divides the polygon into a fan of triangles and adds them. Returns the number of triangles.
  std::size_t add_face(const std::vector<std::uint32_t>& corners) {
    for (std::size_t i = 2; i < corners.size(); ++i) {
      out_.mesh.triangles.push_back({corners[0], corners[i - 1], corners[i]});
    }
    return corners.size() < 3 ? 0 : corners.size() - 2;
  }

  const Header& header_;
  Numbers numbers_;
  PlyFile out_;
};

}  // namespace

absl::StatusOr<PlyFile> read_ply(absl::string_view bytes) {
  ASSIGN_OR_RETURN(const Header header, read_header(bytes));
  return PlyReader(header).read();
}

}  // namespace bandsaw
