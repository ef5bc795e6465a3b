#pragma once

// The objects of a Mitsuba scene file, as read_scene_tree() returns them. Includes have been read,
// parameters replaced and references resolved. Objects of all kinds have the type Object.

#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "absl/status/status.h"
#include "renderlib/math/rgb.h"
#include "renderlib/math/transform.h"
#include "renderlib/math/vec.h"

namespace bandsaw::mitsuba {

/// A place in a file, for errors and warnings.
struct Place {
  const std::string* file = nullptr;  ///< name of the file, below the scene's folder
  int line = 0;                       ///< counted from 1
};

/// Returns "scene.xml:12".
std::string text_of(const Place& place);
/// Returns INVALID_ARGUMENT: "scene.xml:12: <what>".
absl::Status error_at(const Place& place, const std::string& what);
/// Returns the error `why` with the place before its message, unless the message begins with a
/// place in the same file.
absl::Status at_place(const Place& place, const absl::Status& why);

struct Object;

/// A spectrum: values at increasing wavelengths, or the same value everywhere.
struct Spectrum {
  double constant = 0;  ///< the value at all wavelengths; used only if there are no samples
  struct Sample {
    double nanometres = 0;
    double value = 0;
  };
  std::vector<Sample> samples = {};  ///< none, or at least two
};

/// A black body: the spectrum of its temperature in Kelvin, times `scale`.
struct BlackBody {
  double kelvin = 0;
  double scale = 1;
};

using Value = std::variant<double, std::int64_t, bool, std::string, Vec3, Rgb, Spectrum, BlackBody,
                           Transform, const Object*>;

struct Property {
  std::string name;  ///< in lower case with underscores; empty for an object without a name
  Value value;
  Place place;
};

/// Returns the property's object, or nullptr if its value is something else.
inline const Object* object_in(const Property& property) {
  const auto* const* object = std::get_if<const Object*>(&property.value);
  return object != nullptr ? *object : nullptr;
}

/// A plugin of Mitsuba with its parameters, in the order of the file. Several objects may contain
/// the same object, by references.
struct Object {
  std::string tag;   ///< "bsdf", "shape", …
  std::string type;  ///< "diffuse", "obj", …
  std::string id;    ///< empty if it has none
  Place place;
  std::vector<Property> properties = {};
};

struct SceneTree {
  const Object* root = nullptr;
  bool is_old = false;         ///< the scene's version is 0.x, not 2 or 3
  std::deque<Object> objects;  ///< all objects; `root` and properties point to them
  std::vector<std::unique_ptr<std::string>> files;  ///< names of the files, for Place::file
  std::vector<std::string> warnings;                ///< warnings about elements that are not known
};

/// How deep elements may be nested, and how deep objects may contain or refer to objects.
inline constexpr int kMaxNesting = 50;

}  // namespace bandsaw::mitsuba
