// Operations of a job that concern several of its passes, or its failures. A pass is a range of
// samples of the whole image.

#include "coordinator/scheduler/model/job.h"

#include <algorithm>

#include "coordinator/scheduler/model/band_text.h"
#include "renderlib/base/check.h"

namespace bandsaw::coordinator {
namespace {

/// Minimum of Pass::tile_row_shares, by which the work of a band is predicted. Such a share is the
/// number of samples taken in a row of tiles, divided by the number with uniform sampling. The
/// minimum is above 0, because rows without samples still have to be sent and stored.
constexpr float kMinShare = 0.01f;

}  // namespace

Job::Job(JobId job, JobSpec job_spec, std::uint32_t version)
    : id(job),
      spec(std::move(job_spec)),
      pixel_version(version),
      cost(spec.settings.height),
      row_times(spec.settings.height) {}

Pass* Job::pass_of(const Band& band) {
  return const_cast<Pass*>(std::as_const(*this).pass_of(band));
}

const Pass* Job::pass_of(const Band& band) const {
  const bool rows_exist =
      band.rows.first < band.rows.last && band.rows.last <= spec.settings.height;
  if (!rows_exist || band.samples.first >= band.samples.last) {
    return nullptr;
  }
  const auto after =
      std::upper_bound(passes.begin(), passes.end(), band.samples.first,
                       [](std::uint64_t first, const Pass& p) { return first < p.samples.first; });
  if (after == passes.begin()) {
    return nullptr;
  }
  const Pass& pass = *std::prev(after);
  // The samples of a band are a node of the summation tree: an aligned power-of-two number of
  // blocks of 8 samples. Only the last block of a pass may have fewer samples.
  const bool whole_blocks = band.samples.last % kBlockSamples == 0;
  const bool node = band.samples.last <= pass.samples.last && is_node(band.samples) &&
                    (whole_blocks || band.samples.last == pass.samples.last);
  return node ? &pass : nullptr;
}

void Job::add_pass(const SampleRange& samples) {
  BANDSAW_CHECK(samples.first == planned_samples(), "passes follow each other");
  const RenderSettings& image = spec.settings;
  Pass& pass =
      passes.emplace_back(Pass{.samples = samples,
                               .coverage = Coverage(samples, image.height),
                               .tiles = schedule_ ? schedule_->next(samples) : TileSamples(),
                               .tile_row_shares = {},
                               .stored = {},
                               .digests = {},
                               .parts = {},
                               .returned = {}});
  for (std::uint32_t row = 0; row < image.height && !pass.tiles.whole(); row += kTileSide) {
    const RowRange rows{row, std::min(row + kTileSide, image.height)};
    const Band band{samples, rows};
    const double all = static_cast<double>(TileSamples().count(image.width, band));
    pass.tile_row_shares.push_back(std::max(
        kMinShare,
        static_cast<float>(static_cast<double>(pass.tiles.count(image.width, band)) / all)));
  }
}

void Job::plan_tiles(TilePlan plan) {
  schedule_.emplace(TileGrid{spec.settings.width, spec.settings.height}, plan);
  tile_plan = std::move(plan);
}

void Job::fix_samples(std::uint64_t samples) {
  fixed_samples = samples;
  while (!passes.empty() && passes.back().samples.first >= samples) {
    passes.pop_back();
  }
  complete_passes_ = std::min(complete_passes_, passes.size());
  std::erase_if(audits, [&](const Audit& audit) { return audit.band().samples.first >= samples; });
  std::erase_if(disputes, [&](const auto& one) { return one.band.samples.first >= samples; });
}

bool Job::retract(WorkerProcessId process) {
  std::erase_if(audits, [&](const Audit& a) { return a.stored().reporter.process == process; });
  for (Audit& audit : audits) {
    audit.forget({.process = process, .machine = {}});
  }
  shares.erase(process);
  bool any = false;
  for (std::size_t i = 0; i < passes.size(); ++i) {
    if (passes[i].retract(process)) {
      complete_passes_ = std::min(complete_passes_, i);
      any = true;
    }
  }
  return any;
}

void Job::remove_stored(const Band& band, WorkerProcessId process) {
  std::erase_if(audited, [&](const std::pair<Band, WorkerProcessId>& one) {
    return one.second == process && overlap(one.first, band);
  });
  settle_disputes(band, process);
  Pass* pass = pass_of(band);
  const std::optional<Totals> lost =
      pass == nullptr ? std::nullopt : pass->remove_stored(band, process);
  if (!lost) {
    return;
  }
  complete_passes_ = std::min(complete_passes_, static_cast<std::size_t>(pass - passes.data()));
  if (const auto share = shares.find(process); share != shares.end()) {
    share->second.samples -= std::min(share->second.samples, lost->samples);
    share->second.cpu_s = std::max(0.0, share->second.cpu_s - lost->cpu_s);
    if (share->second.samples == 0) {
      shares.erase(share);
    }
  }
}

void Job::settle_disputes(const Band& band, WorkerProcessId process) {
  std::erase_if(disputes, [&](const record::RowDisputed& one) {
    return one.stored.process == process && overlap(one.band, band);
  });
}

void Job::count_complete_passes() {
  while (complete_passes_ < passes.size() && passes[complete_passes_].coverage.complete()) {
    passes[complete_passes_].returned.clear();
    ++complete_passes_;
    if (complete_passes_ > kPassesWithDigests) {
      passes[complete_passes_ - kPassesWithDigests - 1].digests.clear();
    }
  }
}

void Job::drop_details() {
  passes.clear();
  failures.clear();
  audits.clear();
  audited.clear();
  disputes.clear();
  pending_checkpoint.reset();
  suspicions.clear();
  shares.clear();
  cost = {};
  row_times = RowTimes(0);
  tile_plan.reset();
  schedule_.reset();
  complete_passes_ = 0;
}

std::uint64_t Job::planned_samples() const {
  return passes.empty() ? 0 : passes.back().samples.last;
}

std::uint64_t Job::complete_samples() const {
  if (is_final(state)) {
    return state == JobState::kDone ? fixed_samples.value_or(0)
           : summary                ? summary->samples_per_pixel
                                    : 0;
  }
  return complete_passes_ == 0 ? 0 : passes[complete_passes_ - 1].samples.last;
}

bool Job::any_free() const {
  return std::any_of(passes.begin() + static_cast<std::ptrdiff_t>(complete_passes_), passes.end(),
                     [](const Pass& pass) { return pass.coverage.any_free(); });
}

bool Job::audit_waits() const {
  return std::any_of(audits.begin(), audits.end(), [](const Audit& a) { return a.lease == 0; });
}

double Job::free_samples() const {
  double sum = 0;
  for (std::size_t i = complete_passes_; i < passes.size(); ++i) {
    sum += static_cast<double>(passes[i].coverage.free_samples()) * passes[i].mean_share();
  }
  return sum * spec.settings.width;
}

std::uint64_t Job::pixels() const {
  return std::uint64_t{spec.settings.width} * spec.settings.height;
}

std::uint64_t Job::samples_of(const Band& band) const {
  return pass_of(band)->tiles_of(band).count(spec.settings.width, band);
}

double Job::cost_of(const Band& band) const {
  if (band.rows.count() == 0) {
    return 0;
  }
  return static_cast<double>(band.samples.samples()) * spec.settings.width *
         cost.of(band.rows, pass_of(band)->tile_row_shares);
}

Totals Job::totals() const {
  Totals sum;
  if (is_final(state) && summary) {
    sum = {summary->samples, summary->counters, summary->cpu_s};
  }
  for (const Pass& pass : passes) {
    sum.add(pass.stored);
  }
  if (state == JobState::kDone && !summary) {
    sum.samples = fixed_samples.value_or(0) * pixels();
  }
  return sum;
}

std::vector<WorkerShare> Job::largest_shares() const {
  std::vector<WorkerShare> out;
  for (const auto& [process, share] : shares) {
    out.push_back(share);
  }
  std::stable_sort(out.begin(), out.end(), [](const WorkerShare& a, const WorkerShare& b) {
    return a.samples > b.samples;
  });
  out.resize(std::min(out.size(), kMaxFinalShares));
  return out;
}

std::uint64_t Job::max_samples() const {
  struct MaxSamples {
    std::uint64_t operator()(const StopAtSamples& rule) const { return rule.samples; }
    std::uint64_t operator()(const StopAtError& rule) const { return rule.max_samples; }
    std::uint64_t operator()(const StopAtTime& rule) const { return rule.max_samples; }
  };
  return std::visit(MaxSamples{}, spec.stop);
}

double Job::elapsed(Time now) const {
  if (is_final(state)) {
    return summary ? summary->elapsed_s : 0;
  }
  return clock.elapsed(now);
}

void Job::stop_clock(Time now) {
  clock.stop(now);
  throughput = {};
}

Audit* Job::audit_under(LeaseId lease) {
  const auto audit =
      std::find_if(audits.begin(), audits.end(), [&](const Audit& a) { return a.lease == lease; });
  return audit == audits.end() ? nullptr : &*audit;
}

bool Job::is_suspect(const Band& band) const {
  return std::any_of(suspicions.begin(), suspicions.end(),
                     [&](const Suspicion& one) { return overlap(one.band, band); });
}

bool Job::has_conclusive_crash(const Band& band) const {
  return std::any_of(suspicions.begin(), suspicions.end(), [&](const Suspicion& one) {
    return one.conclusive && overlap(one.band, band);
  });
}

void Job::clear_suspicion(const Band& stored) {
  for (Suspicion& one : suspicions) {
    RowRange& rows = one.band.rows;
    if (!overlap(one.band, stored)) {
      continue;
    }
    if (stored.rows.first <= rows.first) {
      rows.first = std::min(rows.last, stored.rows.last);
    } else if (stored.rows.last >= rows.last) {
      rows.last = stored.rows.first;
    }
  }
  std::erase_if(suspicions, [](const Suspicion& one) { return one.band.rows.count() == 0; });
}

}  // namespace bandsaw::coordinator
