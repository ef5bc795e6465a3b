#pragma once

// All known jobs, which of them are active (not final), and which are leasable (may have something
// to give to workers).

#include <compare>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "coordinator/scheduler/model/job.h"

namespace bandsaw::coordinator {

class JobTable {
 public:
  /// Order in which jobs are leased: the highest priority first, and at equal priority the lowest
  /// id first. A frame job renders one frame of a sequence (a job of many frames). It is placed by
  /// the id of its sequence. The frame jobs of one sequence are in the order of their own ids.
  struct Rank {
    std::int32_t descending_priority = 0;
    JobId place = 0;  ///< id of the job, or of its sequence
    JobId job = 0;
    friend auto operator<=>(const Rank&, const Rank&) = default;
  };
  static Rank rank(const Job& job) {
    return {-job.priority, job.spec.sequence == 0 ? job.id : job.spec.sequence, job.id};
  }

  Job* find(JobId id);
  const Job* find(JobId id) const;
  Job& at(JobId id) { return all_.at(id); }
  const Job& at(JobId id) const { return all_.at(id); }
  std::map<JobId, Job>& all() { return all_; }
  const std::map<JobId, Job>& all() const { return all_; }
  /// Returns the id of the job that was submitted with this request id. std::nullopt: there is
  /// none.
  std::optional<JobId> by_request(const std::string& request_id) const;
  /// Returns the id of the next job that is added.
  JobId next_id() const { return next_id_; }

  /// Adds a job, which is active. `pixel_version`: the coordinator's pixel version (it changes
  /// whenever rendered pixels change) when the job was submitted; 0: unknown.
  void add(JobId id, const JobSpec& spec, std::uint32_t pixel_version);
  /// Marks an id as used by something else than a job.
  void never_reuse(JobId id) { next_id_ = next_id_ > id ? next_id_ : id + 1; }
  /// Removes a job. If the job is unknown, only marks its id as used.
  void remove(JobId id);
  void set_priority(Job& job, std::int32_t priority);

  /// Jobs that are not final.
  const std::set<JobId>& active() const { return active_; }
  void set_final(JobId id) { active_.erase(id); }

  /// Running jobs that may have free rows or waiting audits (second renderings of stored rows, to
  /// compare). All other running jobs have neither.
  const std::set<Rank>& leasable() const { return leasable_; }
  /// Makes the job leasable if it is running, else does nothing. MUST be called when rows become
  /// free or audits begin to wait.
  void mark_leasable(const Job& job);
  void unmark_leasable(const Job& job) { leasable_.erase(rank(job)); }

 private:
  std::map<JobId, Job> all_;
  std::map<std::string, JobId> by_request_;
  std::set<JobId> active_;
  std::set<Rank> leasable_;
  JobId next_id_ = 1;
};

}  // namespace bandsaw::coordinator
