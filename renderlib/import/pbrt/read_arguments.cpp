// Reads the arguments of pbrt's directives from the tokens: quoted names, lists of numbers, and
// transforms.

#include "renderlib/import/pbrt/read_arguments.h"

#include <optional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/pbrt/parameters.h"

namespace bandsaw::pbrt {

absl::StatusOr<std::string> read_quoted(Tokens& tokens, const Place& place,
                                        absl::string_view what) {
  ASSIGN_OR_RETURN(std::optional<Token> token, tokens.next());
  if (!token || token->kind != Token::Kind::kString) {
    return error_at(place, absl::StrCat(what, " in quotes is expected"));
  }
  return std::move(token->text);
}

absl::StatusOr<std::vector<double>> read_numbers(Tokens& tokens, const Place& place,
                                                 std::size_t count) {
  std::vector<double> out;
  ASSIGN_OR_RETURN(std::optional<Token> token, tokens.next());
  const bool in_brackets = token && token->kind == Token::Kind::kOpen;
  if (in_brackets) {
    ASSIGN_OR_RETURN(token, tokens.next());
  }
  while (token && token->kind == Token::Kind::kWord) {
    ASSIGN_OR_RETURN(const double number, number_of(*token));
    out.push_back(number);
    if (out.size() == count) {
      break;
    }
    ASSIGN_OR_RETURN(token, tokens.next());
  }
  if (out.size() == count && in_brackets) {
    ASSIGN_OR_RETURN(token, tokens.next());
    if (!token || token->kind != Token::Kind::kClose) {
      out.clear();  // the closing bracket is missing, which is an error
    }
  }
  return out.size() == count ? absl::StatusOr<std::vector<double>>(std::move(out))
                             : error_at(place, absl::StrCat(count, " numbers are expected"));
}

absl::StatusOr<Transform> read_matrix(Tokens& tokens, const Place& place) {
  ASSIGN_OR_RETURN(const std::vector<double> m, read_numbers(tokens, place, 16));
  if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] == 0) {
    return error_at(place,
                    "the last row of the matrix must be 0 0 0 1 or a multiple of it, so that the "
                    "matrix is affine");
  }
  Transform out;
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 4; ++column) {
      out.m[row][column] = m[column * 4 + row] / m[15];
    }
  }
  return out;
}

absl::StatusOr<Transform> read_translation(Tokens& tokens, const Place& place) {
  ASSIGN_OR_RETURN(const auto n, read_numbers(tokens, place, 3));
  return translation({n[0], n[1], n[2]});
}

absl::StatusOr<Transform> read_scaling(Tokens& tokens, const Place& place) {
  ASSIGN_OR_RETURN(const auto n, read_numbers(tokens, place, 3));
  return scaling({n[0], n[1], n[2]});
}

absl::StatusOr<Transform> read_rotation(Tokens& tokens, const Place& place) {
  ASSIGN_OR_RETURN(const auto n, read_numbers(tokens, place, 4));
  const Vec3 axis{n[1], n[2], n[3]};
  if (!(length(axis) > 0)) {
    return error_at(place, "the axis of a rotation must not be zero");
  }
  return rotation(axis, n[0]);
}

absl::StatusOr<Transform> read_look_at(Tokens& tokens, const Place& place) {
  ASSIGN_OR_RETURN(const auto n, read_numbers(tokens, place, 9));
  const Vec3 eye{n[0], n[1], n[2]};
  const Vec3 ahead = Vec3{n[3], n[4], n[5]} - eye;
  const Vec3 up{n[6], n[7], n[8]};
  if (!(length(ahead) > 0) || !(length(cross(up, ahead)) > 1e-9 * length(up) * length(ahead))) {
    return error_at(
        place, "LookAt needs a direction, and an up vector that is not parallel to the direction");
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
  return to_camera ? absl::StatusOr<Transform>(*to_camera)
                   : error_at(place, "LookAt makes a transformation that is singular");
}

}  // namespace bandsaw::pbrt
