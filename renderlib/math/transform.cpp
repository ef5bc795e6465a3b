// Implements affine maps. The inverse is the transposed cofactor matrix over the determinant, after
// a scaling by a power of two.

#include "renderlib/math/transform.h"

#include <cmath>

#include "renderlib/math/elementary.h"
#include "renderlib/math/fused.h"

namespace bandsaw {
namespace {

/// If the condition number of a map is larger, rays that are transformed by the map and back lose
/// their precision.
constexpr double kMaxCondition = 1e12;

using Matrix3 = std::array<std::array<double, 3>, 3>;

/// Returns a b - c d with an error of at most 1.5 units in the last place (Kahan).
double difference_of_products(double a, double b, double c, double d) {
  const double cd = c * d;
  const double error = product_error(-c, d, -cd);
  return fused(a, b, -cd) + error;
}

Matrix3 linear_part(const Transform& t) {
  Matrix3 m;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      m[i][j] = t.m[i][j];
    }
  }
  return m;
}

Matrix3 cofactors(const Matrix3& m) {
  Matrix3 c;
  for (int i = 0; i < 3; ++i) {
    const int i1 = (i + 1) % 3;
    const int i2 = (i + 2) % 3;
    for (int j = 0; j < 3; ++j) {
      const int j1 = (j + 1) % 3;
      const int j2 = (j + 2) % 3;
      c[i][j] = difference_of_products(m[i1][j1], m[i2][j2], m[i1][j2], m[i2][j1]);
    }
  }
  return c;
}

double determinant(const Matrix3& m, const Matrix3& c) {
  return m[0][0] * c[0][0] + m[0][1] * c[0][1] + m[0][2] * c[0][2];
}

double frobenius(const Matrix3& m) {
  double sum = 0;
  for (const auto& row : m) {
    for (const double v : row) {
      sum += v * v;
    }
  }
  return std::sqrt(sum);
}

double largest(const Matrix3& m) {
  double result = 0;
  for (const auto& row : m) {
    for (const double v : row) {
      result = std::abs(v) <= result ? result : std::abs(v);
    }
  }
  return result;
}

}  // namespace

Vec3 Transform::point(const Vec3& p) const {
  return {m[0][0] * p.x + m[0][1] * p.y + m[0][2] * p.z + m[0][3],
          m[1][0] * p.x + m[1][1] * p.y + m[1][2] * p.z + m[1][3],
          m[2][0] * p.x + m[2][1] * p.y + m[2][2] * p.z + m[2][3]};
}

Vec3 Transform::direction(const Vec3& d) const {
  return {m[0][0] * d.x + m[0][1] * d.y + m[0][2] * d.z,
          m[1][0] * d.x + m[1][1] * d.y + m[1][2] * d.z,
          m[2][0] * d.x + m[2][1] * d.y + m[2][2] * d.z};
}

Transform operator*(const Transform& a, const Transform& b) {
  Transform result;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 4; ++j) {
      result.m[i][j] = a.m[i][0] * b.m[0][j] + a.m[i][1] * b.m[1][j] + a.m[i][2] * b.m[2][j] +
                       (j == 3 ? a.m[i][3] : 0);
    }
  }
  return result;
}

Transform translation(const Vec3& by) {
  Transform t;
  t.m[0][3] = by.x;
  t.m[1][3] = by.y;
  t.m[2][3] = by.z;
  return t;
}

Transform scaling(const Vec3& by) {
  Transform t;
  t.m[0][0] = by.x;
  t.m[1][1] = by.y;
  t.m[2][2] = by.z;
  return t;
}

Transform rotation(const Vec3& axis, double degrees) {
  const Vec3 a = normalize(axis / max_abs(axis));
  const auto [s, c] = sincos_degrees(degrees);
  const double k = 1 - c;
  Transform t;
  t.m[0] = {c + a.x * a.x * k, a.x * a.y * k - a.z * s, a.x * a.z * k + a.y * s, 0};
  t.m[1] = {a.y * a.x * k + a.z * s, c + a.y * a.y * k, a.y * a.z * k - a.x * s, 0};
  t.m[2] = {a.z * a.x * k - a.y * s, a.z * a.y * k + a.x * s, c + a.z * a.z * k, 0};
  return t;
}

double determinant(const Transform& t) {
  const Matrix3 m = linear_part(t);
  return determinant(m, cofactors(m));
}

std::optional<Transform> inverse(const Transform& t) {
  Matrix3 m = linear_part(t);
  const double size = largest(m);
  if (!(size > 0) || !std::isfinite(size)) {
    return std::nullopt;
  }
  // A power of two scales the entries close to 1, so that the determinant neither overflows nor
  // underflows.
  const int exponent = std::ilogb(size);
  for (auto& row : m) {
    for (double& v : row) {
      v = std::ldexp(v, -exponent);
    }
  }
  const Matrix3 c = cofactors(m);
  const double det = determinant(m, c);
  // The condition number is |M| |M^-1| in Frobenius norms.
  if (!(frobenius(m) * frobenius(c) <= kMaxCondition * std::abs(det)) || det == 0) {
    return std::nullopt;
  }
  Transform result;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      result.m[i][j] = std::ldexp(c[j][i] / det, -exponent);
    }
  }
  const Vec3 moved = -result.direction({t.m[0][3], t.m[1][3], t.m[2][3]});
  result.m[0][3] = moved.x;
  result.m[1][3] = moved.y;
  result.m[2][3] = moved.z;
  if (!is_finite(moved) || !std::isfinite(largest(linear_part(result)))) {
    return std::nullopt;
  }
  return result;
}

Vec3 normal_to_world(const Transform& inverse, const Vec3& n) {
  const auto& m = inverse.m;
  return {m[0][0] * n.x + m[1][0] * n.y + m[2][0] * n.z,
          m[0][1] * n.x + m[1][1] * n.y + m[2][1] * n.z,
          m[0][2] * n.x + m[1][2] * n.y + m[2][2] * n.z};
}

}  // namespace bandsaw
