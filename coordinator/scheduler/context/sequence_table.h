#pragma once

// All known sequences (jobs of many frames), and which of them are active (not final).

#include <map>
#include <optional>
#include <set>
#include <string>

#include "coordinator/scheduler/model/sequence.h"

namespace bandsaw::coordinator {

class SequenceTable {
 public:
  Sequence* find(JobId id);
  const Sequence* find(JobId id) const;
  Sequence& at(JobId id) { return all_.at(id); }
  const Sequence& at(JobId id) const { return all_.at(id); }
  std::map<JobId, Sequence>& all() { return all_; }
  const std::map<JobId, Sequence>& all() const { return all_; }
  /// Returns the id of the sequence that was submitted with this request id. std::nullopt: there
  /// is none.
  std::optional<JobId> by_request(const std::string& request_id) const;

  /// Adds a sequence, which is active. `pixel_version`: the coordinator's pixel version (it changes
  /// whenever rendered pixels change) when the sequence was submitted; 0: unknown.
  void add(JobId id, const SequenceSpec& spec, std::uint32_t pixel_version);
  void remove(JobId id);

  /// Sequences that are not final.
  const std::set<JobId>& active() const { return active_; }
  void set_active(JobId id, bool active);

 private:
  std::map<JobId, Sequence> all_;
  std::map<std::string, JobId> by_request_;
  std::set<JobId> active_;
};

}  // namespace bandsaw::coordinator
