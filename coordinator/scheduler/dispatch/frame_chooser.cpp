// Each frame of a sequence is rendered by a job of its own, its frame job. order_for() lists the
// frame jobs of a sequence in the order in which a worker should take them: first the frame that it
// renders now, then the frames that nobody renders, and then the frames that other workers render.

#include "coordinator/scheduler/dispatch/frame_chooser.h"

#include <algorithm>

namespace bandsaw::coordinator {

bool FrameChooser::is_being_rendered(JobId job) const {
  const auto workers = workers_of_.find(job);
  return workers != workers_of_.end() &&
         std::any_of(workers->second.begin(), workers->second.end(), [&](WorkerId id) {
           const Worker* worker = context_.workers.by_id(id);
           return worker != nullptr && worker->eligible();
         });
}

std::vector<Job*> FrameChooser::order_for(const Worker& worker, const Sequence& sequence) {
  std::vector<Job*> own;
  std::vector<Job*> fresh;
  std::vector<Job*> others;
  const auto at = frame_of_.find(worker.id);
  for (const JobId id : sequence.open_jobs()) {
    Job& job = context_.jobs.at(id);
    if (!job.work_rate.measured() && sequence.work_rate.measured()) {
      job.work_rate = sequence.work_rate;
      job.cost = sequence.cost;
    }
    if (job.state == JobState::kRunning) {
      const bool is_own = at != frame_of_.end() && at->second == id;
      (is_own ? own : is_being_rendered(id) ? others : fresh).push_back(&job);
    }
  }
  const auto free = static_cast<std::size_t>(
      std::count_if(fresh.begin(), fresh.end(), [](const Job* job) { return job->any_free(); }));
  // True if the frames that no worker renders yet are at least as many as the workers.
  const bool many =
      free + sequence.counts().of(FrameState::kWaiting) >= context_.available.eligible();
  for (std::vector<Job*>* jobs : {&fresh, &others}) {
    own.insert(own.end(), jobs->begin(), jobs->end());
  }
  for (Job* job : own) {
    job->alone = many;
  }
  return own;
}

void FrameChooser::joined(const Worker& worker, const Job& job) {
  JobId& frame = frame_of_[worker.id];
  if (frame == job.id) {
    return;
  }
  if (const auto left = workers_of_.find(frame); left != workers_of_.end()) {
    left->second.erase(worker.id);
    if (left->second.empty()) {
      workers_of_.erase(left);
    }
  }
  frame = job.id;
  workers_of_[job.id].insert(worker.id);
  forget_final();
}

/// Removes the entries of workers that are not known any more and of frame jobs that are over. A
/// map is searched only when it has become about twice as large as needed, which keeps the average
/// cost low.
void FrameChooser::forget_final() {
  if (frame_of_.size() > 2 * context_.workers.all().size() + 16) {
    std::erase_if(frame_of_,
                  [&](const auto& one) { return context_.workers.by_id(one.first) == nullptr; });
  }
  if (workers_of_.size() > 2 * context_.workers.all().size() + 16) {
    std::erase_if(workers_of_,
                  [&](const auto& one) { return !context_.jobs.active().contains(one.first); });
  }
}

}  // namespace bandsaw::coordinator
