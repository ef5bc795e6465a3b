#pragma once

// Curves: properties over time, given by keys. Animations of models and of scene files consist of
// them.

#include <cstddef>
#include <vector>

#include "absl/types/span.h"
#include "renderlib/math/quaternion.h"
#include "renderlib/math/vec.h"

namespace bandsaw {

enum class Interpolation {
  kLinear,  ///< straight from key to key; rotations at constant speed along the shortest arc
  kStep,    ///< each value holds until the next key
  kCubic,   ///< Hermite splines with given tangents (glTF 2.0, appendix C.5)
  kSmooth,  ///< Hermite splines through the values, with the tangents of Catmull and Rom 1974
};

/// A list of numbers over time. Before the first key and after the last one nothing changes.
class Curve {
 public:
  /// `times` strictly increase and are not empty. `values` holds `width` (>= 1) numbers for each
  /// time. For kCubic it holds three groups of `width` numbers for each time: the tangent before
  /// the key, the value, and the tangent after the key.
  Curve(std::vector<double> times, std::vector<double> values, std::size_t width,
        Interpolation interpolation);

  std::size_t width() const { return width_; }
  const std::vector<double>& times() const { return times_; }
  Interpolation interpolation() const { return interpolation_; }

  /// Returns the `width()` numbers at a time.
  std::vector<double> at(double time) const;
  /// Returns the first three numbers; the width MUST be 3.
  Vec3 vec3_at(double time) const;
  /// Returns the unit quaternion of the numbers x, y, z, w; the width MUST be 4. Keys of length 0
  /// stand for no rotation.
  Quaternion rotation_at(double time) const;
  /// Returns true if the value is the same at all times of [from, to].
  bool rests(double from, double to) const;

 private:
  /// The two keys around a time; `next` equals `key` before the first key and after the last one.
  struct Place {
    std::size_t key = 0;
    std::size_t next = 0;
    double share = 0;  ///< position in the interval, [0, 1)
  };
  Place place_of(double time) const;
  /// Returns the `width()` numbers of the value at a key.
  absl::Span<const double> value(std::size_t key) const;
  /// Returns the change per unit of time of a value's number `number`, before or after a key.
  double tangent(std::size_t key, std::size_t number, bool before) const;

  std::vector<double> times_;
  std::vector<double> values_;
  std::size_t width_;
  Interpolation interpolation_;
};

}  // namespace bandsaw
