#pragma once

// Holds and reads the parameters of a pbrt directive, such as "float radius" [ 2 ].

#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "renderlib/import/pbrt/tokens.h"
#include "renderlib/math/vec.h"

namespace bandsaw::pbrt {

/// Maximum number of parameters of a directive, and of values of one parameter.
inline constexpr std::size_t kMaxParameters = 1000;
inline constexpr std::size_t kMaxValues = 400'000'000;

struct Parameter {
  std::string type;  ///< "float", "rgb", "texture" …
  std::string name;
  Place place;
  std::vector<double> numbers = {};     ///< values of number types; bools are 0 and 1
  std::vector<std::string> texts = {};  ///< values of "string", "texture" and named "spectrum"
  mutable bool is_used = false;         ///< set by the accessors; unused parameters cause warnings
};

/// Parameters by name. The error is INVALID_ARGUMENT, with file and line, for values of a wrong
/// type and for a wrong number of values.
class Parameters {
 public:
  std::vector<Parameter> list;
  Place place;  ///< place of the directive

  /// Adds each of the `defaults` whose name is not in the list. The added parameters count as used.
  void add_defaults(const std::vector<Parameter>& defaults);

  /// Returns a parameter of any type, marked as used; nullptr: there is none.
  const Parameter* find(const std::string& name) const;

  /// Each of these functions returns the value of the parameter `name`. If the parameter is absent,
  /// they return `otherwise` or std::nullopt.
  absl::StatusOr<double> number(const std::string& name, double otherwise) const;
  absl::StatusOr<std::optional<double>> number(const std::string& name) const;
  absl::StatusOr<int> integer(const std::string& name, int otherwise) const;
  absl::StatusOr<bool> boolean(const std::string& name, bool otherwise) const;
  absl::StatusOr<std::string> text(const std::string& name, const std::string& otherwise) const;
  absl::StatusOr<Vec3> point(const std::string& name, const Vec3& otherwise) const;
  /// Returns the numbers of the parameter `name`; an empty list if it is absent. The error is
  /// INVALID_ARGUMENT if its type is not in `types`, or if the number of values is not a multiple
  /// of `group`.
  absl::StatusOr<std::vector<double>> numbers(const std::string& name,
                                              std::initializer_list<const char*> types,
                                              std::size_t group = 1) const;
  /// Returns the strings of the parameter `name`; an empty list if it is absent.
  absl::StatusOr<std::vector<std::string>> texts(const std::string& name) const;
  /// Marks the parameters with these names as used, because they change nothing in Bandsaw's image.
  void ignore(std::initializer_list<const char*> names) const;
};

/// Reads the parameters that follow a directive at `place`.
absl::StatusOr<Parameters> read_parameters(Tokens& tokens, const Place& place);

/// Returns the token's number. The error is INVALID_ARGUMENT if it is no number, or not finite.
absl::StatusOr<double> number_of(const Token& token);

}  // namespace bandsaw::pbrt
