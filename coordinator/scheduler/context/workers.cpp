// Finds workers by id, session (connection), instance and process. The instance is the id that a
// worker process chooses for itself; Worker::process is a hash of the instance. If the name of a
// new worker is taken, a number is appended to it. Of the workers that have left, only the kMaxGone
// that left last are kept.

#include "coordinator/scheduler/context/workers.h"

#include <algorithm>

#include "coordinator/scheduler/api/worker_process.h"

namespace bandsaw::coordinator {

Worker* Workers::by_id(WorkerId id) {
  const auto it = all_.find(id);
  return it == all_.end() ? nullptr : &it->second;
}

const Worker* Workers::by_id(WorkerId id) const {
  const auto it = all_.find(id);
  return it == all_.end() ? nullptr : &it->second;
}

Worker* Workers::by_session(SessionId session) {
  const auto it = by_session_.find(session);
  return it == by_session_.end() ? nullptr : by_id(it->second);
}

Worker* Workers::by_instance(const std::string& instance) {
  const auto it = by_instance_.find(instance);
  return it == by_instance_.end() ? nullptr : by_id(it->second);
}

const Worker* Workers::by_instance(const std::string& instance) const {
  const auto it = by_instance_.find(instance);
  return it == by_instance_.end() ? nullptr : by_id(it->second);
}

const Worker* Workers::by_process(WorkerProcessId process) const {
  const auto it = std::find_if(all_.begin(), all_.end(),
                               [&](const auto& entry) { return entry.second.process == process; });
  return it == all_.end() ? nullptr : &it->second;
}

std::string Workers::name_of(const std::string& instance) const {
  const Worker* known = by_instance(instance);
  return known == nullptr ? instance : known->name;
}

std::size_t Workers::connected_browsers() const {
  return static_cast<std::size_t>(std::count_if(all_.begin(), all_.end(), [](const auto& entry) {
    return entry.second.session && entry.second.browser;
  }));
}

Worker& Workers::add(const std::string& instance, const std::string& name, bool browser) {
  std::string unique = name;
  for (std::uint32_t number = 2; by_name_.contains(unique); ++number) {
    unique = name + "-" + std::to_string(number);
  }
  Worker& worker = all_[next_];
  worker.id = next_++;
  worker.instance = instance;
  worker.process = worker_process_id(instance);
  worker.name = unique;
  worker.reported_name = name;
  worker.browser = browser;
  by_instance_[instance] = worker.id;
  by_name_[unique] = worker.id;
  gone_.push_back(worker.id);  // connect() removes it again
  return worker;
}

void Workers::connect(Worker& worker, SessionId session) {
  if (worker.session) {
    by_session_.erase(*worker.session);
  }
  worker.session = session;
  by_session_[session] = worker.id;
  std::erase(gone_, worker.id);
}

void Workers::disconnect(Worker& worker) {
  if (worker.session) {
    by_session_.erase(*worker.session);
    worker.session.reset();
    gone_.push_back(worker.id);
  }
  forget_gone();
}

void Workers::forget_gone() {
  while (gone_.size() > kMaxGone) {
    const auto it = all_.find(gone_.front());
    by_instance_.erase(it->second.instance);
    by_name_.erase(it->second.name);
    all_.erase(it);
    gone_.erase(gone_.begin());
  }
}

}  // namespace bandsaw::coordinator
