#pragma once

// Reads those arguments of directives that are not parameters: names, numbers and transformations.
// Errors are INVALID_ARGUMENT and name a file and a line. `place` is the place of the directive.
// The error for a number that is broken or not finite names the place of the number instead.

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "renderlib/import/pbrt/place.h"
#include "renderlib/import/pbrt/tokens.h"
#include "renderlib/math/transform.h"

namespace bandsaw::pbrt {

/// Reads a text in quotes. If there is none, the error says what is expected: `what` ("a name").
absl::StatusOr<std::string> read_quoted(Tokens& tokens, const Place& place, absl::string_view what);
/// Reads `count` numbers, which may stand in brackets.
absl::StatusOr<std::vector<double>> read_numbers(Tokens& tokens, const Place& place,
                                                 std::size_t count);

/// Reads a matrix of 16 numbers, column by column.
absl::StatusOr<Transform> read_matrix(Tokens& tokens, const Place& place);
/// Reads three numbers: the translation along x, y and z.
absl::StatusOr<Transform> read_translation(Tokens& tokens, const Place& place);
/// Reads three numbers: the factors along x, y and z.
absl::StatusOr<Transform> read_scaling(Tokens& tokens, const Place& place);
/// Reads an angle in degrees and an axis.
absl::StatusOr<Transform> read_rotation(Tokens& tokens, const Place& place);
/// Reads the position of a camera, the point at which it looks, and its up vector. Returns the
/// transformation from the world to the camera.
absl::StatusOr<Transform> read_look_at(Tokens& tokens, const Place& place);

}  // namespace bandsaw::pbrt
