#pragma once

// Events that must survive, as the journal holds them: applying one is the only way that what is
// durable changes.

#include <string>
#include <variant>
#include <vector>

#include "coordinator/core/types.h"
#include "renderlib/render/adaptive_plan.h"

namespace bandsaw::coordinator {

namespace record {
struct JobAdded {
  JobId job = 0;
  JobSpec spec;
  std::uint32_t pixel_version = 0;  ///< of the coordinator then; 0: its journal did not say
};
/// A pass [first, last) of the whole image was begun. (For error and time rules passes depend on
/// what was measured.)
struct PassPlanned {
  JobId job = 0;
  SampleRange samples;
};
/// From the samples that there are on, half tiles take samples as planned.
struct TilesPlanned {
  JobId job = 0;
  TilePlan plan;
};
/// No further pass: the job ends after this many samples a pixel.
struct SamplesFixed {
  JobId job = 0;
  std::uint64_t samples = 0;
};
struct StateChanged {
  JobId job = 0;
  JobState state = JobState::kRunning;
  std::string reason;
};
/// Of a job that was not submitted with 0, or since.
struct PriorityChanged {
  JobId job = 0;
  std::int32_t priority = 0;
};
/// A person paused it: only a person resumes it.
struct HoldChanged {
  JobId job = 0;
  bool held = false;
};
/// How long a job has been at work, in all lives of the coordinator; the last of a job counts.
struct TimeSpent {
  JobId job = 0;
  double elapsed_s = 0;
};
/// What a job came to, before it is final: its bands are dropped then.
struct Figures {
  JobId job = 0;
  double elapsed_s = 0;
  double cpu_s = 0;
  std::uint32_t workers_used = 0;
  std::uint64_t samples = 0;            ///< pixel samples stored
  std::uint64_t samples_per_pixel = 0;  ///< of the complete passes
  double error = -1;                    ///< negative: not known
  Counters counters;
};
/// What the error was after a pass.
struct ErrorMeasured {
  JobId job = 0;
  ErrorPoint point;
};
/// Of a job that is about to be final; one for each worker.
struct ShareCounted {
  JobId job = 0;
  WorkerShare share;
};
/// The last lines of the log of the worker that failed the job.
struct LastWords {
  JobId job = 0;
  std::string worker;
  std::vector<std::string> log;
};
/// A final job that nobody is told of any more; its number is never used again.
struct JobForgotten {
  JobId job = 0;
};
/// Who was connected, so that a restart waits a moment for those who may hold finished bands.
struct WorkerJoined {
  std::string instance;
};
struct WorkerLeft {
  std::string instance;
};
/// Another machine gave the same digests for what this renderer had stored.
struct BandAudited {
  JobId job = 0;
  Band band;
  std::uint64_t renderer = 0;  ///< core/renderer.h
};
/// What this renderer had stored of the band is damaged on disk. It is rendered again; whoever
/// vouched for it vouched for other bytes.
struct BandLost {
  JobId job = 0;
  Band band;
  std::uint64_t renderer = 0;  ///< core/renderer.h
};
/// What was measured of a job's error was measured with pixels that are void since.
struct ErrorForgotten {
  JobId job = 0;
};
/// A machine returned wrong pixels, or a person says so: what this worker process rendered is void,
/// and nobody who bears the name gets work.
struct WorkerQuarantined {
  std::uint64_t renderer = 0;  ///< core/renderer.h
  std::string name;            ///< as it says itself; empty: not known
  std::string reason;
};
struct QuarantineLifted {
  std::string name;
};
}  // namespace record

using Record =
    std::variant<record::JobAdded, record::PassPlanned, record::TilesPlanned, record::SamplesFixed,
                 record::StateChanged, record::PriorityChanged, record::HoldChanged,
                 record::TimeSpent, record::Figures, record::ErrorMeasured, record::ShareCounted,
                 record::LastWords, record::JobForgotten, record::WorkerJoined, record::WorkerLeft,
                 record::BandAudited, record::BandLost, record::ErrorForgotten,
                 record::WorkerQuarantined, record::QuarantineLifted>;

}  // namespace bandsaw::coordinator
