// Finds sequences (jobs of many frames) by id and by request id, and keeps the set of those that
// are active (not final).

#include "coordinator/scheduler/context/sequence_table.h"

namespace bandsaw::coordinator {

Sequence* SequenceTable::find(JobId id) {
  const auto it = all_.find(id);
  return it == all_.end() ? nullptr : &it->second;
}

const Sequence* SequenceTable::find(JobId id) const {
  const auto it = all_.find(id);
  return it == all_.end() ? nullptr : &it->second;
}

std::optional<JobId> SequenceTable::by_request(const std::string& request_id) const {
  const auto it = by_request_.find(request_id);
  return it == by_request_.end() ? std::nullopt : std::optional(it->second);
}

void SequenceTable::add(JobId id, const SequenceSpec& spec, std::uint32_t pixel_version) {
  all_.emplace(id, Sequence(id, spec, pixel_version));
  by_request_[spec.request_id] = id;
  active_.insert(id);
}

void SequenceTable::set_active(JobId id, bool active) {
  if (active) {
    active_.insert(id);
  } else {
    active_.erase(id);
  }
}

void SequenceTable::remove(JobId id) {
  if (const Sequence* sequence = find(id)) {
    by_request_.erase(sequence->spec.request_id);
    active_.erase(id);
    all_.erase(id);
  }
}

}  // namespace bandsaw::coordinator
