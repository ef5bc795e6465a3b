// A band is a range of rows and samples that is leased to a worker. choose() finds a free piece of
// the job (rows and samples that are neither leased nor stored) that this worker may have, and cuts
// a band from its first rows, of the size that size_band() computes. There are two special kinds of
// rows. Probes are a few rows spread over the image that are rendered first. Suspect rows are rows
// that a worker held when it was lost, so they may have crashed the worker. Suspect rows are never
// in a band with other rows.

#include "coordinator/scheduler/dispatch/band_chooser.h"

#include <algorithm>
#include <vector>

#include "coordinator/scheduler/dispatch/probes.h"
#include "coordinator/scheduler/dispatch/work_rate.h"
#include "coordinator/scheduler/model/band_text.h"
#include "proto/wire/limits.h"
#include "renderlib/render/tile_samples.h"

namespace bandsaw::coordinator {
namespace {

/// Render times of bands as fractions of the target time. kFirst: the first band of a worker, whose
/// rate is not known yet. kMin: the shortest band near the end of a job.
constexpr double kFirst = 0.2;
constexpr double kMin = 0.125;

/// Bytes of one pixel in a result: three sums (red, green, blue).
constexpr std::uint64_t kBytesPerPixel = 3 * sizeof(double);

/// Returns the row after the row of tiles that contains `row`.
std::uint32_t end_of_tile_row(std::uint32_t row) { return (row / kTileSide + 1) * kTileSide; }

/// Returns the row before which a band of about `rows` should end, at most `last`. This is a border
/// between two rows of tiles if one is near: a band that crosses borders ends at the last border
/// that it crosses. A band that crosses none is extended to the next border, unless this would make
/// it more than a quarter longer.
std::uint32_t at_edge_of_tiles(const RowRange& rows, std::uint32_t last) {
  if (rows.last == last) {
    return last;
  }
  const std::uint32_t before = rows.last / kTileSide * kTileSide;
  const std::uint32_t after = std::min(end_of_tile_row(rows.first), last);
  return before > rows.first                            ? before
         : 4 * (after - rows.first) <= 5 * rows.count() ? after
                                                        : rows.last;
}

/// Returns the first rows of `free` that are in none of `avoid`.
std::optional<Band> without(Band free, const std::vector<Band>& avoid) {
  const auto same_samples = [&](const Band& a) {
    return a.samples.first < free.samples.last && free.samples.first < a.samples.last;
  };
  for (std::size_t i = 0; i < avoid.size(); ++i) {
    const RowRange& rows = avoid[i].rows;
    if (same_samples(avoid[i]) && rows.first <= free.rows.first && free.rows.first < rows.last) {
      free.rows.first = rows.last;
      i = static_cast<std::size_t>(-1);  // start again
    }
  }
  for (const Band& a : avoid) {
    if (same_samples(a) && a.rows.first > free.rows.first) {
      free.rows.last = std::min(free.rows.last, a.rows.first);
    }
  }
  return free.rows.first < free.rows.last ? std::optional(free) : std::nullopt;
}

/// Returns an estimate of the work of the job that is neither leased nor stored. The free samples
/// of the pass of `free` are assumed to be spread over the rows from the first row of `free` on.
/// The free samples of other passes are assumed to be spread over the whole image.
double work_left(const Job& job, const Band& free) {
  const std::uint32_t height = job.spec.settings.height;
  const Pass* pass = job.pass_of(free);
  const double here = static_cast<double>(pass->coverage.free_samples()) * job.spec.settings.width;
  const double elsewhere = std::max(0.0, job.free_samples() - here * pass->mean_share());
  return here * job.cost.of({free.rows.first, height}, pass->tile_row_shares) /
             (height - free.rows.first) +
         elsewhere * job.cost.of_all() / height;
}

/// Returns a band that begins at the first row of `free` and does not mix suspect rows with others:
/// either the rows of `band` before the next suspect band, or one piece of a suspect band. `band`:
/// the band that would be cut if no rows were suspect. The piece stays the same at each attempt, so
/// that crashes are counted against the same rows.
Band separate_suspects(const Job& job, const Band& free, Band band) {
  const std::uint32_t first = band.rows.first;
  std::uint32_t next = free.rows.last;  // where the next suspect band begins
  std::optional<std::uint32_t> piece;
  for (const Suspicion& one : job.suspicions) {
    const RowRange& rows = one.band.rows;
    if (!overlap(one.band, free)) {
      continue;
    }
    if (rows.first > first) {
      next = std::min(next, rows.first);
    } else {
      piece = std::min({piece.value_or(free.rows.last), rows.last, first + one.piece_rows});
    }
  }
  const std::uint32_t last = std::min(piece.value_or(band.rows.last), next);
  // A band that was cut by samples is never made longer, because its rows are costly.
  band.rows.last = band.samples == free.samples ? last : std::min(band.rows.last, last);
  return band;
}

}  // namespace

std::uint32_t max_rows(std::uint32_t width) {
  return static_cast<std::uint32_t>(
      std::max<std::uint64_t>(1, wire::kBandBytes / (width * kBytesPerPixel)));
}

Band size_band(const Sizing& sizing) {
  Band band = sizing.free;
  const double full = sizing.work_rate * sizing.target_s;  // work in the target time
  const RowRange first_tiles{band.rows.first,
                             std::min(end_of_tile_row(band.rows.first), band.rows.last)};
  const double of_first_tiles =
      sizing.cost->of(first_tiles, sizing.tile_row_shares) * static_cast<double>(sizing.width);
  while (static_cast<double>(band.samples.samples()) * of_first_tiles > 2 * full &&
         band.samples.blocks() > 1) {
    band.samples = split(band.samples).left;
  }
  if (band.samples != sizing.free.samples &&
      static_cast<double>(band.samples.samples()) * of_first_tiles <= 2 * full) {
    band.rows.last = band.rows.first + std::min(first_tiles.count(), max_rows(sizing.width));
    return band;
  }
  // Half of the worker's share of the work that is left, as in guided self-scheduling.
  const double guided = sizing.work_left * sizing.farm_share / 2;
  const double want =
      std::min(full * (sizing.measured ? 1 : kFirst), std::max(guided, full * kMin));
  const std::uint32_t fitting = sizing.cost->fitting(
      band.rows, want / (static_cast<double>(band.samples.samples()) * sizing.width),
      sizing.tile_row_shares);
  band.rows.last = at_edge_of_tiles(
      {band.rows.first, band.rows.first + std::min(fitting, max_rows(sizing.width))},
      std::min(sizing.free.rows.last, band.rows.first + max_rows(sizing.width)));
  return band;
}

std::optional<Band> BandChooser::choose(Job& job, const Worker& worker) const {
  // Frames need no probes, because the time of a sequence is predicted from the frames that are
  // done.
  const auto probe = job.spec.sequence == 0 ? next_probe(job, worker) : std::nullopt;
  return probe ? cut(job, worker, *probe) : choose_free(job, worker);
}

std::optional<Band> BandChooser::choose_free(const Job& job, const Worker& worker) const {
  const auto free = first_free(job, worker);
  return free ? std::optional(cut(job, worker, *free)) : std::nullopt;
}

Band BandChooser::cut(const Job& job, const Worker& worker, const Band& free) const {
  return separate_suspects(job, free, sized(job, worker, free));
}

std::optional<Band> BandChooser::first_free(const Job& job, const Worker& worker) const {
  const std::vector<Band> avoid = eligibility_.left_to_others(job, worker);
  for (const Pass& pass : job.passes) {
    for (auto free = pass.coverage.free_from(0); free;
         free = pass.coverage.free_from(free->rows.last)) {
      if (const auto piece = without(*free, avoid)) {
        return piece;
      }
    }
  }
  return std::nullopt;
}

std::optional<Band> BandChooser::next_probe(Job& job, const Worker& worker) const {
  const std::uint32_t height = job.spec.settings.height;
  while (job.probes < probes_of(height)) {
    const RowRange rows = probe(height, job.probes++);
    if (auto free = job.passes.front().coverage.free_at(rows.first)) {
      free->rows.last = std::min(free->rows.last, rows.last);
      if (const auto band = without(*free, eligibility_.left_to_others(job, worker))) {
        return band;
      }
    }
  }
  return std::nullopt;
}

Band BandChooser::sized(const Job& job, const Worker& worker, const Band& free) const {
  Sizing sizing;
  sizing.free = free;
  sizing.width = job.spec.settings.width;
  sizing.cost = &job.cost;
  sizing.tile_row_shares = job.pass_of(free)->tile_row_shares;
  sizing.work_rate = work_rate(worker, job);
  sizing.measured = has_work_rate(worker, job);
  const double farm =
      std::max(sizing.work_rate,
               work_rate_per_thread(job) * static_cast<double>(context_.available.threads()));
  // size_band() gives the band half of this share of the work that is left. So with a share of 2,
  // the band may have all of it. This is for a job that only this worker is to render.
  sizing.farm_share = job.alone ? 2 : sizing.work_rate / farm;
  sizing.work_left = std::max(work_left(job, free), job.cost_of(free));
  sizing.target_s = context_.options.band_target_s;
  return size_band(sizing);
}

}  // namespace bandsaw::coordinator
