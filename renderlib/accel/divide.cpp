#include "renderlib/accel/divide.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <tuple>
#include <vector>

namespace bandsaw {
namespace {

/// Larger ranges are binned and parted in pieces of this size.
constexpr std::uint32_t kPieceSize = 1 << 14;
/// A range that fits one pack is split all the same when that leaves less than this part of it.
constexpr double kWorthSplitting = 0.7;

/// The middle item along the widest axis; ties by index, so that the tree does not depend on the
/// sort.
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

/// Of a range, what one thread bins and moves at a time.
struct Divider::Piece {
  absl::Span<const TreeItem> items;
  Bins bins = {};
  TreeItem* left = nullptr;  ///< where they go
  TreeItem* right = nullptr;
  std::array<LaneBox, 2> centres = {};  ///< of both parts
};

Range Divider::range_of(std::uint32_t first, std::uint32_t end, std::size_t depth,
                        std::size_t list) const {
  Range range = {first, end, depth, list, {}, {}};
  for (const TreeItem& item : items(range)) {
    const Float8 lanes = Float8::from_bytes(item);
    range.box.add(LaneBox::of(lanes));
    range.centres.add(LaneBox::of(twice_centre(lanes)));
  }
  return range;
}

bool Divider::one_kind(const Range& range) const {
  const absl::Span<const TreeItem> all = items(range);
  const LeafKind kind = all.front().kind;
  return std::all_of(all.begin(), all.end(),
                     [kind](const TreeItem& item) { return item.kind == kind; });
}

bool Divider::must_split(const Range& range) const {
  return range.count() > kPackSize || !one_kind(range) ||
         (range.count() > 1 && items(range).front().kind == LeafKind::kInstance);
}

void Divider::for_each(absl::Span<Piece> pieces, absl::FunctionRef<void(Piece&)> body) const {
  if (pieces.size() == 1) {
    body(pieces.front());
    return;
  }
  pool_->parallel_for(static_cast<std::int64_t>(pieces.size()),
                      [&](std::int64_t i) { body(pieces[static_cast<std::size_t>(i)]); });
}

/// Where no plane parts the centres: by kind, or in halves.
void Divider::part_without_plane(const Range& range, Range& left, Range& right) const {
  const absl::Span<TreeItem> all = items(range);
  std::uint32_t middle = range.first + range.count() / 2;
  if (range.count() <= kPackSize && !one_kind(range)) {
    const LeafKind kind = all.front().kind;
    const auto end = std::partition(all.begin(), all.end(),
                                    [kind](const TreeItem& item) { return item.kind == kind; });
    middle = range.first + static_cast<std::uint32_t>(end - all.begin());
  } else {
    halve(all, range.centres.box());
  }
  left = range_of(range.first, middle, range.depth + 1, range.list);
  right = range_of(middle, range.end, range.depth + 1, range.list);
}

void Divider::part_at(const Split& split, const Binning& binning, absl::Span<Piece> pieces,
                      const Range& range, Range& left, Range& right) const {
  const std::size_t other = 1 - range.list;
  std::uint32_t left_count = 0;
  for (const Piece& piece : pieces) {
    left_count += piece.bins.left_count(split);
  }
  TreeItem* to_left = &lists_[other][range.first];
  TreeItem* to_right = to_left + left_count;
  for (Piece& piece : pieces) {
    const std::uint32_t count = piece.bins.left_count(split);
    piece.left = to_left;
    piece.right = to_right;
    to_left += count;
    to_right += piece.items.size() - count;
  }
  for_each(pieces, [&](Piece& piece) {
    piece.centres = part(piece.items, binning, split, piece.left, piece.right);
  });
  left = {range.first, range.first + left_count, range.depth + 1, other, {}, {}};
  right = {left.end, range.end, range.depth + 1, other, {}, {}};
  for (const Piece& piece : pieces) {
    const auto [left_box, right_box] = piece.bins.boxes(split);
    left.box.add(left_box);
    right.box.add(right_box);
    left.centres.add(piece.centres[0]);
    right.centres.add(piece.centres[1]);
  }
}

/// The pieces do not matter: least, most and count are the same in any order, and items stay in
/// theirs.
Split Divider::find_split(const Binning& binning, absl::Span<Piece> pieces) const {
  for_each(pieces, [&](Piece& piece) { piece.bins.add(piece.items, binning); });
  if (pieces.size() == 1) {
    return pieces.front().bins.best_split(binning);
  }
  Bins bins;
  for (const Piece& piece : pieces) {
    bins.add(piece.bins);
  }
  return bins.best_split(binning);
}

bool Divider::divide(const Range& range, const Binning& binning, absl::Span<Piece> pieces,
                     Range& left, Range& right) const {
  const bool must = must_split(range);
  // Halving from here on needs log2(count) levels, and two more to part kinds; when no more are
  // left, nothing else will do.
  const bool deep =
      range.depth + static_cast<std::size_t>(std::bit_width(range.count())) + 2 >= kMaxDepth;
  const Split split = deep ? Split{} : find_split(binning, pieces);
  if (!must && !(split.cost < kWorthSplitting * range.box.area())) {
    return false;
  }
  if (std::isfinite(split.cost)) {
    part_at(split, binning, pieces, range, left, right);
  } else {
    part_without_plane(range, left, right);
  }
  return true;
}

bool Divider::divide(const Range& range, Range& left, Range& right) const {
  if (range.count() < 3 && !must_split(range)) {
    return false;
  }
  const Binning binning(range.centres);
  const absl::Span<const TreeItem> all = items(range);
  if (pool_ == nullptr || all.size() <= kPieceSize) {
    Piece piece = {all};
    return divide(range, binning, {&piece, 1}, left, right);
  }
  std::vector<Piece> pieces;
  for (std::size_t i = 0; i < all.size(); i += kPieceSize) {
    pieces.push_back({all.subspan(i, kPieceSize)});
  }
  return divide(range, binning, absl::MakeSpan(pieces), left, right);
}

}  // namespace bandsaw
