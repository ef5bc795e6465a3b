#pragma once

// The workers that are there, and for a while those that were.

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "coordinator/core/leases.h"
#include "coordinator/core/speed.h"
#include "coordinator/core/types.h"

namespace bandsaw::coordinator {

struct Worker {
  WorkerId id = 0;
  std::string instance;
  std::uint64_t renderer = 0;  ///< core/renderer.h: of the instance
  std::string name;            ///< unique among those known
  std::string said;            ///< the name that it says itself: of its machine
  std::string address;
  std::string build;
  std::uint32_t threads = 1;
  std::uint32_t credits = 1;         ///< leases it may hold
  std::optional<SessionId> session;  ///< none: it is gone
  bool draining = false;
  bool fell_silent = false;  ///< before it was lost last
  bool quarantined = false;  ///< it gets no more work
  std::string doing;
  std::string reason;           ///< why it is gone, drains or is quarantined
  Time connected_at = 0;        ///< wall clock
  Time heard_at = 0;            ///< patience clock
  std::vector<LeaseId> leases;  ///< in the order given, which is the order it renders them in
  /// Leases that it was told to drop, and has not been heard of since without: it may be rendering
  /// one of them.
  std::set<LeaseId> dropping;
  Speed speed;

  /// Of one job that is not final.
  struct OnJob {
    Speed speed;               ///< pixel samples a second: what people see
    Speed pace;                ///< work a second (cost_map.h): what bands are sized by
    std::uint32_t bands = 0;   ///< measured
    std::uint32_t faults = 0;  ///< since a band of it was stored
  };
  std::map<JobId, OnJob> on_job;

  bool eligible() const { return session && !draining && !quarantined; }
  bool hungry() const { return eligible() && leases.size() < credits; }
};

class Workers {
 public:
  Worker* by_id(WorkerId id);
  const Worker* by_id(WorkerId id) const;
  Worker* by_session(SessionId session);
  Worker* by_instance(const std::string& instance);
  const Worker* by_instance(const std::string& instance) const;
  /// Looks at all: for what is rare.
  const Worker* by_renderer(std::uint64_t renderer) const;

  /// A worker that was not known, under a name that no other has.
  Worker& add(const std::string& instance, const std::string& name);
  void connect(Worker& worker, SessionId session);
  /// It stays known; the oldest of many that are gone is forgotten.
  void disconnect(Worker& worker);

  std::map<WorkerId, Worker>& all() { return all_; }
  const std::map<WorkerId, Worker>& all() const { return all_; }
  std::size_t connected() const { return by_session_.size(); }

 private:
  static constexpr std::size_t kGoneKept = 512;
  void forget_gone();

  std::map<WorkerId, Worker> all_;
  std::map<std::string, WorkerId> by_instance_;
  std::map<SessionId, WorkerId> by_session_;
  std::map<std::string, WorkerId> by_name_;
  std::vector<WorkerId> gone_;  ///< oldest first
  WorkerId next_ = 1;
};

}  // namespace bandsaw::coordinator
