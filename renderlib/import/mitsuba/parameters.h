#pragma once

// Reads the parameters of one object of a Mitsuba scene by name and type.

#include <set>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "renderlib/import/mitsuba/scene_tree.h"

namespace bandsaw::mitsuba {

/// Reads the parameters of `object`, which MUST outlive this object. Each function that takes a
/// name or a tag also marks the parameters that it finds as read.
class Parameters {
 public:
  explicit Parameters(const Object& object) : object_(object) {}

  const Object& object() const { return object_; }
  const Place& place() const { return object_.place; }

  /// Returns the parameter, or nullptr. If several have this name, the last one counts.
  const Property* find(const std::string& name) const;
  bool has(const std::string& name) const { return find(name) != nullptr; }

  /// number() to vector() return the value of the parameter, or `otherwise` if there is none. They
  /// return INVALID_ARGUMENT with the parameter's place if the parameter has another type.
  absl::StatusOr<double> number(const std::string& name, double otherwise) const;
  absl::StatusOr<std::int64_t> integer(const std::string& name, std::int64_t otherwise) const;
  absl::StatusOr<bool> boolean(const std::string& name, bool otherwise) const;
  absl::StatusOr<std::string> text(const std::string& name, const std::string& otherwise) const;
  absl::StatusOr<Vec3> vector(const std::string& name, const Vec3& otherwise) const;
  /// Returns the identity if there is no such parameter.
  absl::StatusOr<Transform> transform(const std::string& name) const;

  /// Returns the parameters that are objects of this tag, whatever their names, in their order.
  std::vector<const Property*> objects(const std::string& tag) const;

  /// Marks the parameters `names` as read. Used for parameters that have no effect
  /// on Bandsaw's picture.
  void ignore(std::initializer_list<const char*> names) const;
  /// Returns the parameters that were not read.
  std::vector<const Property*> unused() const;

 private:
  const Object& object_;
  mutable std::set<const Property*> used_;
};

}  // namespace bandsaw::mitsuba
