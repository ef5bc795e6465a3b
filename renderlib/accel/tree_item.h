#pragma once

// What a build sorts: boxes with a name, each as eight floats.

#include <array>
#include <cstdint>

#include "renderlib/accel/float_box.h"
#include "renderlib/accel/wide_tree.h"
#include "renderlib/base/huge_vector.h"
#include "renderlib/base/simd.h"

namespace bandsaw {

/// The caller's name for an item.
struct ItemRef {
  std::uint32_t index;
  LeafKind kind;
};

/// 32 bytes that are one Float8: the box's corners are where LaneBox has them.
struct TreeItem {
  std::array<float, 3> lo;
  std::uint32_t index;
  std::array<float, 3> hi;
  LeafKind kind;

  TreeItem() = default;
  TreeItem(const FloatBox& box, std::uint32_t name, LeafKind what = LeafKind::kFlats)
      : lo(box.lo), index(name), hi(box.hi), kind(what) {}
  /// Neither empty nor infinite.
  bool can_be_hit() const { return FloatBox{lo, hi}.can_be_hit(); }
};

using TreeItems = HugeVector<TreeItem>;

/// A box as -lo in lanes 0 to 2 and hi in lanes 4 to 6, so that a union is one max. Lanes 3 and 7
/// hold anything, an index for one: numbers that may be denormal, which are slow in products.
class LaneBox {
 public:
  LaneBox() : lanes_(-FloatBox::kInf) {}
  static LaneBox of(Float8 item) { return LaneBox(flip_by_sign(item, low())); }

  void add(const LaneBox& other) { lanes_ = max(lanes_, other.lanes_); }
  FloatBox box() const {
    const Lanes v = stored(lanes_);
    // Plus zero, whichever of two zeros the order of unions has left.
    return {{0 - v[0], 0 - v[1], 0 - v[2]}, {v[4] + 0, v[5] + 0, v[6] + 0}};
  }
  /// Half the surface; infinite or NaN when empty. Double, since products of floats leave float's
  /// range.
  double area() const {
    const Lanes size = stored(lanes_ + swap_halves(lanes_));
    const double x = size[0];
    const double y = size[1];
    const double z = size[2];
    return x * y + y * z + z * x;
  }

 private:
  using Lanes = std::array<float, 8>;
  explicit LaneBox(Float8 lanes) : lanes_(lanes) {}
  static Float8 low() {
    static constexpr Lanes kLow = {-0.0f, -0.0f, -0.0f, 0, 0, 0, 0, 0};
    return Float8::load(kLow.data());
  }
  static Lanes stored(Float8 v) {
    Lanes lanes;
    v.store(lanes.data());
    return lanes;
  }

  Float8 lanes_;
};

/// Twice the centre, in lanes 0 to 2 and again in 4 to 6.
inline Float8 twice_centre(Float8 item) { return item + swap_halves(item); }

}  // namespace bandsaw
