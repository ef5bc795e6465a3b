#pragma once

// A BVH is built from items: boxes with an index, each as eight floats. An item stands for a
// triangle, another shape, half of a quad, or an instance.

#include <array>
#include <cstdint>

#include "renderlib/accel/float_box.h"
#include "renderlib/accel/wide_tree.h"
#include "renderlib/base/huge_vector.h"
#include "renderlib/base/simd.h"

namespace bandsaw {

/// Names what an item stands for. The caller of the build defines the meaning of `index`.
struct ItemRef {
  std::uint32_t index;
  LeafKind kind;
};

/// 32 bytes that are loaded as one Float8; the box's corners are in the same lanes as in LaneBox.
struct TreeItem {
  std::array<float, 3> lo;
  std::uint32_t index;
  std::array<float, 3> hi;
  LeafKind kind;

  TreeItem() = default;
  TreeItem(const FloatBox& box, std::uint32_t name, LeafKind what = LeafKind::kFlats)
      : lo(box.lo), index(name), hi(box.hi), kind(what) {}
  /// Returns true if the box is neither empty nor infinite.
  bool can_be_hit() const { return FloatBox{lo, hi}.can_be_hit(); }
};

using TreeItems = HugeVector<TreeItem>;

/// A box as -lo in lanes 0 to 2 and hi in lanes 4 to 6, so that a union is a single max. Lanes 3
/// and 7 are unspecified: they may hold the bits of an index. Read as a float, these bits may be a
/// denormal number, and products of denormal numbers are slow.
class LaneBox {
 public:
  LaneBox() : lanes_(-FloatBox::kInf) {}
  /// `item` has lo in lanes 0 to 2 and hi in lanes 4 to 6, as TreeItem and twice_centre() have.
  static LaneBox of(Float8 item) { return LaneBox(flip_by_sign(item, low())); }

  void add(const LaneBox& other) { lanes_ = max(lanes_, other.lanes_); }
  FloatBox box() const {
    const Lanes v = stored(lanes_);
    // Adding zero removes the sign of a zero, which depends on the order of unions.
    return {{0 - v[0], 0 - v[1], 0 - v[2]}, {v[4] + 0, v[5] + 0, v[6] + 0}};
  }
  /// Returns half the surface area; infinite or NaN if empty. It is computed in double, because
  /// products of floats may overflow.
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
  /// Has the sign bit set in lanes 0 to 2, so that flip_by_sign() negates only `lo` of an item.
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

/// Returns twice the centre of a TreeItem's box, in lanes 0 to 2 and again in 4 to 6.
inline Float8 twice_centre(Float8 item) { return item + swap_halves(item); }

}  // namespace bandsaw
