// Builds a LightTree: divides the lights recursively. The lights are sorted into bins along each
// axis, and the cheapest split between two bins of an axis is taken. The cost is that of Conty
// Estevez and Kulla 2018 (light_tree.h), and depends on intensity, directions and extent of both
// halves.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "absl/types/span.h"
#include "renderlib/geometry/box.h"
#include "renderlib/light/light_bound.h"
#include "renderlib/light/light_tree.h"
#include "renderlib/math/constants.h"
#include "renderlib/math/elementary.h"

namespace bandsaw {
namespace {

/// A cone that contains the emission normals of a group of lights, as in `LightBound`. The angles
/// are in radians.
struct LightCone {
  Vec3 axis{0, 0, 1};
  double spread = 0;  ///< half-angle of the cone, in [0, pi]
  /// Largest angle to a normal at which light is emitted; in [0, pi / 2].
  double reach = 0;
  bool two_sided = false;  ///< the cone around -axis emits in the same way
};

/// Added to the spread of a merged cone. It is larger than the rounding error of the angles in one
/// merge.
constexpr double kSlack = 1e-9;

SinCos sincos(double radians) { return sincos_turns(radians * (0.5 * kInvPi)); }

/// Returns the angle between unit vectors, without loss of precision near 0 and pi.
double angle_between(const Vec3& a, const Vec3& b) {
  return 2 * atan2(length(a - b), length(a + b));
}

LightCone cone_of(const LightBound& bound) {
  return {bound.axis, acos(bound.cos_spread), acos(bound.cos_reach), bound.two_sided};
}

/// Returns the smallest cone that contains both; the whole sphere if their axes are opposite.
LightCone merged(const LightCone& a, const LightCone& b) {
  LightCone wide = a;
  LightCone narrow = b;
  if (wide.spread < narrow.spread) {
    std::swap(wide, narrow);
  }
  wide.reach = std::max(a.reach, b.reach);
  wide.two_sided = a.two_sided || b.two_sided;
  if (wide.two_sided && dot(wide.axis, narrow.axis) < 0) {
    narrow.axis = -narrow.axis;  // The cone around the opposite axis is the same.
  }
  const double between = angle_between(wide.axis, narrow.axis);
  if (std::min(between + narrow.spread, kPi) <= wide.spread) {
    return wide;
  }
  const double spread = (wide.spread + between + narrow.spread) / 2 + kSlack;
  const Vec3 across = narrow.axis - wide.axis * dot(narrow.axis, wide.axis);
  if (spread >= kPi || !(length_squared(across) > 0)) {
    wide.spread = kPi;
    return wide;
  }
  // The axis is rotated towards `narrow` until the wide cone touches the rim of the new cone from
  // inside.
  const SinCos turn = sincos(spread - wide.spread);
  wide.axis = normalize(wide.axis * turn.cos + normalize(across) * turn.sin);
  wide.spread = spread;
  return wide;
}

/// Returns the cosine-weighted measure of the directions that lights in the cone reach: M_Omega of
/// Conty Estevez and Kulla 2018, section 4.4, equation (1).
double orientation_measure(const LightCone& cone) {
  const double whole = std::min(cone.spread + cone.reach, kPi);
  const SinCos spread = sincos(cone.spread);
  return 2 * kPi * (1 - spread.cos) +
         0.5 * kPi *
             (2 * whole * spread.sin - sincos(cone.spread - 2 * whole).cos -
              2 * cone.spread * spread.sin + spread.cos);
}

/// Number of bins on each axis. It affects only how good the tree is.
constexpr std::size_t kBins = 12;

/// The lights of a bin or of one half of a split, with the numbers on which the cost depends.
struct Group {
  Box box = {};
  LightCone cone = {};
  double intensity = 0;
  std::size_t count = 0;

  void add(const Group& other) {
    if (other.count == 0) {
      return;
    }
    cone = count == 0 ? other.cone : merged(cone, other.cone);
    box.add(other.box.lo);
    box.add(other.box.hi);
    intensity += other.intensity;
    count += other.count;
  }
  double cost() const {
    // The importance uses a bounding sphere, so the area of the sphere counts, not that of the box.
    return intensity * orientation_measure(cone) * length_squared(box.hi - box.lo);
  }
};

Group group_of(const LightBound& light) {
  const Vec3 r{light.ball.radius, light.ball.radius, light.ball.radius};
  Group group{.cone = cone_of(light), .intensity = light.intensity, .count = 1};
  group.box.add(light.ball.center - r);
  group.box.add(light.ball.center + r);
  return group;
}

/// A split of the lights between two bins of an axis.
struct Split {
  int axis = -1;
  std::size_t bin = 0;  ///< last bin of the first half
  double cost = std::numeric_limits<double>::infinity();
};

}  // namespace

/// Builds the nodes of a LightTree. The constructor does all the work.
class LightTreeBuilder {
 public:
  LightTreeBuilder(const std::vector<LightBound>& lights, LightTree& tree)
      : lights_(lights), tree_(tree), order_(lights.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    tree_.leaves_.resize(lights.size());
    tree_.nodes_.reserve(2 * lights.size());
    tree_.nodes_.emplace_back();
    std::vector<Task> tasks{{0, 0, lights.size(), 0}};
    while (!tasks.empty()) {
      const Task task = tasks.back();
      tasks.pop_back();
      build(task, tasks);
    }
  }

 private:
  /// A subtree to be built: its root, and the range of `order_` that holds its lights.
  struct Task {
    std::uint32_t node;
    std::size_t begin;
    std::size_t end;
    std::uint32_t depth;  ///< of the node; 0 for the root
  };

  const Vec3& center(std::uint32_t light) const { return lights_[light].ball.center; }

  /// Builds one node and appends the tasks of its children.
  void build(const Task& task, std::vector<Task>& tasks) {
    const auto range = absl::MakeSpan(order_).subspan(task.begin, task.end - task.begin);
    if (range.size() == 1) {
      LightTree::Node& leaf = tree_.nodes_[task.node];
      leaf.bound = lights_[range[0]];
      leaf.first = range[0];
      leaf.is_leaf = true;
      tree_.leaves_[range[0]] = task.node;
      return;
    }
    const auto first = static_cast<std::uint32_t>(tree_.nodes_.size());
    LightTree::Node& node = tree_.nodes_[task.node];
    node.bound = bound_around(range);
    node.first = first;
    const std::size_t middle = task.begin + divide(range, task.depth);
    tree_.nodes_.resize(tree_.nodes_.size() + 2);
    tree_.nodes_[first].parent = task.node;
    tree_.nodes_[first + 1].parent = task.node;
    tasks.push_back({first + 1, middle, task.end, task.depth + 1});
    tasks.push_back({first, task.begin, middle, task.depth + 1});
  }

  /// Returns a bound that contains the bounds of these lights.
  LightBound bound_around(absl::Span<const std::uint32_t> range) const {
    Group group;
    for (const std::uint32_t light : range) {
      group.add(group_of(lights_[light]));
    }
    Ball ball{(group.box.lo + group.box.hi) / 2, 0};
    for (const std::uint32_t light : range) {
      ball.radius =
          std::max(ball.radius, length(center(light) - ball.center) + lights_[light].ball.radius);
    }
    const LightCone& cone = group.cone;
    const auto cosine = [](double angle) { return sincos_turns(angle * (0.5 * kInvPi)).cos; };
    return {.ball = ball,
            .intensity = group.intensity,
            .axis = cone.axis,
            .cos_spread = cone.spread >= kPi ? -1 : cosine(cone.spread),
            .cos_reach = cosine(cone.reach),
            .two_sided = cone.two_sided};
  }

  /// Partitions the lights into two non-empty halves; returns the size of the first.
  std::size_t divide(absl::Span<std::uint32_t> range, std::uint32_t depth) const {
    // If only 32 levels are left, the lights are divided into equal halves. So 32 levels are enough
    // for the at most 2^31 lights.
    constexpr std::uint32_t kHalvings = 32;
    const bool deep = depth + kHalvings >= LightTree::kMaxDepth;
    const Split split = deep || range.size() == 2 ? Split{} : best_split(range);
    if (split.axis < 0) {
      return range.size() / 2;
    }
    const Box box = centers(range);
    const auto end = std::stable_partition(range.begin(), range.end(), [&](std::uint32_t light) {
      return bin_of(light, split.axis, box) <= split.bin;
    });
    return static_cast<std::size_t>(end - range.begin());
  }

  /// Returns the bounding box of the lights' centres.
  Box centers(absl::Span<const std::uint32_t> range) const {
    Box box;
    for (const std::uint32_t light : range) {
      box.add(center(light));
    }
    return box;
  }

  /// Returns the bin that contains the light's centre. The bins divide `box` evenly along the axis.
  std::size_t bin_of(std::uint32_t light, int axis, const Box& box) const {
    const double share = (center(light)[axis] - box.lo[axis]) / (box.hi[axis] - box.lo[axis]);
    return std::min(kBins - 1, static_cast<std::size_t>(share * kBins));
  }

  /// Returns the cheapest split. Its axis is -1 if all centres coincide.
  Split best_split(absl::Span<const std::uint32_t> range) const {
    const Box box = centers(range);
    const double longest = max_abs(box.hi - box.lo);
    Split best;
    for (int axis = 0; axis < 3; ++axis) {
      const double extent = box.hi[axis] - box.lo[axis];
      if (!(extent > 0)) {
        continue;
      }
      std::array<Group, kBins> bins;
      for (const std::uint32_t light : range) {
        bins[bin_of(light, axis, box)].add(group_of(lights_[light]));
      }
      // longest / extent is the regularisation factor K_r of Conty Estevez and Kulla, which makes
      // splits along short axes more expensive.
      try_splits(bins, axis, longest / extent, best);
    }
    return best;
  }

  /// Replaces `best` if a split between two of the bins is cheaper. `factor` multiplies the costs.
  static void try_splits(const std::array<Group, kBins>& bins, int axis, double factor,
                         Split& best) {
    // Element i is the cost of all lights in bins i and higher, or -1 if there are none.
    std::array<double, kBins> above;
    Group group;
    for (std::size_t i = kBins - 1; i > 0; --i) {
      group.add(bins[i]);
      above[i] = group.count > 0 ? group.cost() : -1;
    }
    group = {};
    for (std::size_t i = 0; i + 1 < kBins; ++i) {
      group.add(bins[i]);
      const double cost = factor * (group.cost() + above[i + 1]);
      if (group.count > 0 && above[i + 1] >= 0 && cost < best.cost) {
        best = {axis, i, cost};
      }
    }
  }

  const std::vector<LightBound>& lights_;
  LightTree& tree_;
  std::vector<std::uint32_t> order_;  ///< the lights; each subtree has a range of them
};

LightTree::LightTree(const std::vector<LightBound>& lights) { LightTreeBuilder(lights, *this); }

}  // namespace bandsaw
