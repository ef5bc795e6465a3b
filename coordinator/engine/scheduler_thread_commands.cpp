// Commands of users. Each command makes one step of the scheduler at once. The user is answered
// when the records of this step are in the journal.

#include <algorithm>
#include <utility>
#include <variant>

#include "absl/strings/str_cat.h"
#include "coordinator/engine/scheduler_thread.h"

namespace bandsaw::coordinator {

void SchedulerThread::submit(const Input& input, Answer<JobId> answer) {
  if (!journal_status_.ok() || !disk_status_.ok()) {
    answer(journal_status_.ok() ? disk_status_ : journal_status_);
    return;
  }
  const Step step = run(input);
  const bool added =
      std::any_of(step.records.begin(), step.records.end(), [](const Record& record) {
        return std::holds_alternative<record::JobAdded>(record) ||
               std::holds_alternative<record::SequenceAdded>(record);
      });
  commit_queue_.completion([this, job = step.job, added, decided = step.status,
                            answer = std::move(answer)](const absl::Status& journalled) mutable {
    if (!decided.ok()) {
      answer(decided);
    } else if (!journalled.ok()) {
      // The submitter receives an error. So the job must not start when the disk is back, and a
      // second submit with the same request id must not return this job. A job that existed before
      // this submit is kept.
      if (added) {
        run(input::Cancel{.job = job});
        forget({job});
      }
      answer(absl::ResourceExhaustedError(journalled.message()));
    } else {
      answer(job);
    }
  });
}

void SchedulerThread::command(JobId id, const Input& input, Answer<JobView> answer) {
  if (!journal_status_.ok()) {
    answer(journal_status_);
    return;
  }
  const Step step = run(input);
  commit_queue_.completion([this, id, decided = step.status,
                            answer = std::move(answer)](const absl::Status& journalled) mutable {
    const std::optional<JobView> view = job(id);
    if (!decided.ok() || !journalled.ok()) {
      answer(decided.ok() ? journalled : decided);
    } else if (!view) {
      answer(absl::NotFoundError(absl::StrCat("there is no job ", id)));
    } else {
      answer(*view);
    }
  });
}

void SchedulerThread::command_worker(const Input& input, Answer<bool> answer) {
  if (!journal_status_.ok()) {
    answer(journal_status_);
    return;
  }
  const Step step = run(input);
  commit_queue_.completion(
      [decided = step.status, answer = std::move(answer)](const absl::Status& journalled) mutable {
        if (!decided.ok() || !journalled.ok()) {
          answer(decided.ok() ? journalled : decided);
        } else {
          answer(true);
        }
      });
}

absl::StatusOr<std::vector<FrameView>> SchedulerThread::frames(JobId id,
                                                               std::uint64_t after) const {
  std::optional<std::vector<FrameView>> frames = scheduler_.frames(id, after);
  if (frames) {
    return *std::move(frames);
  }
  return job(id) ? absl::FailedPreconditionError(
                       absl::StrCat("job ", id, " has no frames: it is a single image"))
                 : absl::NotFoundError(absl::StrCat("there is no job ", id));
}

void SchedulerThread::watch(JobId id, Watchers::Changed changed) {
  watchers_.add(id, job(id), std::move(changed), clock_.now());
}

}  // namespace bandsaw::coordinator
