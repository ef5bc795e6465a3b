#include "coordinator/core/core.h"

#include <utility>

#include "coordinator/core/state.h"

namespace bandsaw::coordinator {

Core::Core(CoreOptions options) : state_(std::make_unique<State>(std::move(options))) {}
Core::~Core() = default;
Core::Core(Core&&) noexcept = default;
Core& Core::operator=(Core&&) noexcept = default;

Step Core::step(const Input& input, Time now) { return state_->step(input, now); }
void Core::replay(const Record& record) { state_->apply(record); }
void Core::replay(const input::BandStored& band) { state_->restore(band); }
void Core::replay_damage(JobId job, std::uint64_t bytes) { state_->note_damage(job, bytes); }
Step Core::replayed(Time now) { return state_->replayed(now); }

std::optional<std::vector<RowRange>> Core::wanted(JobId job, const Band& band) const {
  return state_->wanted(job, band);
}

TileSamples Core::tiles(JobId job, const Band& band) const { return state_->tiles(job, band); }
std::vector<Record> Core::snapshot() const { return state_->snapshot(); }
std::optional<JobView> Core::job(JobId id, Time now) const { return state_->view(id, now); }
std::vector<std::string> Core::why(JobId id, Time now) const { return state_->why(id, now); }
std::vector<JobView> Core::jobs(Time now) const { return state_->job_views(now); }
std::vector<WorkerView> Core::workers(Time now) const { return state_->worker_views(now); }

std::optional<std::string> Core::broken_invariant() const { return state_->broken_invariant(); }

// At most a third of the patience with a silent worker is used up by one input.
Core::State::State(CoreOptions options)
    : options_(std::move(options)),
      clock_(options_.heartbeat_timeout_s / 3),
      leases_(options_.epoch) {}

Step Core::State::step(const Input& input, Time now) {
  clock_.advance(now);
  std::visit([this](const auto& in) { on(in); }, input);
  return finish_step();
}

Step Core::State::finish_step() {
  say_revoked();
  lease_out();
  say_revoked();
  return std::exchange(step_, Step{});
}

void Core::State::say_revoked() {
  for (auto& [session, leases] : revoked_) {
    act(action::Revoke{session, std::move(leases)});
  }
  revoked_.clear();
}

Job* Core::State::find(JobId id) {
  const auto it = jobs_.find(id);
  return it == jobs_.end() ? nullptr : &it->second;
}

const Job* Core::State::find(JobId id) const {
  const auto it = jobs_.find(id);
  return it == jobs_.end() ? nullptr : &it->second;
}

}  // namespace bandsaw::coordinator
