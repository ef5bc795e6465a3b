// Finds a parameter of an object of a Mitsuba scene by its name, checks its type, and remembers
// that it was read.

#include "renderlib/import/mitsuba/parameters.h"

#include "absl/strings/str_cat.h"

namespace bandsaw::mitsuba {
namespace {

absl::Status wrong_type(const Property& property, const char* type) {
  return error_at(property.place, absl::StrCat("parameter \"", property.name, "\" must be ", type));
}

}  // namespace

const Property* Parameters::find(const std::string& name) const {
  const Property* found = nullptr;
  for (const Property& property : object_.properties) {
    if (property.name == name) {
      used_.insert(&property);
      found = &property;
    }
  }
  return found;
}

absl::StatusOr<double> Parameters::number(const std::string& name, double otherwise) const {
  const Property* property = find(name);
  if (property == nullptr) {
    return otherwise;
  }
  if (const auto* value = std::get_if<double>(&property->value)) {
    return *value;
  }
  if (const auto* value = std::get_if<std::int64_t>(&property->value)) {
    return static_cast<double>(*value);
  }
  // A spectrum without samples is constant, so it is a number.
  if (const auto* value = std::get_if<Spectrum>(&property->value);
      value != nullptr && value->samples.empty()) {
    return value->constant;
  }
  return wrong_type(*property, "a number");
}

absl::StatusOr<std::int64_t> Parameters::integer(const std::string& name,
                                                 std::int64_t otherwise) const {
  const Property* property = find(name);
  if (property == nullptr) {
    return otherwise;
  }
  const auto* value = std::get_if<std::int64_t>(&property->value);
  return value != nullptr ? absl::StatusOr<std::int64_t>(*value)
                          : wrong_type(*property, "a whole number (<integer>)");
}

absl::StatusOr<bool> Parameters::boolean(const std::string& name, bool otherwise) const {
  const Property* property = find(name);
  if (property == nullptr) {
    return otherwise;
  }
  const auto* value = std::get_if<bool>(&property->value);
  return value != nullptr ? absl::StatusOr<bool>(*value)
                          : wrong_type(*property, "true or false (<boolean>)");
}

absl::StatusOr<std::string> Parameters::text(const std::string& name,
                                             const std::string& otherwise) const {
  const Property* property = find(name);
  if (property == nullptr) {
    return otherwise;
  }
  const auto* value = std::get_if<std::string>(&property->value);
  return value != nullptr ? absl::StatusOr<std::string>(*value)
                          : wrong_type(*property, "text (<string>)");
}

absl::StatusOr<Vec3> Parameters::vector(const std::string& name, const Vec3& otherwise) const {
  const Property* property = find(name);
  if (property == nullptr) {
    return otherwise;
  }
  const auto* value = std::get_if<Vec3>(&property->value);
  return value != nullptr ? absl::StatusOr<Vec3>(*value)
                          : wrong_type(*property, "a <vector> or <point>");
}

absl::StatusOr<Transform> Parameters::transform(const std::string& name) const {
  const Property* property = find(name);
  if (property == nullptr) {
    return Transform{};
  }
  const auto* value = std::get_if<Transform>(&property->value);
  return value != nullptr ? absl::StatusOr<Transform>(*value)
                          : wrong_type(*property, "a <transform>");
}

std::vector<const Property*> Parameters::objects(const std::string& tag) const {
  std::vector<const Property*> found;
  for (const Property& property : object_.properties) {
    const auto* const* child = std::get_if<const Object*>(&property.value);
    if (child != nullptr && (*child)->tag == tag) {
      used_.insert(&property);
      found.push_back(&property);
    }
  }
  return found;
}

void Parameters::ignore(std::initializer_list<const char*> names) const {
  for (const char* name : names) {
    find(name);
  }
}

std::vector<const Property*> Parameters::unused() const {
  std::vector<const Property*> unused;
  for (const Property& property : object_.properties) {
    if (used_.count(&property) == 0) {
      unused.push_back(&property);
    }
  }
  return unused;
}

}  // namespace bandsaw::mitsuba
