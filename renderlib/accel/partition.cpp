// A range of items (boxes with the number and kind of what they contain) is split at the cheapest
// plane. If no plane separates the items, the range is split by the kind of its items, or in halves
// at the median.

#include "renderlib/accel/partition.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <tuple>

namespace bandsaw {
namespace {

/// A range that fits one pack (the primitives of a leaf, which are tested together) is split only
/// if the sum of the areas of both parts' boxes is below this share of the area of the range's box
/// (README.md, "Traversal and leaves").
constexpr double kWorthSplitting = 0.7;

bool one_kind(absl::Span<const TreeItem> items) {
  const LeafKind kind = items.front().kind;
  return std::all_of(items.begin(), items.end(),
                     [kind](const TreeItem& item) { return item.kind == kind; });
}

/// Returns true if the items cannot form one leaf. A leaf has one instance, or up to kPackSize
/// primitives of one kind.
bool must_split(absl::Span<const TreeItem> items) {
  return items.size() > kPackSize || !one_kind(items) ||
         (items.size() > 1 && items.front().kind == LeafKind::kInstance);
}

/// Returns true if the range must be halved from here on, because the tree may not become deeper
/// than kMaxTreeDepth. Halving takes log2(count) levels, and separating the kinds takes two more.
/// The range is deep if no more levels than that are left.
bool is_deep(const Range& range) {
  return range.depth + static_cast<std::size_t>(std::bit_width(range.count())) + 2 >= kMaxTreeDepth;
}

/// Reorders the items, so that the half with the lower centres on the widest axis comes first. Ties
/// are broken by kind and index, so that the tree does not depend on the sorting algorithm.
void halve(absl::Span<TreeItem> items, const FloatBox& centres) {
  std::size_t axis = 0;
  for (std::size_t k = 1; k < 3; ++k) {
    if (centres.hi[k] - centres.lo[k] > centres.hi[axis] - centres.lo[axis]) {
      axis = k;
    }
  }
  const auto place = [axis](const TreeItem& item) {
    return std::make_tuple(item.lo[axis] + item.hi[axis], item.kind, item.index);
  };
  std::nth_element(items.begin(), items.begin() + items.size() / 2, items.end(),
                   [&](const TreeItem& a, const TreeItem& b) { return place(a) < place(b); });
}

}  // namespace

Range bounded(const TwoLists& lists, Range range) {
  range.box = {};
  range.centres = {};
  for (const TreeItem& item : items_of(lists, range)) {
    const Float8 lanes = Float8::from_bytes(item);
    range.box.add(LaneBox::of(lanes));
    range.centres.add(LaneBox::of(twice_centre(lanes)));
  }
  return range;
}

Partition::Partition(const TwoLists& lists, const Range& range, absl::Span<Piece> pieces)
    : lists_(lists),
      range_(range),
      pieces_(pieces),
      must_(must_split(items_of(lists, range))),
      deep_(is_deep(range)),
      binning_(range.centres) {}

void Partition::bin(Piece& piece) const {
  if (!deep_) {
    piece.bins.add(piece.items, binning_);
  }
}

Split Partition::find_split() const {
  if (deep_) {
    return {};
  }
  if (pieces_.size() == 1) {
    return pieces_.front().bins.best_split(binning_);
  }
  Bins bins;
  for (const Piece& piece : pieces_) {
    bins.add(piece.bins);
  }
  return bins.best_split(binning_);
}

bool Partition::has_plane() const { return std::isfinite(split_.cost); }

bool Partition::choose() {
  split_ = find_split();
  if (!must_ && !(split_.cost < kWorthSplitting * range_.box.area())) {
    return false;
  }
  if (!has_plane()) {
    return true;
  }
  TreeItem* left = &lists_[1 - range_.list][range_.first];
  TreeItem* right = left;
  for (const Piece& piece : pieces_) {
    right += piece.bins.left_count(split_);
  }
  for (Piece& piece : pieces_) {
    const std::uint32_t count = piece.bins.left_count(split_);
    piece.to = {left, right};
    left += count;
    right += piece.items.size() - count;
  }
  return true;
}

void Partition::move(Piece& piece) const {
  if (has_plane()) {
    piece.centres = part(piece.items, binning_, split_, piece.to);
  }
}

void Partition::parts(Range& left, Range& right) const {
  if (!has_plane()) {
    part_without_plane(left, right);
    return;
  }
  const std::size_t list = 1 - range_.list;
  const auto left_count = static_cast<std::uint32_t>(pieces_.front().to[1] - pieces_.front().to[0]);
  left = {range_.first, range_.first + left_count, range_.depth + 1, list, {}, {}};
  right = {left.end, range_.end, range_.depth + 1, list, {}, {}};
  for (const Piece& piece : pieces_) {
    const auto [left_box, right_box] = piece.bins.boxes(split_);
    left.box.add(left_box);
    right.box.add(right_box);
    left.centres.add(piece.centres[0]);
    right.centres.add(piece.centres[1]);
  }
}

/// Divides a range that is not split at a plane: by kind if it would fit one pack, otherwise in
/// halves.
void Partition::part_without_plane(Range& left, Range& right) const {
  const absl::Span<TreeItem> all = items_of(lists_, range_);
  std::uint32_t middle = range_.first + range_.count() / 2;
  if (range_.count() <= kPackSize && !one_kind(all)) {
    const LeafKind kind = all.front().kind;
    const auto end = std::partition(all.begin(), all.end(),
                                    [kind](const TreeItem& item) { return item.kind == kind; });
    middle = range_.first + static_cast<std::uint32_t>(end - all.begin());
  } else {
    halve(all, range_.centres.box());
  }
  left = bounded(lists_, {range_.first, middle, range_.depth + 1, range_.list, {}, {}});
  right = bounded(lists_, {middle, range_.end, range_.depth + 1, range_.list, {}, {}});
}

bool partition_range(const TwoLists& lists, const Range& range, Range& left, Range& right) {
  const absl::Span<const TreeItem> items = items_of(lists, range);
  // One or two primitives of one kind are not worth splitting.
  if (items.size() < 3 && !must_split(items)) {
    return false;
  }
  Partition::Piece piece = {items};
  Partition partition(lists, range, {&piece, 1});
  partition.bin(piece);
  if (!partition.choose()) {
    return false;
  }
  partition.move(piece);
  partition.parts(left, right);
  return true;
}

}  // namespace bandsaw
