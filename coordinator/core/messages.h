#pragma once

// What goes into the core and what comes out: inputs (requests and observations), events (facts;
// applying one is the only way the state changes) and actions (what the world must do once the
// durable events are on disk).

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "coordinator/core/types.h"
#include "renderlib/render/adaptive_plan.h"

namespace bandsaw::coordinator {

// ---- inputs ----
namespace input {
/// The package's blobs are all there and the settings are in range (checked before).
struct Submit {
  JobSpec spec;
  std::int32_t priority = 0;  ///< [-kMostPriority, kMostPriority]; only of a new job
};
/// Nothing more is leased of it, what is not begun is taken back at once, and what is not rendered
/// a second later too.
struct Pause {
  JobId job = 0;
};
struct Resume {
  JobId job = 0;
};
struct SetPriority {
  JobId job = 0;
  std::int32_t priority = 0;
};
struct Cancel {
  JobId job = 0;
};
struct Hello {
  SessionId session = 0;
  WorkerHello worker;
};
struct Heartbeat {
  SessionId session = 0;
  std::vector<LeaseProgress> leases;
  std::string doing;
};
struct Draining {
  SessionId session = 0;
  std::string reason;
};
/// The stream ended.
struct Lost {
  SessionId session = 0;
  std::string reason;
};
struct BandFailed {
  SessionId session = 0;
  LeaseId lease = 0;
  std::string reason;
  std::vector<std::string> log;
};
/// A band's pixels are on disk. One digest a row, of the row's sums.
/// To be said of a duplicate that was not written too: it changes nothing but that its digests are
/// compared.
struct BandStored {
  JobId job = 0;
  Band band;
  std::vector<std::uint64_t> row_digests;
  std::string instance;        ///< the worker that rendered it; empty when read back from disk
  std::uint64_t renderer = 0;  ///< names that worker in all lives of the coordinator; 0: unknown
  Counters counters;
  double render_s = 0;
  double cpu_s = 0;
};
/// The film has merged every row of samples [0, samples); error: nothing when it cannot be told
/// yet. Said once more of the finished image.
struct PassMerged {
  JobId job = 0;
  std::uint64_t samples = 0;
  std::optional<ErrorEstimate> error;
  std::vector<TileError> tiles = {};  ///< of an adaptive job (Film::tile_errors)
};
struct ResultWritten {
  JobId job = 0;
};
/// The disk or memory refused; the job is paused with the reason until StorageBack.
struct StorageFailed {
  JobId job = 0;
  std::string reason;
};
struct StorageBack {};
/// Final jobs that are old enough; others are left alone.
struct Forget {
  std::vector<JobId> jobs;
};
struct Tick {};
}  // namespace input

using Input =
    std::variant<input::Submit, input::Cancel, input::Pause, input::Resume, input::SetPriority,
                 input::Hello, input::Heartbeat, input::Draining, input::Lost, input::BandFailed,
                 input::BandStored, input::PassMerged, input::ResultWritten, input::StorageFailed,
                 input::StorageBack, input::Forget, input::Tick>;

// ---- events that must survive: the journal ----
namespace record {
struct JobAdded {
  JobId job = 0;
  JobSpec spec;
};
/// A pass [first, last) of the whole image was begun. (For error and time rules passes depend on
/// what was measured.)
struct PassPlanned {
  JobId job = 0;
  SampleRange samples;
};
/// From the samples that there are on, half tiles take part in passes as planned.
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
}  // namespace record

using Record =
    std::variant<record::JobAdded, record::PassPlanned, record::TilesPlanned, record::SamplesFixed,
                 record::StateChanged, record::PriorityChanged, record::HoldChanged,
                 record::TimeSpent, record::Figures, record::ErrorMeasured, record::ShareCounted,
                 record::LastWords, record::JobForgotten, record::WorkerJoined, record::WorkerLeft>;

// ---- actions ----
namespace action {
struct Welcome {
  SessionId session = 0;
  std::string name;
  std::uint32_t heartbeat_ms = 1000;
};
struct Refuse {
  SessionId session = 0;
  std::string reason;
  std::uint32_t retry_after_ms = 0;
};
/// Ends a session that the worker's next one has replaced, or that went silent.
struct Close {
  SessionId session = 0;
  std::string reason;
};
struct Lease {
  SessionId session = 0;
  LeaseId lease = 0;
  JobId job = 0;
  DigestHex manifest;
  RenderSettings settings;
  Band band;
  TileMask tiles = {};  ///< of the band's rows
  std::uint32_t attempt = 1;
};
struct Revoke {
  SessionId session = 0;
  std::vector<LeaseId> leases;
};
/// For the log: idle workers were put to what another worker has in hand.
struct Shared {
  JobId job = 0;
  Band band;
  std::string from;
  std::string to;
  bool begun = false;  ///< both render it now; else it was taken from the one before it began
};
/// For the log: a worker could not render a band.
struct Faulted {
  JobId job = 0;
  Band band;
  std::string worker;
  std::string reason;
};
/// The rows of the stored band that are new go into the film; the others were there already.
struct AddToFilm {
  JobId job = 0;
  Band band;
  std::vector<RowRange> rows;
  std::string worker;   ///< whose it is, for people; empty: one that is not known any more
  TileMask tiles = {};  ///< of the band's rows
};
/// Write the image of samples [0, samples), then say ResultWritten.
struct WriteResult {
  JobId job = 0;
  std::uint64_t samples = 0;
};
/// A forgotten job: its result is not needed any more.
struct DropJob {
  JobId job = 0;
};
/// The job is final: its bands and film are not needed any more (the result stays).
struct DropBands {
  JobId job = 0;
};
}  // namespace action

using Action = std::variant<action::Welcome, action::Refuse, action::Close, action::Lease,
                            action::Revoke, action::Shared, action::Faulted, action::AddToFilm,
                            action::WriteResult, action::DropBands, action::DropJob>;

}  // namespace bandsaw::coordinator
