// FilmStrips divides the image into strips of pixels that always have the same samples: rows, or
// parts of half tiles (the units of adaptive sampling). A strip holds nodes: sums over ranges of
// samples, which are merged in pairs as in a binary tree. Film::Rows holds the nodes of each strip
// and the samples that each row has covered.

#include "renderlib/render/film.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "renderlib/base/check.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/render/band.h"
#include "renderlib/render/pixel_groups.h"
#include "renderlib/render/row_store.h"
#include "renderlib/render/strip_nodes.h"
#include "renderlib/render/tile_samples.h"

namespace bandsaw {
namespace {

/// The covered samples of one row. A sample of a row is covered once a band that has the row and
/// the sample has been added to the film. In adaptive sampling, a half tile may have taken other
/// samples, or none, in this band. The samples are stored as a list of ranges, in which adjacent
/// ranges are merged.
class CoveredSamples {
 public:
  /// Returns the covered range (after merging) that overlaps `samples`, if any.
  std::optional<SampleRange> overlap(const SampleRange& samples) const;
  /// Adds `samples`, none of which may be covered.
  void add(const SampleRange& samples);
  /// Returns the largest n for which [0, n) is covered.
  std::uint64_t from_start() const;

 private:
  std::vector<SampleRange> ranges_;  ///< in ascending order; no two are adjacent
};

std::optional<SampleRange> CoveredSamples::overlap(const SampleRange& samples) const {
  for (const SampleRange& range : ranges_) {
    if (range.first < samples.last && samples.first < range.last) {
      return range;
    }
  }
  return std::nullopt;
}

void CoveredSamples::add(const SampleRange& samples) {
  const auto after = std::find_if(ranges_.begin(), ranges_.end(), [&](const SampleRange& range) {
    return range.first >= samples.last;
  });
  auto at = ranges_.insert(after, samples);
  if (const auto next = std::next(at); next != ranges_.end() && next->first == at->last) {
    at->last = next->last;
    ranges_.erase(next);
  }
  if (at != ranges_.begin() && std::prev(at)->last == at->first) {
    std::prev(at)->last = at->last;
    ranges_.erase(at);
  }
}

std::uint64_t CoveredSamples::from_start() const {
  return ranges_.empty() || ranges_.front().first > 0 ? 0 : ranges_.front().last;
}

/// Pixels of one row that always have the same samples: the whole row, or a part of a half tile.
struct Strip {
  std::uint32_t count = 0;                     ///< may be 0
  std::optional<HalfRow> part = std::nullopt;  ///< row of a half tile; absent: a whole row

  /// Returns the x of pixel k of the strip.
  std::uint32_t x(std::uint32_t k) const { return part ? (*part)[k] : k; }
  /// Returns the k of the pixel at x, which is in the strip.
  std::size_t at(std::uint32_t x) const {
    return part ? static_cast<std::size_t>(std::find(part->begin(), part->end(), x) - part->begin())
                : x;
  }
};

/// The division of the image into strips. A strip is a whole row, or the part of a row that lies in
/// one half tile. The parts of a row are numbered tile by tile from the left. In each tile, the
/// part of the even half comes first.
class FilmStrips {
 public:
  FilmStrips(const TileGrid& grid, bool half_tiles) : grid_(grid), half_tiles_(half_tiles) {}

  std::uint32_t per_row() const { return half_tiles_ ? 2 * grid_.columns() : 1; }
  /// Returns the maximum number of pixels in a strip.
  std::uint32_t longest() const { return half_tiles_ ? kTileSide / 2 : grid_.width; }
  Strip strip(std::uint32_t y, std::uint32_t index) const {
    if (!half_tiles_) {
      return {grid_.width};
    }
    const HalfRow row = half_row(grid_, index / 2, index % 2, y);
    return {row.count(), row};
  }
  /// Returns the index of the strip that contains a pixel.
  std::uint32_t index_of(const PixelPlace& place) const {
    return half_tiles_ ? 2 * (place.x / kTileSide) + half_of(place.x, place.y) : 0;
  }
  bool half_tiles() const { return half_tiles_; }
  const TileGrid& grid() const { return grid_; }

 private:
  TileGrid grid_;
  bool half_tiles_;
};

}  // namespace

/// The content of a film.
struct Film::Rows {
  FilmStrips strips;
  RowStore store;
  std::vector<StripNodes> nodes;        ///< all strips, row by row
  std::vector<CoveredSamples> covered;  ///< all rows

  std::uint32_t width() const { return strips.grid().width; }
  std::uint32_t height() const { return strips.grid().height; }
  /// Returns the nodes of strip `index` of row y.
  StripNodes& of(std::uint32_t y, std::uint32_t index) {
    return nodes[std::size_t{y} * strips.per_row() + index];
  }
  const StripNodes& of(std::uint32_t y, std::uint32_t index) const {
    return nodes[std::size_t{y} * strips.per_row() + index];
  }
  /// Calls f(row, strip index, strip, nodes) for each strip with pixels, row by row.
  template <class F>
  void each(F f) const {
    for (std::uint32_t y = 0; y < height(); ++y) {
      for (std::uint32_t i = 0; i < strips.per_row(); ++i) {
        if (const Strip strip = strips.strip(y, i); strip.count > 0) {
          f(y, i, strip, of(y, i));
        }
      }
    }
  }

  /// Returns the errors of Film::add() that do not concern memory.
  absl::Status check(const BandPixels& pixels, const TileSamples& tiles) const;
  /// Inserts the sums of a row; `row` holds the sums of its pixels.
  void insert(std::uint32_t y, const SampleRange& samples, absl::Span<const double> row,
              const TileSamples& tiles);
  /// Returns true if the samples of every pixel begin with two nodes of equal size, the halves that
  /// the error estimate needs.
  bool all_have_halves() const;
  /// Calls f(half tile, number of the group, number of its pixels) for each group of pixels
  /// (render/pixel_groups.h), and adds the pixels of the group to the `ErrorSums` that f returns.
  template <class F>
  void add_errors(F f) const;
  /// Collects in `out` a pixel's contiguous nodes from the first sample on.
  void node_sums(const PixelPlace& place, std::vector<NodeSums>& out) const;
  /// Sets `total` to the sum of the contiguous nodes, added from left to right. `total` has at
  /// least 3 numbers for each pixel of the strip.
  void add_up(const StripNodes& from, std::vector<double>& total) const;
  /// Divides the contiguous nodes into two parts of about equal size, and adds to `total` the nodes
  /// of the part that contains the first node. Returns the number of samples of this part.
  std::uint64_t add_first_part(const StripNodes& from, std::vector<double>& total) const;
};

absl::Status Film::Rows::check(const BandPixels& pixels, const TileSamples& tiles) const {
  const Band& band = pixels.band;
  if (pixels.width != width() || band.rows.first >= band.rows.last || band.rows.last > height() ||
      pixels.sums.size() != std::size_t{band.rows.count()} * width() * 3 ||
      !is_node(band.samples)) {
    return absl::InvalidArgumentError(
        absl::StrCat("band of rows [", band.rows.first, ", ", band.rows.last, "), samples [",
                     band.samples.first, ", ", band.samples.last, "), width ", pixels.width,
                     ": does not fit a film of ", width(), " x ", height()));
  }
  BANDSAW_CHECK(strips.half_tiles() || tiles.whole(), "a film of rows has no tiles");
  for (std::uint32_t y = band.rows.first; y < band.rows.last; ++y) {
    if (const auto there = covered[y].overlap(band.samples)) {
      return absl::FailedPreconditionError(
          absl::StrCat("row ", y, ": samples [", there->first, ", ", there->last,
                       ") are in the film already; added again: [", band.samples.first, ", ",
                       band.samples.last, ")"));
    }
  }
  return absl::OkStatus();
}

void Film::Rows::insert(std::uint32_t y, const SampleRange& samples, absl::Span<const double> row,
                        const TileSamples& tiles) {
  covered[y].add(samples);
  for (std::uint32_t i = 0; i < strips.per_row(); ++i) {
    const Strip strip = strips.strip(y, i);
    if (strip.count == 0) {
      continue;
    }
    Node node{.range = tiles.of_pixel(strip.x(0), y, samples)};
    if (node.range.samples() > 0) {
      node.slot = store.take();
      const absl::Span<double> to = store.row(node.slot);
      for (std::uint32_t k = 0; k < strip.count; ++k) {
        std::copy_n(&row[std::size_t{strip.x(k)} * 3], 3, &to[std::size_t{3} * k]);
      }
      insert_node(node, of(y, i), store);
    }
  }
}

bool Film::Rows::all_have_halves() const {
  bool all = true;
  each([&](std::uint32_t, std::uint32_t, const Strip&, const StripNodes& strip) {
    all = all && has_halves(strip);
  });
  return all;
}

template <class F>
void Film::Rows::add_errors(F f) const {
  std::vector<NodeSums> of_pixel;
  for (std::size_t half_tile = 0; half_tile < strips.grid().half_tiles(); ++half_tile) {
    const PixelGroups groups(strips.grid(), half_tile);
    for (std::uint32_t i = 0; i < groups.count(); ++i) {
      ErrorSums& sums = f(half_tile, i, groups.group(i).size());
      for (const PixelPlace& place : groups.group(i)) {
        node_sums(place, of_pixel);
        sums.add(of_pixel);
      }
      sums.end_group();
    }
  }
}

void Film::Rows::node_sums(const PixelPlace& place, std::vector<NodeSums>& out) const {
  const std::uint32_t index = strips.index_of(place);
  const Strip strip = strips.strip(place.y, index);
  const StripNodes& from = of(place.y, index);
  out.clear();
  for (std::size_t i = 0; i < prefix(from); ++i) {
    out.push_back(
        {from[i].range.samples(), store.row(from[i].slot).subspan(3 * strip.at(place.x), 3)});
  }
}

void Film::Rows::add_up(const StripNodes& from, std::vector<double>& total) const {
  std::fill(total.begin(), total.end(), 0.0);
  for (std::size_t i = 0; i < prefix(from); ++i) {
    const absl::Span<const double> sums = store.row(from[i].slot);
    for (std::size_t k = 0; k < total.size(); ++k) {
      total[k] += sums[k];
    }
  }
}

std::uint64_t Film::Rows::add_first_part(const StripNodes& from, std::vector<double>& total) const {
  std::uint64_t first = 0;
  std::uint64_t second = 0;
  for (std::size_t i = 0; i < prefix(from); ++i) {
    const std::uint64_t count = from[i].range.samples();
    if (first > second) {
      second += count;
      continue;
    }
    first += count;
    const absl::Span<const double> sums = store.row(from[i].slot);
    for (std::size_t k = 0; k < total.size(); ++k) {
      total[k] += sums[k];
    }
  }
  return first;
}

Film::Film(std::unique_ptr<Rows> rows) : rows_(std::move(rows)) {}
Film::Film(Film&&) noexcept = default;
Film& Film::operator=(Film&&) noexcept = default;
Film::~Film() = default;

absl::StatusOr<Film> Film::create(std::uint32_t width, std::uint32_t height,
                                  std::string spill_folder, Grain grain) {
  RETURN_IF_ERROR(validate(RenderSettings{.width = width, .height = height}));
  const FilmStrips strips({width, height}, grain == Grain::kHalfTiles);
  return Film(std::make_unique<Rows>(
      Rows{strips, RowStore(std::size_t{strips.longest()} * 3, std::move(spill_folder)),
           std::vector<StripNodes>(std::size_t{height} * strips.per_row()),
           std::vector<CoveredSamples>(height)}));
}

absl::Status Film::add(const BandPixels& pixels, const TileSamples& tiles) {
  RETURN_IF_ERROR(rows_->check(pixels, tiles));
  const RowRange& range = pixels.band.rows;
  RETURN_IF_ERROR(rows_->store.reserve(std::size_t{range.count()} * rows_->strips.per_row()));
  const std::size_t row_size = std::size_t{pixels.width} * 3;
  const absl::Span<const double> sums = pixels.sums;
  for (std::uint32_t y = range.first; y < range.last; ++y) {
    rows_->insert(y, pixels.band.samples, sums.subspan((y - range.first) * row_size, row_size),
                  tiles);
  }
  return absl::OkStatus();
}

bool Film::complete(std::uint64_t samples) const {
  for (std::uint32_t y = 0; y < height(); ++y) {
    if (rows_->covered[y].from_start() < samples) {
      return false;
    }
  }
  return true;
}

Film::Snapshot Film::snapshot(std::uint32_t row_step) const {
  Snapshot snapshot;
  snapshot.image.width = width();
  snapshot.image.height = (height() + row_step - 1) / row_step;
  snapshot.image.pixels.resize(std::size_t{width()} * snapshot.image.height);
  snapshot.least_samples = kMaxSamples;
  std::vector<double> total(std::size_t{rows_->strips.longest()} * 3);
  for (std::uint32_t y = 0; y < height(); y += row_step) {
    snapshot.least_samples = std::min(snapshot.least_samples, rows_->covered[y].from_start());
    snapshot.missing_rows += rows_->covered[y].from_start() == 0 ? 1 : 0;
  }
  rows_->each([&](std::uint32_t y, std::uint32_t, const Strip& strip, const StripNodes& nodes) {
    const auto n = static_cast<double>(y % row_step == 0 ? samples(nodes) : 0);
    if (n == 0) {
      return;
    }
    rows_->add_up(nodes, total);
    Rgb* const row = &snapshot.image.pixels[std::size_t{y / row_step} * width()];
    for (std::uint32_t k = 0; k < strip.count; ++k) {
      row[strip.x(k)] = {static_cast<float>(total[3 * k] / n),
                         static_cast<float>(total[3 * k + 1] / n),
                         static_cast<float>(total[3 * k + 2] / n)};
    }
  });
  return snapshot;
}

std::optional<ErrorEstimate> Film::error() const {
  if (!rows_->all_have_halves()) {
    return std::nullopt;
  }
  ErrorSums sums;
  rows_->add_errors([&](std::size_t, std::uint32_t, std::size_t) -> ErrorSums& { return sums; });
  return sums.estimate();
}

std::optional<Film::FirstPart> Film::first_part() const {
  FirstPart out{{width(), height(), {}}, {}};
  out.mean.pixels.resize(std::size_t{width()} * height());
  out.share.resize(out.mean.pixels.size());
  bool known = true;
  std::vector<double> total;
  rows_->each([&](std::uint32_t y, std::uint32_t, const Strip& strip, const StripNodes& nodes) {
    known = known && prefix(nodes) > 1;
    if (!known) {
      return;
    }
    total.assign(std::size_t{strip.count} * 3, 0.0);
    const auto taken = static_cast<double>(rows_->add_first_part(nodes, total));
    const auto share = static_cast<float>(taken / static_cast<double>(samples(nodes)));
    for (std::uint32_t k = 0; k < strip.count; ++k) {
      const std::size_t at = std::size_t{y} * width() + strip.x(k);
      out.mean.pixels[at] = {static_cast<float>(total[3 * k] / taken),
                             static_cast<float>(total[3 * k + 1] / taken),
                             static_cast<float>(total[3 * k + 2] / taken)};
      out.share[at] = share;
    }
  });
  return known ? std::optional(std::move(out)) : std::nullopt;
}

std::vector<HalfTileErrors> Film::tile_errors() const {
  if (!rows_->strips.half_tiles() || !rows_->all_have_halves()) {
    return {};
  }
  // Entry 0 is for the groups with even numbers, and entry 1 for the groups with odd numbers.
  using Sums = std::array<ErrorSums, 2>;
  std::vector<Sums> sums(rows_->strips.grid().half_tiles());
  std::vector<HalfTileErrors> errors(sums.size());
  rows_->add_errors(
      [&](std::size_t half_tile, std::uint32_t group, std::size_t pixels) -> ErrorSums& {
        errors[half_tile][group % 2].pixels += static_cast<std::uint32_t>(pixels);
        return sums[half_tile][group % 2];
      });
  for (std::size_t i = 0; i < sums.size(); ++i) {
    for (const std::size_t part : {0, 1}) {
      if (TileError& error = errors[i][part]; error.pixels > 0) {
        const ErrorEstimate estimate = sums[i][part].estimate();
        error.variance = estimate.rmse * estimate.rmse;
        error.relative = estimate.relative_mse;
      }
    }
  }
  return errors;
}

Image Film::counts() const {
  Image image{width(), height(), {}};
  image.pixels.resize(std::size_t{width()} * height());
  rows_->each([&](std::uint32_t y, std::uint32_t, const Strip& strip, const StripNodes& nodes) {
    const Rgb count = gray(static_cast<float>(samples(nodes)));
    for (std::uint32_t k = 0; k < strip.count; ++k) {
      image.pixels[std::size_t{y} * width() + strip.x(k)] = count;
    }
  });
  return image;
}

std::uint32_t Film::width() const { return rows_->width(); }
std::uint32_t Film::height() const { return rows_->height(); }

}  // namespace bandsaw
