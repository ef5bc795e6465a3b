#include "renderlib/render/film.h"

#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/render/row_store.h"

namespace bandsaw {
namespace {

struct Node {
  SampleRange range;
  RowStore::Slot slot = 0;
};

/// The nodes of one row, in order of their samples; none overlap.
using RowNodes = std::vector<Node>;

bool whole(const SampleRange& range) { return range.samples() == range.blocks() * kBlockSamples; }

bool siblings(const SampleRange& left, const SampleRange& right) {
  return left.last == right.first && left.blocks() == right.blocks() &&
         left.first_block() % (2 * left.blocks()) == 0;
}

/// Whether nodes i and i + 1 are to become one. The two at the start of the row are halves that the
/// error estimate needs: they stay apart until a node as large as both makes new halves. Adding
/// from left to right gives the same bits either way.
bool should_merge(const RowNodes& nodes, std::size_t i) {
  if (!siblings(nodes[i].range, nodes[i + 1].range)) {
    return false;
  }
  if (nodes[i].range.first != 0) {
    return true;
  }
  const SampleRange both{0, nodes[i + 1].range.last};
  return nodes.size() > i + 2 && whole(both) && whole(nodes[i + 2].range) &&
         siblings(both, nodes[i + 2].range);
}

void merge_all(RowNodes& nodes, RowStore& store) {
  std::size_t i = 0;
  while (i + 1 < nodes.size()) {
    if (!should_merge(nodes, i)) {
      ++i;
      continue;
    }
    const absl::Span<double> left = store.row(nodes[i].slot);
    const absl::Span<const double> right = store.row(nodes[i + 1].slot);
    for (std::size_t k = 0; k < left.size(); ++k) {
      left[k] += right[k];
    }
    nodes[i].range.last = nodes[i + 1].range.last;
    store.give_back(nodes[i + 1].slot);
    nodes.erase(nodes.begin() + static_cast<std::ptrdiff_t>(i) + 1);
    i = i >= 2 ? i - 2
               : 0;  // A merge can make a sibling of the node before, or of the halves before that.
  }
}

/// How many nodes from the first sample on follow each other without a gap.
std::size_t prefix(const RowNodes& nodes) {
  std::size_t count = 0;
  std::uint64_t at = 0;
  while (count < nodes.size() && nodes[count].range.first == at) {
    at = nodes[count].range.last;
    ++count;
  }
  return count;
}

bool has_halves(const RowNodes& nodes) {
  return prefix(nodes) >= 2 && nodes[0].range.samples() == nodes[1].range.samples();
}

}  // namespace

struct Film::Rows {
  std::uint32_t width;
  std::uint32_t height;
  RowStore store;
  std::vector<RowNodes> nodes;

  absl::Status check(const BandPixels& pixels) const;
  void insert(std::uint32_t y, const SampleRange& range, absl::Span<const double> sums);
};

absl::Status Film::Rows::check(const BandPixels& pixels) const {
  const Band& band = pixels.band;
  if (pixels.width != width || band.rows.first >= band.rows.last || band.rows.last > height ||
      pixels.sums.size() != std::size_t{band.rows.count()} * width * 3 || !is_node(band.samples)) {
    return absl::InvalidArgumentError(
        absl::StrCat("band of rows [", band.rows.first, ", ", band.rows.last, "), samples [",
                     band.samples.first, ", ", band.samples.last, "), width ", pixels.width,
                     ": is none of a film of ", width, " x ", height));
  }
  for (std::uint32_t y = band.rows.first; y < band.rows.last; ++y) {
    for (const Node& node : nodes[y]) {
      if (node.range.first < band.samples.last && band.samples.first < node.range.last) {
        return absl::FailedPreconditionError(
            absl::StrCat("row ", y, ": samples [", node.range.first, ", ", node.range.last,
                         ") are there already; came again: [", band.samples.first, ", ",
                         band.samples.last, ")"));
      }
    }
  }
  return absl::OkStatus();
}

void Film::Rows::insert(std::uint32_t y, const SampleRange& range, absl::Span<const double> sums) {
  const Node node{range, store.take()};
  const absl::Span<double> row = store.row(node.slot);
  std::copy(sums.begin(), sums.end(), row.begin());
  RowNodes& of_row = nodes[y];
  const auto after = std::find_if(of_row.begin(), of_row.end(), [&](const Node& other) {
    return other.range.first > range.first;
  });
  of_row.insert(after, node);
  merge_all(of_row, store);
}

Film::Film(std::unique_ptr<Rows> rows) : rows_(std::move(rows)) {}
Film::Film(Film&&) noexcept = default;
Film& Film::operator=(Film&&) noexcept = default;
Film::~Film() = default;

absl::StatusOr<Film> Film::create(std::uint32_t width, std::uint32_t height,
                                  std::string spill_folder) {
  RETURN_IF_ERROR(validate(RenderSettings{.width = width, .height = height}));
  return Film(std::make_unique<Rows>(Rows{width, height,
                                          RowStore(std::size_t{width} * 3, std::move(spill_folder)),
                                          std::vector<RowNodes>(height)}));
}

absl::Status Film::add(const BandPixels& pixels) {
  RETURN_IF_ERROR(rows_->check(pixels));
  const RowRange& range = pixels.band.rows;
  RETURN_IF_ERROR(rows_->store.reserve(range.count()));
  const std::size_t row_size = std::size_t{pixels.width} * 3;
  const absl::Span<const double> sums = pixels.sums;
  for (std::uint32_t y = range.first; y < range.last; ++y) {
    rows_->insert(y, pixels.band.samples, sums.subspan((y - range.first) * row_size, row_size));
  }
  return absl::OkStatus();
}

bool Film::complete(std::uint64_t samples) const {
  return std::all_of(rows_->nodes.begin(), rows_->nodes.end(), [&](const RowNodes& nodes) {
    const std::size_t count = prefix(nodes);
    return samples == 0 || (count > 0 && nodes[count - 1].range.last >= samples);
  });
}

Film::Snapshot Film::snapshot() const {
  Snapshot snapshot;
  snapshot.image.width = rows_->width;
  snapshot.image.height = rows_->height;
  snapshot.image.pixels.resize(std::size_t{rows_->width} * rows_->height);
  snapshot.least_samples = kMaxSamples;
  std::vector<double> total(std::size_t{rows_->width} * 3);
  for (std::uint32_t y = 0; y < rows_->height; ++y) {
    const RowNodes& nodes = rows_->nodes[y];
    const std::size_t count = prefix(nodes);
    const std::uint64_t samples = count == 0 ? 0 : nodes[count - 1].range.last;
    snapshot.least_samples = std::min(snapshot.least_samples, samples);
    if (count == 0) {
      ++snapshot.missing_rows;
      continue;
    }
    const absl::Span<const double> first = rows_->store.row(nodes[0].slot);
    std::copy(first.begin(), first.end(), total.begin());
    for (std::size_t i = 1; i < count; ++i) {
      const absl::Span<const double> next = rows_->store.row(nodes[i].slot);
      for (std::size_t k = 0; k < total.size(); ++k) {
        total[k] += next[k];
      }
    }
    const auto n = static_cast<double>(samples);
    Rgb* const row = &snapshot.image.pixels[std::size_t{y} * rows_->width];
    for (std::uint32_t x = 0; x < rows_->width; ++x) {
      row[x] = {static_cast<float>(total[3 * x] / n), static_cast<float>(total[3 * x + 1] / n),
                static_cast<float>(total[3 * x + 2] / n)};
    }
  }
  return snapshot;
}

std::optional<ErrorEstimate> Film::error() const {
  ErrorSums sums;
  std::vector<NodeSums> of_row;
  for (const RowNodes& nodes : rows_->nodes) {
    if (!has_halves(nodes)) {
      return std::nullopt;
    }
    of_row.clear();
    for (std::size_t i = 0; i < prefix(nodes); ++i) {
      of_row.push_back({nodes[i].range.samples(), rows_->store.row(nodes[i].slot)});
    }
    sums.add_row(of_row);
  }
  return sums.estimate();
}

std::uint32_t Film::width() const { return rows_->width; }
std::uint32_t Film::height() const { return rows_->height; }

}  // namespace bandsaw
