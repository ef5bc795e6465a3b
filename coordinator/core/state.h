#pragma once

// All that the core knows, and what each input does to it. Durable facts change in apply(record)
// only, whether they are new or replayed; sessions, leases and measurements live as long as the
// process and are changed where they happen.
//
// Where to look: job_inputs.cpp, pause_inputs.cpp, worker_inputs.cpp, band_inputs.cpp (one function
// an input), replay.cpp (durable facts), leasing.cpp (who renders what), faults.cpp (what goes
// wrong), audits.cpp and quarantine.cpp (who is wrong), views.cpp (what is shown), invariants.cpp.

#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/core/core.h"
#include "coordinator/core/core_clock.h"
#include "coordinator/core/hunger.h"
#include "coordinator/core/job.h"
#include "coordinator/core/kept_away.h"
#include "coordinator/core/leases.h"
#include "coordinator/core/loss_rate.h"
#include "coordinator/core/workers.h"

namespace bandsaw::coordinator {

class Core::State {
 public:
  explicit State(CoreOptions options);

  Step step(const Input& input, Time now);
  void apply(const Record& record);
  void restore(const input::BandStored& band);
  void note_damage(JobId id, std::uint64_t bytes);
  Step replayed(Time now);
  std::vector<Record> snapshot() const;

  std::optional<std::vector<RowRange>> wanted(JobId job, const Band& band) const;
  TileSamples tiles(JobId job, const Band& band) const;
  std::vector<std::string> why(JobId id, Time now) const;
  std::optional<JobView> view(JobId id, Time now) const;
  std::vector<JobView> job_views(Time now) const;
  std::vector<WorkerView> worker_views(Time now) const;
  std::optional<std::string> broken_invariant() const;

 private:
  void on(const input::Submit& in);
  void on(const input::Cancel& in);
  void on(const input::Pause& in);
  void on(const input::Resume& in);
  void on(const input::SetPriority& in);
  void on(const input::Hello& in);
  void on(const input::Heartbeat& in);
  void on(const input::Draining& in);
  void on(const input::Lost& in);
  void on(const input::BandFailed& in);
  void on(const input::BandStored& in);
  void on(const input::PassMerged& in);
  void on(const input::ResultWritten& in);
  void on(const input::BandsDamaged& in);
  void on(const input::StorageFailed& in);
  void on(const input::StorageBack& in);
  void on(const input::Quarantine& in);
  void on(const input::LiftQuarantine& in);
  void on(const input::Forget& in);
  void on(const input::Tick& in);

  void apply(const record::JobAdded& r);
  void apply(const record::PassPlanned& r);
  void apply(const record::TilesPlanned& r);
  void apply(const record::SamplesFixed& r);
  void apply(const record::StateChanged& r);
  void apply(const record::PriorityChanged& r);
  void apply(const record::HoldChanged& r);
  void apply(const record::TimeSpent& r);
  void apply(const record::Figures& r);
  void apply(const record::ErrorMeasured& r);
  void apply(const record::ShareCounted& r);
  void apply(const record::LastWords& r);
  void apply(const record::JobForgotten& r);
  void apply(const record::WorkerJoined& r);
  void apply(const record::WorkerLeft& r);
  void apply(const record::BandAudited& r);
  void apply(const record::BandLost& r);
  void apply(const record::ErrorForgotten& r);
  void apply(const record::WorkerQuarantined& r);
  void apply(const record::QuarantineLifted& r);

  /// Who comes first: the highest priority, then the oldest.
  using Rank = std::pair<std::int32_t, JobId>;
  static Rank rank(const Job& job) { return {-job.priority, job.id}; }

  /// Applies a new fact and puts it into the step's records.
  template <class R>
  void emit(R record) {
    apply(record);
    step_.records.emplace_back(std::in_place_type<R>, std::move(record));
  }
  /// In place: g++ 12 warns of a moved variant's other alternatives.
  template <class A>
  void act(A action) {
    step_.actions.emplace_back(std::in_place_type<A>, std::move(action));
  }
  Step finish_step();
  void say_revoked();

  Job* find(JobId id);
  const Job* find(JobId id) const;
  std::optional<std::string> refusal(const JobSpec& spec) const;

  // Jobs.
  void plan_first(Job& job);
  void plan_until(Job& job, std::uint64_t samples);
  bool plan_timed(Job& job);
  void look_at_error(Job& job, const input::PassMerged& look);
  void note_error(const Job& job, std::uint64_t samples, const ErrorEstimate& error);
  void fix(Job& job, std::uint64_t samples);
  /// Ends the job's work once every pass is there, or its time is up.
  void settle(Job& job);
  void end(Job& job, JobState state, const std::string& reason);
  Job* asked_of(JobId id);
  void resume(Job& job);
  void take_back_from_paused();
  static void add_records(const Job& job, std::vector<Record>& out);
  void touch(const Job& job);
  double elapsed(const Job& job, Time now) const;
  record::Figures figures(const Job& job) const;
  void note_time(const Job& job);

  // Workers.
  void welcome(Worker& worker, const input::Hello& in);
  void take_up(Worker& worker, const std::vector<WorkerHello::Held>& held);
  bool take_up_one(Worker& worker, const WorkerHello::Held& held);
  void lose(Worker& worker, const std::string& reason);
  void forget_refusals();
  bool is_silent(const Worker& worker) const;
  void note_those_lost_together();
  void await_rest_of_former(const Worker& back);
  void give_up_on_former();
  bool waits_for_former() const;

  // Leases.
  void lease_out();
  void hand_out();
  bool lease_to(Worker& worker);
  std::optional<Band> probe_for(Job& job, const Worker& worker) const;
  std::optional<Band> free_for(const Job& job, const Worker& worker) const;
  Band sized(const Job& job, const Worker& worker, const Band& free) const;
  double per_thread(const Job& job) const;
  double pace(const Worker& worker, const Job& job) const;
  double work_left(const Job& job, const Band& free) const;
  void grant(Worker& worker, Job& job, Pass& pass, const Band& band, LeaseId id);
  void hand_over(Worker& worker, Job& job, const Pass& pass, Lease lease);
  enum class Revoke { kNo, kYes };
  void end_lease(LeaseId id, Revoke revoke);
  void end_overtaken(const std::vector<LeaseId>& leases);
  void end_all(const std::vector<LeaseId>& leases, Revoke revoke);
  void advanced(const Worker& worker, std::size_t from);

  // The tail: nothing is free, and workers are idle.
  struct Late;
  bool share_the_tail();
  std::vector<Worker*> idle_workers();
  std::vector<Late> late_leases() const;
  double rest_of(const Lease& lease) const;
  bool steal(const Late& late, std::vector<Worker*>& idle);
  bool copy(const Late& late, std::vector<Worker*>& idle);
  bool move_audit(const Late& late, std::vector<Worker*>& idle);
  std::vector<Worker*> helpers(const Job& job, const Lease& lease,
                               const std::vector<Worker*>& idle) const;
  RowRange not_copied(const Job& job, const Lease& lease) const;
  void promote_copies(Job& job, LeaseId ended);
  void end_useless_copies(Job& job);

  // Bands.
  void measure(Worker& worker, Job& job, const input::BandStored& in);
  void measure_pace(Worker& worker, Job& job, const input::BandStored& in);
  /// Ends the lease that this is the result of, if its worker still has it.
  void end_own(const Worker& worker, const input::BandStored& in);
  Coverage::Change store(Job& job, Pass& pass, const input::BandStored& in, const Witness& witness);
  void count_share(Job& job, const input::BandStored& in, std::uint64_t renderer,
                   std::uint64_t samples);

  // Audits.
  Witness witness_of(const input::BandStored& in) const;
  static Witness witness_of(const Worker& worker);
  Witness witness_of(std::uint64_t renderer) const;
  void open_audits(Job& job, const input::BandStored& in, const Witness& witness,
                   const std::vector<RowRange>& rows);
  void open_dispute(Job& job, const Pass& pass, const input::BandStored& in);
  /// What a result says of rows that are there already.
  void weigh(Job& job, const Pass& pass, const input::BandStored& in, const Witness& witness);
  void weigh_replayed();
  bool judge_one(Job& job);
  bool may_audit(const Worker& worker, const Job& job, const Audit& audit) const;
  Audit* audit_for(const Worker& worker, Job& job) const;
  Audit* audit_of(const Lease& lease);
  void grant_audit(Worker& worker, Job& job, Audit& audit);
  void give_up_audit(const Lease& lease, const Worker& worker, const std::string& reason);
  bool audits_hold(const Job& job) const;
  std::string audit_reason(const Job& job) const;

  // Quarantine.
  std::string shown_name(const Witness& witness) const;
  bool is_quarantined(const Witness& witness) const;
  std::optional<std::string> kept_away(const std::string& instance, const std::string& said) const;
  static std::string quarantine_reason(const Quarantined& one);
  void quarantine(const Witness& witness, const std::string& reason);
  void send_away(Worker& worker);
  void learn_name(const WorkerHello& worker);
  void retract(Job& job, std::uint64_t renderer, const std::string& why);
  void close_audits(Job& job, const Band& band, std::uint64_t renderer);
  void note_lost_audited(Job& job);
  std::vector<WorkerView> quarantined_views() const;
  void add_quarantine(std::vector<Record>& out) const;

  // What goes wrong.
  void add_fault(Job& job, Worker& worker, const Band& band, const std::string& reason);
  std::vector<Band> left_to_others(const Job& job, const Worker& worker) const;
  std::string name_of_instance(const std::string& instance) const;
  bool left_to_others(const Job& job, const Worker& worker, const Band& band) const;
  bool may_render(const Worker& worker, const Job& job) const;
  bool someone_may_render(const Job& job) const;
  bool someone_else(const Job& job, const Band& band) const;
  std::vector<Losing> in_hand(const Worker& worker) const;
  void add_losses(const Worker& worker, const std::vector<Losing>& lost);
  void add_loss(Job& job, const Worker& worker, const Losing& lost);
  void weigh_losses(Job& job, const Worker& worker, const Band& band);
  static bool is_suspect(const Job& job, const Band& band);
  static bool has_witness(const Job& job, const Band& band);
  bool another_machine(const Job& job, const Band& band) const;
  static Band narrowed(const Job& job, const Band& free, Band band);
  bool has_suspect(const Worker& worker) const;
  void forgive_losses(const Worker& worker);
  static void shrink_losses(Job& job, const Band& stored);
  void check_unable(Job& job);
  void check_silence();
  void check_progress();

  // Views.
  std::string waiting_reason(const Job& job) const;
  std::vector<std::string> why_of_state(const Job& job, Time now) const;
  std::string busy_with(const Job& job) const;
  std::vector<std::string> working_on(const Job& job) const;
  std::vector<std::string> not_working_on(const Job& job) const;
  void remember_refusal(const WorkerHello& worker, const std::string& reason);
  double fraction(const Job& job, Time now) const;
  double remaining(const Job& job, Time now) const;
  double expected_samples(const Job& job) const;
  double expected_work(const Job& job) const;
  /// In seconds of a thread: all that nobody has been given yet, and what is left of the rest.
  double time_of_free(const Job& job) const;
  double time_of_leased(const Job& job, Time now) const;
  /// Of the workers that render it; of those that render another job too, by what they hold of it.
  double threads_at(const Job& job) const;
  std::vector<JobWorkerView> lines(const Job& job) const;

  // Invariants, each a sentence when it does not hold.
  std::optional<std::string> broken_leases() const;
  std::optional<std::string> broken_workers() const;
  std::optional<std::string> broken_job(const Job& job) const;
  std::optional<std::string> broken_pass(const Job& job, const Pass& pass) const;

  CoreOptions options_;
  CoreClock clock_;
  Step step_;  ///< being made

  std::map<JobId, Job> jobs_;
  std::map<std::string, JobId> by_request_;
  std::set<JobId> active_;   ///< not final
  std::set<Rank> leasable_;  ///< running and perhaps with free rows; the others have none
  JobId next_job_ = 1;

  Workers workers_;
  Hunger hunger_;
  Leases leases_;
  LossRate loss_rate_;                                 ///< in this life of the coordinator
  Time tail_again_at_ = 0;                             ///< wall clock
  std::map<SessionId, std::vector<LeaseId>> revoked_;  ///< in this step

  static constexpr std::size_t kRefusalsKept = 32;
  std::deque<Refusal> refusals_;  ///< the newest kRefusalsKept

  static constexpr std::size_t kQuarantinedKept = 1'024;
  /// By renderer: what one rendered is void for ever, its name is barred until it is lifted.
  std::map<std::uint64_t, Quarantined> quarantined_;

  std::vector<input::BandStored> met_;   ///< being replayed, with rows that were there already
  std::set<std::string> joined_;         ///< instances, as journalled
  std::set<std::string> lost_together_;  ///< instances; nobody was left
  std::set<std::string> former_;         ///< instances that are awaited (former.cpp)
  Time awaited_until_ = 0;               ///< patience clock
};

}  // namespace bandsaw::coordinator
