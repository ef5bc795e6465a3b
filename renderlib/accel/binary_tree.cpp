#include "renderlib/accel/binary_tree.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "renderlib/accel/best_split.h"

namespace bandsaw {
namespace {

/// Ranges up to this size are one thread's work.
constexpr std::uint32_t kTaskSize = 1 << 13;
/// Larger ones are binned in pieces of this size.
constexpr std::uint32_t kPieceSize = 1 << 14;
/// A range that fits one pack is split all the same when that leaves less than this part of it.
constexpr double kWorthSplitting = 0.7;

/// A range of items that is to become a subtree.
struct Range {
  std::uint32_t first;
  std::uint32_t end;
  std::size_t depth;
  RangeBounds bounds;

  std::uint32_t count() const { return end - first; }
};

class Builder {
 public:
  Builder(std::vector<TreeItem>& items, Pool* pool) : items_(items), pool_(pool) {}

  /// Appends the subtree of `range` to `nodes`.
  void build(const Range& range, std::vector<BinaryNode>& nodes) const;
  /// The two parts of a range that is no leaf; false: it is one.
  bool divide(const Range& range, Range& left, Range& right) const;
  RangeBounds bounds_of(std::uint32_t first, std::uint32_t end) const;

 private:
  bool one_kind(const Range& range) const;
  bool must_split(const Range& range) const;
  Split find_split(const Range& range, const Binning& binning) const;
  std::uint32_t halve(const Range& range) const;
  std::uint32_t by_kind(const Range& range) const;

  std::vector<TreeItem>& items_;
  Pool* pool_;
};

RangeBounds Builder::bounds_of(std::uint32_t first, std::uint32_t end) const {
  RangeBounds bounds;
  for (std::uint32_t i = first; i < end; ++i) {
    bounds.add(items_[i]);
  }
  return bounds;
}

bool Builder::one_kind(const Range& range) const {
  const LeafKind kind = items_[range.first].kind;
  return std::all_of(items_.begin() + range.first, items_.begin() + range.end,
                     [kind](const TreeItem& item) { return item.kind == kind; });
}

bool Builder::must_split(const Range& range) const {
  return range.count() > kPackSize || !one_kind(range) ||
         (range.count() > 1 && items_[range.first].kind == LeafKind::kInstance);
}

Split Builder::find_split(const Range& range, const Binning& binning) const {
  const absl::Span<const TreeItem> items(&items_[range.first], range.count());
  Bins bins;
  if (pool_ == nullptr || range.count() <= kPieceSize) {
    bins.add(items, binning);
    return best_split(bins, binning);
  }
  // Which thread bins a piece does not matter: least, most and count are the same in any order.
  std::vector<Bins> pieces((items.size() + kPieceSize - 1) / kPieceSize);
  pool_->parallel_for(static_cast<std::int64_t>(pieces.size()), [&](std::int64_t i) {
    const auto piece = static_cast<std::size_t>(i);
    pieces[piece].add(items.subspan(piece * kPieceSize, kPieceSize), binning);
  });
  for (const Bins& piece : pieces) {
    bins.add(piece);
  }
  return best_split(bins, binning);
}

/// The middle item along the widest axis; ties by index, so that the tree does not depend on the
/// sort.
std::uint32_t Builder::halve(const Range& range) const {
  const FloatBox& centres = range.bounds.centres;
  std::size_t axis = 0;
  for (std::size_t k = 1; k < 3; ++k) {
    if (centres.hi[k] - centres.lo[k] > centres.hi[axis] - centres.lo[axis]) {
      axis = k;
    }
  }
  const std::uint32_t middle = range.first + range.count() / 2;
  std::nth_element(items_.begin() + range.first, items_.begin() + middle,
                   items_.begin() + range.end, [axis](const TreeItem& a, const TreeItem& b) {
                     return std::make_tuple(a.box.centre(axis), a.kind, a.index) <
                            std::make_tuple(b.box.centre(axis), b.kind, b.index);
                   });
  return middle;
}

/// The items of the first item's kind, then the others.
std::uint32_t Builder::by_kind(const Range& range) const {
  const LeafKind kind = items_[range.first].kind;
  const auto middle = std::partition(items_.begin() + range.first, items_.begin() + range.end,
                                     [kind](const TreeItem& item) { return item.kind == kind; });
  return static_cast<std::uint32_t>(middle - items_.begin());
}

bool Builder::divide(const Range& range, Range& left, Range& right) const {
  const bool must = must_split(range);
  if (!must && range.count() < 3) {
    return false;
  }
  // Halving from here on needs log2(count) levels, and two more to part kinds; when no more are
  // left, nothing else will do.
  const bool deep =
      range.depth + static_cast<std::size_t>(std::bit_width(range.count())) + 2 >= kMaxDepth;
  const Binning binning(range.bounds.centres);
  const Split split = deep ? Split{} : find_split(range, binning);
  if (!must && !(split.cost < kWorthSplitting * range.bounds.box.area())) {
    return false;
  }
  std::uint32_t middle = 0;
  if (std::isfinite(split.cost)) {
    const auto end = std::partition(
        items_.begin() + range.first, items_.begin() + range.end,
        [&](const TreeItem& item) { return binning.bin(item.box, split.axis) < split.bin; });
    middle = static_cast<std::uint32_t>(end - items_.begin());
  } else {
    middle = range.count() <= kPackSize && !one_kind(range) ? by_kind(range) : halve(range);
  }
  left = {range.first, middle, range.depth + 1, bounds_of(range.first, middle)};
  right = {middle, range.end, range.depth + 1, bounds_of(middle, range.end)};
  return true;
}

void Builder::build(const Range& range, std::vector<BinaryNode>& nodes) const {
  const std::size_t index = nodes.size();
  nodes.push_back({range.bounds.box});
  Range left;
  Range right;
  if (!divide(range, left, right)) {
    nodes[index].first = range.first;
    nodes[index].count = range.count();
    return;
  }
  nodes[index].left = static_cast<std::uint32_t>(nodes.size());
  build(left, nodes);
  nodes[index].right = static_cast<std::uint32_t>(nodes.size());
  build(right, nodes);
}

/// A subtree that one thread builds, and the node of the upper tree that it replaces.
struct Task {
  Range range;
  std::uint32_t node;
  std::vector<BinaryNode> nodes = {};
};

/// Splits until ranges are tasks; returns the node of `range`.
std::uint32_t build_upper(const Builder& builder, const Range& range,
                          std::vector<BinaryNode>& nodes, std::vector<Task>& tasks) {
  const auto index = static_cast<std::uint32_t>(nodes.size());
  nodes.push_back({range.bounds.box});
  Range left;
  Range right;
  if (range.count() <= kTaskSize || !builder.divide(range, left, right)) {
    tasks.push_back({range, index});
    return index;
  }
  const std::uint32_t left_node = build_upper(builder, left, nodes, tasks);
  const std::uint32_t right_node = build_upper(builder, right, nodes, tasks);
  nodes[index].left = left_node;
  nodes[index].right = right_node;
  return index;
}

/// Puts a task's root where the upper tree has its place, and the rest at the end.
void graft(Task& task, std::vector<BinaryNode>& nodes) {
  const auto shift = static_cast<std::uint32_t>(nodes.size()) - 1;
  for (BinaryNode& node : task.nodes) {
    if (node.count == 0) {
      node.left += shift;
      node.right += shift;
    }
  }
  nodes[task.node] = task.nodes.front();
  nodes.insert(nodes.end(), task.nodes.begin() + 1, task.nodes.end());
  task.nodes = {};
}

}  // namespace

BinaryTree build_binary_tree(std::vector<TreeItem> items, Pool* pool) {
  BinaryTree tree;
  tree.items = std::move(items);
  if (tree.items.empty()) {
    return tree;
  }
  const Builder builder(tree.items, pool);
  const auto count = static_cast<std::uint32_t>(tree.items.size());
  const Range all = {0, count, 1, builder.bounds_of(0, count)};
  std::vector<Task> tasks;
  build_upper(builder, all, tree.nodes, tasks);
  const auto build_task = [&](std::int64_t i) {
    Task& task = tasks[static_cast<std::size_t>(i)];
    task.nodes.reserve(task.range.count() / 2);
    builder.build(task.range, task.nodes);
  };
  if (pool != nullptr) {
    pool->parallel_for(static_cast<std::int64_t>(tasks.size()), build_task);
  } else {
    for (std::size_t i = 0; i < tasks.size(); ++i) {
      build_task(static_cast<std::int64_t>(i));
    }
  }
  for (Task& task : tasks) {
    graft(task, tree.nodes);
  }
  return tree;
}

}  // namespace bandsaw
