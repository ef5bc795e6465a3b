// The tree is built from the root down: a range of items (boxes with a number) is partitioned in
// two, and so on. Large ranges are partitioned level by level by all threads; their nodes are the
// upper tree. As soon as a range is small enough, it becomes a task, whose subtree one thread
// builds. The subtrees are then joined to the upper tree.

#include "renderlib/accel/binary_tree.h"

#include <algorithm>
#include <utility>

#include "absl/functional/function_ref.h"
#include "absl/types/span.h"
#include "renderlib/accel/partition.h"

namespace bandsaw {
namespace {

/// Appends the subtree of `range` to `nodes`, and stores the items of its leaves in `leaves`
/// (BinaryTree::items), at the positions of the range.
void build_subtree(const TwoLists& lists, const Range& range, absl::Span<ItemRef> leaves,
                   std::vector<BinaryNode>& nodes) {
  const std::size_t index = nodes.size();
  nodes.push_back({range.box.box()});
  Range left;
  Range right;
  if (!partition_range(lists, range, left, right)) {
    nodes[index].first = range.first;
    nodes[index].count = range.count();
    const absl::Span<const TreeItem> items = items_of(lists, range);
    for (std::size_t i = 0; i < items.size(); ++i) {
      leaves[range.first + i] = {items[i].index, items[i].kind};
    }
    return;
  }
  nodes[index].left = static_cast<std::uint32_t>(nodes.size());
  build_subtree(lists, left, leaves, nodes);
  nodes[index].right = static_cast<std::uint32_t>(nodes.size());
  build_subtree(lists, right, leaves, nodes);
}

/// Ranges of the upper tree are cut into pieces of this many items, which the threads bin and move
/// in parallel. The tree depends neither on this number nor on the numbers in task_size().
constexpr std::size_t kPieceSize = 1 << 12;

/// Returns the size up to which a range is built by one thread.
std::uint32_t task_size(std::uint32_t count, Pool* pool) {
  constexpr std::uint32_t kMinPiece = 1 << 13;
  constexpr std::uint32_t kTasksOfAThread = 8;
  return pool == nullptr
             ? count
             : std::max(kMinPiece,
                        count / (kTasksOfAThread * static_cast<std::uint32_t>(pool->threads())));
}

/// A range and its node in the upper tree. If the range is small, one thread builds its subtree,
/// whose root replaces that node.
struct Task {
  Range range;
  std::uint32_t node;
  std::vector<BinaryNode> nodes = {};  ///< the subtree, once it is built
};

/// One level of the upper tree: the large ranges, each with its node.
class Level {
 public:
  /// Cuts the items of each range into pieces of at most kPieceSize items, which threads handle one
  /// by one.
  Level(const TwoLists& lists, std::vector<Task> tasks) : tasks_(std::move(tasks)) {
    std::size_t count = 0;
    for (const Task& task : tasks_) {
      count += (task.range.count() + kPieceSize - 1) / kPieceSize;
    }
    pieces_.reserve(count);
    for (const Task& task : tasks_) {
      const absl::Span<const TreeItem> items = items_of(lists, task.range);
      const std::size_t first = pieces_.size();
      for (std::size_t i = 0; i < items.size(); i += kPieceSize) {
        owner_.push_back(partitions_.size());
        pieces_.push_back({items.subspan(i, kPieceSize)});
      }
      partitions_.emplace_back(lists, task.range, absl::MakeSpan(pieces_).subspan(first));
    }
  }

  /// Divides all ranges, and appends the nodes of the parts to `nodes`, as children of the ranges'
  /// nodes. Returns the parts with their nodes.
  std::vector<Task> next(Pool& pool, std::vector<BinaryNode>& nodes) {
    for_each(pool, [&](Partition& partition, Partition::Piece& piece) { partition.bin(piece); });
    for (Partition& partition : partitions_) {
      partition.choose();
    }
    for_each(pool, [&](Partition& partition, Partition::Piece& piece) { partition.move(piece); });
    std::vector<Task> children;
    for (std::size_t i = 0; i < tasks_.size(); ++i) {
      Range left;
      Range right;
      partitions_[i].parts(left, right);
      const auto place = static_cast<std::uint32_t>(nodes.size());
      nodes[tasks_[i].node].left = place;
      nodes[tasks_[i].node].right = place + 1;
      nodes.push_back({left.box.box()});
      nodes.push_back({right.box.box()});
      children.push_back({left, place});
      children.push_back({right, place + 1});
    }
    return children;
  }

 private:
  /// Calls body(partition, piece) for each piece of each range, in parallel.
  void for_each(Pool& pool, absl::FunctionRef<void(Partition&, Partition::Piece&)> body) {
    pool.parallel_for(static_cast<std::int64_t>(pieces_.size()), [&](std::int64_t i) {
      const auto piece = static_cast<std::size_t>(i);
      body(partitions_[owner_[piece]], pieces_[piece]);
    });
  }

  std::vector<Task> tasks_;
  std::vector<Partition> partitions_;
  std::vector<Partition::Piece> pieces_;
  std::vector<std::size_t> owner_;  ///< for each piece, the index of its partition
};

/// Appends the upper tree to `nodes`: divides ranges, level by level, until each has at most `most`
/// items. Returns these ranges. `pool` may be null if `all` has at most `most` items.
std::vector<Task> build_upper(const TwoLists& lists, const Range& all, std::uint32_t most,
                              Pool* pool, std::vector<BinaryNode>& nodes) {
  nodes.push_back({all.box.box()});
  std::vector<Task> tasks;
  std::vector<Task> open = {{all, 0}};
  while (true) {
    std::vector<Task> large;
    for (const Task& task : open) {
      (task.range.count() > most ? large : tasks).push_back(task);
    }
    if (large.empty()) {
      return tasks;
    }
    open = Level(lists, std::move(large)).next(*pool, nodes);
  }
}

/// Puts a task's root at its place in the upper tree, and appends its other nodes.
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

BinaryTree build_binary_tree(TreeItems items, Pool* pool) {
  BinaryTree tree;
  if (items.empty()) {
    return tree;
  }
  const auto count = static_cast<std::uint32_t>(items.size());
  TreeItems other(count);
  const TwoLists lists = {absl::MakeSpan(items), absl::MakeSpan(other)};
  // The range [0, count) at depth 1, in list 0.
  std::vector<Task> tasks = build_upper(lists, bounded(lists, {0, count, 1, 0, {}, {}}),
                                        task_size(count, pool), pool, tree.nodes);
  // Largest tasks first, so that the threads finish together.
  std::sort(tasks.begin(), tasks.end(),
            [](const Task& a, const Task& b) { return a.range.count() > b.range.count(); });
  tree.items.resize(count);
  const auto build_task = [&](std::int64_t i) {
    Task& task = tasks[static_cast<std::size_t>(i)];
    task.nodes.reserve(task.range.count() / 2);
    build_subtree(lists, task.range, absl::MakeSpan(tree.items), task.nodes);
  };
  if (pool != nullptr) {
    pool->parallel_for(static_cast<std::int64_t>(tasks.size()), build_task);
  } else {
    build_task(0);
  }
  // The items are freed before grafting, which holds the nodes of the subtrees in memory twice.
  items = {};
  other = {};
  std::size_t nodes = tree.nodes.size();
  for (const Task& task : tasks) {
    nodes += task.nodes.size();
  }
  tree.nodes.reserve(nodes);
  for (Task& task : tasks) {
    graft(task, tree.nodes);
  }
  return tree;
}

}  // namespace bandsaw
