#pragma once

// Handles sequences (jobs of many frames). Each frame is rendered by a job of its own, its frame
// job. Makes the frame jobs when workers are about to need them, tries failed frames again, and
// ends sequences. Also handles the requests of users about sequences. If a request cannot be
// granted, its function sets the status of the step to an error. This status is the answer to the
// request.

#include <cstddef>
#include <string>

#include "coordinator/scheduler/context/context.h"
#include "coordinator/scheduler/jobs/job_lifecycle.h"
#include "coordinator/scheduler/jobs/job_requests.h"

namespace bandsaw::coordinator {

class Sequences {
 public:
  Sequences(Context& context, JobRequests& requests, JobLifecycle& lifecycle)
      : context_(context), requests_(requests), lifecycle_(lifecycle) {}

  /// Returns true if the id is that of a sequence.
  bool owns(JobId id) const { return context_.sequences.find(id) != nullptr; }

  /// Adds a sequence. Fails as JobRequests::submit does, and with INVALID_ARGUMENT if the sequence
  /// has no frames or too many.
  void submit(const input::SubmitSequence& in);
  /// Notes the scenes of frames. add_frames() and retry() fail with NOT_FOUND if there is no such
  /// job, with INVALID_ARGUMENT if the sequence has no such frame, and with FAILED_PRECONDITION if
  /// the job is a single image or the sequence was cancelled.
  void add_frames(const input::AddFrames& in);
  /// Renders failed frames again. Also fails with FAILED_PRECONDITION if one of the frames has not
  /// failed, if no frame has failed, or if the sequence was begun with another pixel version.
  void retry(const input::RetryFrames& in);

  // The following four functions do for a sequence what the functions of the same names in
  // JobRequests do for a job. REQUIRES: owns(in.job).
  void cancel(const input::Cancel& in);
  void pause(const input::Pause& in);
  void resume(const input::Resume& in);
  void set_priority(const input::SetPriority& in);
  /// Forgets the final sequences among these jobs, with all their frames. Skips all other jobs.
  void forget(const input::Forget& in);

  /// Tries failed frames again, and makes the next frame jobs. Ends a sequence when each of its
  /// frames is done or has failed. MUST be called in each step before work is given to workers.
  void advance();
  /// Writes the elapsed times of the sequences to the journal at intervals. A crash loses at most
  /// one second or one fiftieth of the time, whichever is longer.
  void note_times();
  /// After a restart: lets the elapsed time of each sequence go on from the journalled time; fails
  /// sequences that were begun with another pixel version.
  void resume_after_restart();

 private:
  /// Does for one sequence what the other advance() does for all. `open_frames` is the number of
  /// frame jobs that are not final, in all sequences that are not paused. Adds the number of frame
  /// jobs that this function makes to `open_frames`.
  void advance(Sequence& sequence, std::size_t& open_frames);
  /// Sets the state of the sequence to `state`, which is final, and cancels its open frame jobs.
  /// Also forgets these jobs if `state` is kCancelled. `reason`: why the sequence ends.
  void end(Sequence& sequence, JobState state, const std::string& reason);
  /// Sets the state of a frame to waiting and forgets the frame's job, so that advance() makes a
  /// new job for the frame. `failures`: number of the frame's jobs that count as failed. `reason`:
  /// why the last of them failed.
  void wait_again(Sequence& sequence, FrameNumber number, std::uint32_t failures,
                  const std::string& reason);
  /// Removes the job, if it exists, and its files.
  void forget_job(JobId id);
  /// Returns the sequence. Returns nullptr, and sets the status of the step to an error, if there
  /// is no such sequence or the sequence was cancelled.
  Sequence* find_active(JobId id);

  Context& context_;
  JobRequests& requests_;
  JobLifecycle& lifecycle_;
};

/// Returns the reason of a job or sequence that fails because it was begun with another pixel
/// version. A pixel version is a number that changes whenever rendered pixels change. `begun_with`:
/// the version with which the job was begun; 0: the journal does not say which. `here`: the version
/// of this coordinator.
std::string other_pixel_version(std::uint32_t begun_with, std::uint32_t here);

}  // namespace bandsaw::coordinator
