// Tests the float filters of the BVH. A filter tests eight triangles, spheres or boxes at once, one
// in each lane of a Float8 (a vector of eight floats). The exact test in double follows only for
// the lanes that the filter does not reject. A filter must never reject what the test in double
// hits, and must give the same lanes with every implementation of Float8.

#include <cmath>

#include "renderlib/accel/sphere_pack.h"
#include "renderlib/accel/traverse.h"
#include "renderlib/base/simd_plain.h"
#include "renderlib/geometry/intersect.h"
#include "tests/unit/accel/agreement.h"

namespace bandsaw::test {
namespace {

using Corner = std::array<double, 3>;

/// Returns a number of about 10^lo to 10^hi, whose logarithm is about uniform. log2(10) is 3.32.
double magnitude(Random& random, double lo, double hi) {
  return std::ldexp(random.uniform(1, 2), static_cast<int>(random.uniform(lo, hi) * 3.32));
}

/// Float8 whose fused operations round twice, as in WebAssembly (base/simd_wasm.h).
class TwiceRounded {
 public:
  using F = simd_plain::Float8;
  TwiceRounded() = default;
  explicit TwiceRounded(float all) : v_(all) {}
  static TwiceRounded load(const float* from) { return TwiceRounded(F::load(from)); }
  friend TwiceRounded operator+(const TwiceRounded& a, const TwiceRounded& b) {
    return TwiceRounded(a.v_ + b.v_);
  }
  friend TwiceRounded operator-(const TwiceRounded& a, const TwiceRounded& b) {
    return TwiceRounded(a.v_ - b.v_);
  }
  friend TwiceRounded operator*(const TwiceRounded& a, const TwiceRounded& b) {
    return TwiceRounded(a.v_ * b.v_);
  }
  friend TwiceRounded about_fused(const TwiceRounded& a, const TwiceRounded& b,
                                  const TwiceRounded& c) {
    return a * b + c;
  }
  friend TwiceRounded about_fused_minus(const TwiceRounded& a, const TwiceRounded& b,
                                        const TwiceRounded& c) {
    return a * b - c;
  }
  friend TwiceRounded min(const TwiceRounded& a, const TwiceRounded& b) {
    return TwiceRounded(min(a.v_, b.v_));
  }
  friend TwiceRounded max(const TwiceRounded& a, const TwiceRounded& b) {
    return TwiceRounded(max(a.v_, b.v_));
  }
  friend TwiceRounded abs(const TwiceRounded& a) { return TwiceRounded(abs(a.v_)); }
  friend TwiceRounded flip_by_sign(const TwiceRounded& a, const TwiceRounded& sign) {
    return TwiceRounded(flip_by_sign(a.v_, sign.v_));
  }
  friend simd_plain::Mask8 operator<(const TwiceRounded& a, const TwiceRounded& b) {
    return a.v_ < b.v_;
  }
  friend simd_plain::Mask8 operator<=(const TwiceRounded& a, const TwiceRounded& b) {
    return a.v_ <= b.v_;
  }

 private:
  explicit TwiceRounded(const F& v) : v_(v) {}
  F v_;
};

/// A triangle and a ray. The triangle may be a sliver, distant, or both. The ray aims at a corner,
/// at an edge, at a point near one of these, or at any point of the triangle.
struct Pair {
  std::array<Corner, 3> corner;
  TracedRay ray;
};

/// Returns a random pair. `in_float`: the corners are rounded to float.
Pair adversarial_pair(Random& random, bool in_float) {
  Pair pair;
  const Vec3 at = magnitude(random, -3, 6) * random_point(random);
  const double size = magnitude(random, -5, 2);
  Vec3 corner[3];
  for (Vec3& c : corner) {
    c = at + size * random_point(random);
  }
  if (random.below(3) == 0) {
    corner[2] = lerp(corner[0], corner[1], random.uniform()) +
                magnitude(random, -8, -1) * size * random_point(random);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      const double x = corner[i][k];
      pair.corner[i][static_cast<std::size_t>(k)] = in_float ? double{static_cast<float>(x)} : x;
    }
  }
  const auto point = [&](std::size_t i) {
    return Vec3{pair.corner[i][0], pair.corner[i][1], pair.corner[i][2]};
  };
  const Vec3 origin = at + magnitude(random, -4, 5) * random_point(random);
  const double s = random.uniform();
  Vec3 target = random.below(2) == 0 ? point(0) : lerp(point(0), point(1), s);
  if (random.below(3) == 0) {
    target = target + s * random.uniform() * (point(2) - target);
  }
  if (random.below(3) == 0) {
    target = target + magnitude(random, -9, -5) * size * random_point(random);
  }
  Vec3 direction = target - origin;
  direction = max_abs(direction) > 0 ? direction : Vec3{1, 0, 0};
  const double length = std::ldexp(1.0, static_cast<int>(random.below(80)) - 40);
  pair.ray = trace_setup(origin, length * direction, kInfinity);
  return pair;
}

/// Counts how often the test in double found a hit, how often the filter was sure of a hit, and how
/// often the filter was wrong.
struct Verdicts {
  int hits = 0;
  int sure = 0;
  int false_rejects = 0;  ///< hits that the filter rejected
  int false_sure = 0;     ///< the filter was sure of a hit, but the test in double found none
};

/// Runs the filter and the test in double, and adds their results to `verdicts`. The ray has no
/// end, or it ends at the hit, just before the hit, or just after the hit. `reach`: bound of the
/// absolute values of all coordinates.
template <class Float>
void judge(const FlatPack& pack, const Pair& pair, double reach, Verdicts& verdicts) {
  Crossing crossing;
  const bool hit =
      intersect_triangle(pair.ray, pair.corner[0], pair.corner[1], pair.corner[2], crossing);
  const FloatRay floats(pair.ray, static_cast<float>(reach));
  const double t = hit ? crossing.t : 1;
  for (const double end : {kInfinity, t * (1 + 1e-6), t, t * (1 - 1e-6)}) {
    const FlatLanes lanes = filter_flats<Float>(pack, floats, floats.above(end), floats.below(end));
    const bool counts = hit && t < end;
    verdicts.hits += counts ? 1 : 0;
    verdicts.sure += lanes.surely != 0 ? 1 : 0;
    // A hit at exactly the end of the ray must not be rejected either: if two hits are at the
    // same distance, the one with the lower id counts.
    verdicts.false_rejects += hit && t <= end && lanes.maybe == 0 ? 1 : 0;
    verdicts.false_sure += lanes.surely != 0 && !counts ? 1 : 0;
  }
}

FlatPacker::Corners to_float(const std::array<Corner, 3>& corner) {
  FlatPacker::Corners result;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      result[i][k] = static_cast<float>(corner[i][k]);
    }
  }
  return result;
}

template <class Float>
class Filter : public ::testing::Test {};
using Kinds = ::testing::Types<Float8, TwiceRounded>;
TYPED_TEST_SUITE(Filter, Kinds);

TYPED_TEST(Filter, NeverRejectsATriangleThatTheDoubleTestHits) {
  for (const bool in_float : {true, false}) {
    SCOPED_TRACE(in_float ? "float corners" : "double corners");
    Random random(41);
    Verdicts verdicts;
    for (int i = 0; i < 500'000; ++i) {
      const Pair pair = adversarial_pair(random, in_float);
      FlatPack pack;
      FlatPacker packer(pack);
      if (in_float) {
        packer.add(to_float(pair.corner), 0);
      } else {
        packer.add_rounded(to_float(pair.corner), 0);
      }
      judge<TypeParam>(pack, pair, 1e7, verdicts);
    }
    EXPECT_EQ(verdicts.false_rejects, 0);
    EXPECT_EQ(verdicts.false_sure, 0);
    EXPECT_GT(verdicts.hits, 200'000);
    EXPECT_GT(verdicts.sure, 10'000);
  }
}

TYPED_TEST(Filter, NeverRejectsASphereThatTheDoubleTestHits) {
  Random random(42);
  int hits = 0;
  for (int i = 0; i < 500'000; ++i) {
    Sphere sphere;
    sphere.center = magnitude(random, -3, 5) * random_point(random);
    sphere.radius = magnitude(random, -5, 3);
    const Vec3 origin =
        sphere.center + sphere.radius * magnitude(random, -3, 6) * random_point(random);
    const double edge = 1 + magnitude(random, -14, -1) * random.uniform(-1, 1);
    const Vec3 aside = normalize(cross(sphere.center - origin, random_direction(random)));
    const Vec3 direction = sphere.center + edge * sphere.radius * aside - origin;
    const TracedRay ray = trace_setup(origin, direction, kInfinity);
    SpherePack pack;
    pack.add(sphere, 0);
    const FloatRay floats(ray, 1e6f);
    Crossing crossing;
    if (intersect(ray, sphere, random.below(2) == 0, crossing)) {
      ++hits;
      ASSERT_NE(filter_spheres<TypeParam>(pack, floats, floats.above(crossing.t)), 0u);
    }
  }
  EXPECT_GT(hits, 100'000);
}

/// The ray reaches a point at t = 1. Each box contains this point inside, on a face or at a corner,
/// and some boxes consist of the point alone. The ray must enter all of these boxes.
TYPED_TEST(Filter, NeverRejectsABoxThatContainsAHit) {
  Random random(44);
  for (int i = 0; i < 500'000; ++i) {
    const Vec3 at = magnitude(random, -3, 5) * random_point(random);
    const double size = random.below(3) == 0 ? 0 : magnitude(random, -6, 2);
    const Vec3 hit = at + size * random_point(random);
    const Vec3 origin = at + magnitude(random, -4, 5) * random_point(random);
    const TracedRay ray = trace_setup(origin, hit - origin, kInfinity);
    const FloatRay floats(ray, 1e7f);
    WideNode node;
    for (std::size_t k = 0; k < 3; ++k) {
      const double margin = size * random.uniform() * random.below(2);
      const auto axis = static_cast<int>(k);
      node.bounds[k].fill(round_down(hit[axis] - margin));
      node.bounds[k + 3].fill(round_up(hit[axis] + size * random.below(2)));
    }
    TypeParam enter;
    ASSERT_EQ(enter_children<TypeParam>(node, floats, floats.above(1), enter), 0xffu) << i;
  }
}

TEST(Filters, GiveTheSameResultsWithEveryFloat8) {
  Random random(43);
  for (int i = 0; i < 50'000; ++i) {
    const Pair pair = adversarial_pair(random, /*in_float=*/true);
    const FloatRay floats(pair.ray, 1e7f);
    FlatPack pack;
    FlatPacker packer(pack);
    WideNode node;
    for (std::size_t lane = 0; lane < kPackSize; ++lane) {
      packer.add(to_float(adversarial_pair(random, /*in_float=*/true).corner), 0);
      for (auto& row : node.bounds) {
        row[lane] = static_cast<float>(random.uniform(-10, 10));
      }
    }
    const auto bound = static_cast<float>(random.uniform(0, 10));
    const FlatLanes a = filter_flats<Float8>(pack, floats, bound, bound);
    const FlatLanes b = filter_flats<simd_plain::Float8>(pack, floats, bound, bound);
    ASSERT_EQ(a.maybe, b.maybe);
    ASSERT_EQ(a.surely, b.surely);
    Float8 fast;
    simd_plain::Float8 plain;
    ASSERT_EQ(enter_children(node, floats, bound, fast),
              enter_children<simd_plain::Float8>(node, floats, bound, plain));
    std::array<float, 8> x;
    std::array<float, 8> y;
    fast.store(x.data());
    plain.store(y.data());
    ASSERT_EQ(x, y);
  }
}

}  // namespace
}  // namespace bandsaw::test
