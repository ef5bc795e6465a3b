// A curve holds numbers that change over time and are given at keys. To evaluate it, this file
// finds the two keys around a time and interpolates between them by the curve's rule.

#include "renderlib/import/animation/curve.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "renderlib/base/check.h"

namespace bandsaw {
namespace {

/// Returns the quaternion divided by its length; the identity if its length is 0 or not finite.
Quaternion unit(absl::Span<const double> xyzw) {
  const double size =
      std::sqrt(xyzw[0] * xyzw[0] + xyzw[1] * xyzw[1] + xyzw[2] * xyzw[2] + xyzw[3] * xyzw[3]);
  return size > 0 && std::isfinite(size)
             ? Quaternion{xyzw[3] / size, xyzw[0] / size, xyzw[1] / size, xyzw[2] / size}
             : Quaternion{};
}

}  // namespace

Curve::Curve(std::vector<double> times, std::vector<double> values, std::size_t width,
             Interpolation interpolation)
    : times_(std::move(times)),
      values_(std::move(values)),
      width_(width),
      interpolation_(interpolation) {
  const std::size_t per_key = interpolation == Interpolation::kCubic ? 3 * width : width;
  BANDSAW_CHECK(!times_.empty() && width >= 1 && values_.size() == times_.size() * per_key,
                "a curve has a value for each of its keys");
}

Curve::Place Curve::place_of(double time) const {
  const auto after = std::upper_bound(times_.begin(), times_.end(), time);
  if (after == times_.begin()) {
    return {};
  }
  const auto key = static_cast<std::size_t>(after - times_.begin()) - 1;
  if (after == times_.end()) {
    return {key, key, 0};
  }
  return {key, key + 1, (time - times_[key]) / (times_[key + 1] - times_[key])};
}

/// Returns the numbers of a key. For kCubic, `values_` holds three groups of numbers for each key:
/// the tangent before the key, the value, and the tangent after the key.
absl::Span<const double> Curve::value(std::size_t key) const {
  const bool cubic = interpolation_ == Interpolation::kCubic;
  const std::size_t first = cubic ? (3 * key + 1) * width_ : key * width_;
  return absl::MakeConstSpan(values_).subspan(first, width_);
}

/// Returns the change of component `number` per unit of time at a key. For kCubic the curve stores
/// two tangents of each key: one before the key (`before` is true) and one after it. For kSmooth a
/// key has one tangent, that of Catmull and Rom.
double Curve::tangent(std::size_t key, std::size_t number, bool before) const {
  if (interpolation_ == Interpolation::kCubic) {
    return values_[(3 * key + (before ? 0 : 2)) * width_ + number];
  }
  const std::size_t a = key == 0 ? 0 : key - 1;
  const std::size_t b = std::min(key + 1, times_.size() - 1);
  return (value(b)[number] - value(a)[number]) / (times_[b] - times_[a]);
}

std::vector<double> Curve::at(double time) const {
  const Place place = place_of(time);
  const absl::Span<const double> from = value(place.key);
  std::vector<double> out(from.begin(), from.end());
  if (place.key == place.next || interpolation_ == Interpolation::kStep) {
    return out;
  }
  const absl::Span<const double> to = value(place.next);
  const double u = place.share;
  for (std::size_t i = 0; i < width_; ++i) {
    if (interpolation_ == Interpolation::kLinear) {
      out[i] += u * (to[i] - from[i]);
      continue;
    }
    // A cubic Hermite spline (glTF 2.0, appendix C.5).
    const double length = times_[place.next] - times_[place.key];
    const double leaving = length * tangent(place.key, i, /*before=*/false);
    const double arriving = length * tangent(place.next, i, /*before=*/true);
    out[i] = (2 * u * u * u - 3 * u * u + 1) * from[i] + (u * u * u - 2 * u * u + u) * leaving +
             (3 * u * u - 2 * u * u * u) * to[i] + (u * u * u - u * u) * arriving;
  }
  return out;
}

Vec3 Curve::vec3_at(double time) const {
  const std::vector<double> v = at(time);
  return {v[0], v[1], v[2]};
}

Quaternion Curve::rotation_at(double time) const {
  if (interpolation_ != Interpolation::kLinear) {
    return unit(at(time));
  }
  const Place place = place_of(time);
  const Quaternion from = unit(value(place.key));
  return place.key == place.next ? from : slerp(from, unit(value(place.next)), place.share);
}

bool Curve::rests(double from, double to) const {
  if (!(from < to)) {
    return true;
  }
  const Place first = place_of(from);
  const Place last = place_of(to);
  const bool has_tangents =
      interpolation_ == Interpolation::kCubic || interpolation_ == Interpolation::kSmooth;
  for (std::size_t key = first.key; key < last.next; ++key) {
    if (value(key) != value(key + 1)) {
      return false;
    }
    for (std::size_t i = 0; has_tangents && i < width_; ++i) {
      if (tangent(key, i, /*before=*/false) != 0 || tangent(key + 1, i, /*before=*/true) != 0) {
        return false;
      }
    }
  }
  return true;
}

}  // namespace bandsaw
