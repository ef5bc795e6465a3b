// LocalPlan chooses the passes of a render on this machine. next() plans all passes up to the next
// checkpoint (a number of samples per pixel) at once, and checks the stop rule when the passes are
// done. An adaptive render first renders until its error has fallen to a limit that is larger than
// its target. Then wants_tiles() is true, and plan() is called once. plan() sets how many samples
// each half tile takes. A half tile has half of the pixels of a square of 16 x 16.

#include "coordinator/cli/render/local_plan.h"

#include "coordinator/scheduler/model/pass_plan.h"

namespace bandsaw::coordinator {

std::optional<SampleRange> LocalPlan::take_pass(std::uint64_t from, std::uint64_t to) {
  if (passes_.empty()) {
    const std::vector<SampleRange> planned = passes_between(from, to);
    passes_.assign(planned.begin(), planned.end());
    planned_ = to;
  }
  const SampleRange pass = passes_.front();
  passes_.pop_front();
  return pass;
}

std::optional<SampleRange> LocalPlan::next(std::uint64_t samples, double error, double seconds) {
  if (!passes_.empty()) {
    return take_pass(samples, samples);  // plans nothing, so the range is not used
  }
  if (const auto* rule = std::get_if<StopAtSamples>(&stop_)) {
    return samples < rule->samples ? take_pass(samples, rule->samples) : std::nullopt;
  }
  if (const auto* rule = std::get_if<StopAtError>(&stop_)) {
    const bool reached = error >= 0 && error <= rule->relative_rmse;
    if (samples > 0 && (reached || samples >= rule->max_samples)) {
      return std::nullopt;
    }
    const double target =
        next_target(rule->relative_rmse, /*tiles_to_plan=*/rule->adaptive && !schedule_);
    return take_pass(samples, next_checkpoint(samples, error, target, rule->max_samples));
  }
  const auto& rule = std::get<StopAtTime>(stop_);
  if (samples == 0) {
    return next_timed_pass(/*from=*/0, /*fits=*/0, rule.max_samples);
  }
  // The number of samples per pixel that can be rendered in the rest of the time.
  const double fits = (rule.seconds - seconds) * static_cast<double>(samples) / seconds;
  if (samples >= rule.max_samples || fits < static_cast<double>(kBlockSamples)) {
    return std::nullopt;
  }
  return next_timed_pass(samples, fits, rule.max_samples);
}

bool LocalPlan::wants_tiles(double error) const {
  const auto* rule = std::get_if<StopAtError>(&stop_);
  return rule != nullptr && rule->adaptive && !schedule_ && passes_.empty() &&
         time_to_plan_tiles(error, rule->relative_rmse);
}

void LocalPlan::plan(absl::Span<const HalfTileErrors> tiles, std::uint64_t samples) {
  schedule_.emplace(grid_, plan_tiles(grid_, tiles, samples));
}

}  // namespace bandsaw::coordinator
