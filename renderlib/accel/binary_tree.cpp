#include "renderlib/accel/binary_tree.h"

#include <algorithm>
#include <utility>

#include "absl/types/span.h"
#include "renderlib/accel/divide.h"

namespace bandsaw {
namespace {

/// Appends the subtree of `range` to `nodes`.
void build_subtree(const Divider& divider, const Range& range, absl::Span<ItemRef> leaves,
                   std::vector<BinaryNode>& nodes) {
  const std::size_t index = nodes.size();
  nodes.push_back({range.box.box()});
  Range left;
  Range right;
  if (!divider.divide(range, left, right)) {
    nodes[index].first = range.first;
    nodes[index].count = range.count();
    const absl::Span<const TreeItem> all = divider.items(range);
    for (std::size_t i = 0; i < all.size(); ++i) {
      leaves[range.first + i] = {all[i].index, all[i].kind};
    }
    return;
  }
  nodes[index].left = static_cast<std::uint32_t>(nodes.size());
  build_subtree(divider, left, leaves, nodes);
  nodes[index].right = static_cast<std::uint32_t>(nodes.size());
  build_subtree(divider, right, leaves, nodes);
}

/// Ranges up to this size are one thread's work.
std::uint32_t task_size(std::uint32_t count, Pool* pool) {
  constexpr std::uint32_t kLeast = 1 << 13;
  constexpr std::uint32_t kTasksOfAThread = 16;
  return pool == nullptr
             ? count
             : std::max(kLeast,
                        count / (kTasksOfAThread * static_cast<std::uint32_t>(pool->threads())));
}

/// A subtree that one thread builds, and the node of the upper tree that it replaces.
struct Task {
  Range range;
  std::uint32_t node;
  std::vector<BinaryNode> nodes = {};
};

/// Splits until ranges are tasks; returns the node of `range`.
std::uint32_t build_upper(const Divider& divider, const Range& range, std::uint32_t most,
                          std::vector<BinaryNode>& nodes, std::vector<Task>& tasks) {
  const auto index = static_cast<std::uint32_t>(nodes.size());
  nodes.push_back({range.box.box()});
  Range left;
  Range right;
  if (range.count() <= most || !divider.divide(range, left, right)) {
    tasks.push_back({range, index});
    return index;
  }
  const std::uint32_t left_node = build_upper(divider, left, most, nodes, tasks);
  const std::uint32_t right_node = build_upper(divider, right, most, nodes, tasks);
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

BinaryTree build_binary_tree(TreeItems items, Pool* pool) {
  BinaryTree tree;
  if (items.empty()) {
    return tree;
  }
  const auto count = static_cast<std::uint32_t>(items.size());
  TreeItems other(count);
  const TwoLists lists = {absl::MakeSpan(items), absl::MakeSpan(other)};
  const Divider upper(lists, pool);
  const Divider lower(lists, nullptr);
  std::vector<Task> tasks;
  build_upper(upper, upper.range_of(0, count, 1, 0), task_size(count, pool), tree.nodes, tasks);
  tree.items.resize(count);
  const auto build_task = [&](std::int64_t i) {
    Task& task = tasks[static_cast<std::size_t>(i)];
    task.nodes.reserve(task.range.count() / 2);
    build_subtree(lower, task.range, absl::MakeSpan(tree.items), task.nodes);
  };
  if (pool != nullptr) {
    pool->parallel_for(static_cast<std::int64_t>(tasks.size()), build_task);
  } else {
    build_task(0);
  }
  // Grafting takes as much again as the nodes do.
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
