#pragma once

// Inputs of the scheduler (requests of users and events that the engine reports), and the actions
// that it returns, which the engine MUST do only after the records of the same step are on disk.
//
// A band is a range of rows and samples of an image, the unit of work; a lease gives it to one
// worker. A pass is a range of samples of the whole image. A session is one stream of a worker. The
// film holds the sums of all pixels of a job. A half tile is half of the pixels of a 16 x 16 tile;
// in an adaptive job, half tiles take different numbers of samples. More terms: proto/README.md,
// Glossary.

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "absl/status/status.h"
#include "coordinator/scheduler/api/ids.h"
#include "coordinator/scheduler/api/job_spec.h"
#include "coordinator/scheduler/api/records.h"
#include "renderlib/render/band.h"
#include "renderlib/render/tile_samples.h"

namespace bandsaw::coordinator {

/// Suffix of the name of every browser, which distinguishes it from the name of a native worker.
inline constexpr char kBrowserSuffix[] = "@browser";

/// A worker's report when it opens a session.
struct WorkerHello {
  std::string instance;  ///< unique to its process, the same over reconnects
  std::string name;
  std::string address;
  std::string build;
  std::uint32_t protocol = 0;
  std::uint32_t pixel_version = 0;
  std::uint64_t canary = 0;  ///< hash of a small render (renderlib/render/canary.h)
  std::uint32_t threads = 1;
  std::uint32_t max_bands = 2;  ///< number of leases that it is willing to hold
  bool browser = false;         ///< it renders in a browser; the connection says so, not the worker
  std::uint64_t memory_bytes = 0;  ///< memory that scenes may take in it; 0: no limit
  /// A lease that the worker held before it reconnected.
  struct Held {
    JobId job = 0;
    Band band;
    LeaseId lease = 0;
    std::string epoch;      ///< run of the coordinator that granted the lease
    bool finished = false;  ///< all of the band is rendered
    /// Hash of what is rendered (renderlib/render/work_hash.h); 0: not reported.
    std::uint64_t work = 0;
  };
  std::vector<Held> held;

  /// Returns the name under which the farm knows the worker: `name`, and for a browser also
  /// kBrowserSuffix.
  std::string reported_name() const { return browser ? name + kBrowserSuffix : name; }
};

/// Progress of one lease, as a heartbeat reports it.
struct LeaseProgress {
  LeaseId lease = 0;
  std::uint32_t rows_done = 0;
  std::uint64_t prepared = 0;  ///< grows while the scene is being fetched or built
};

// ---- inputs ----
namespace input {
/// REQUIRES: all blobs of the package are stored and the settings are in range.
struct Submit {
  JobSpec spec;
  std::int32_t priority = 0;  ///< [-kMaxPriority, kMaxPriority]; used only if the job is new
};
/// REQUIRES: the settings are in range, and the frames are in the form that parse_frames returns.
struct SubmitSequence {
  SequenceSpec spec;
  std::int32_t priority = 0;  ///< as in Submit
};
/// The scenes of frames of a sequence have arrived. A frame whose scene is known already keeps it.
/// REQUIRES: all blobs of the packages are stored.
struct AddFrames {
  JobId job = 0;
  std::vector<FrameScene> scenes;
};
/// Renders failed frames again. The sequence may be in any state except cancelled.
struct RetryFrames {
  JobId job = 0;
  std::vector<FrameNumber> frames;  ///< empty: all that failed
};
/// Stops leasing the job. Leases that are not begun are revoked at once. A lease that is begun is
/// revoked one second later, unless its band is rendered by then.
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
  std::string doing;  ///< what it is doing, for users; empty: rendering
};
/// The worker finishes its leases and takes no more, because it is about to leave.
struct Draining {
  SessionId session = 0;
  std::string reason;
};
/// The worker's stream ended.
struct SessionEnded {
  SessionId session = 0;
  std::string reason;
};
/// The worker could not render a band.
struct BandFailed {
  SessionId session = 0;
  LeaseId lease = 0;
  std::string reason;
  std::vector<std::string> log;  ///< the last lines of the worker's log
};
/// A band's pixels are on disk. MUST also be sent for a second result of rows that are stored
/// already, so that the digests of both results are compared. Such a result is not written.
struct BandStored {
  JobId job = 0;
  Band band;
  std::vector<std::uint64_t> row_digests;  ///< one per row, of the row's sums
  std::string instance;         ///< of the worker that rendered it; empty if read back from disk
  WorkerProcessId process = 0;  ///< process that rendered it, if read back from disk
  Counters counters;
  /// Time in which the worker rendered it; 0: unknown, as for a band that was read back from disk.
  double render_s = 0;
  double cpu_s = 0;     ///< CPU time of its threads
  bool written = true;  ///< false: all rows were stored already and it was only compared
};
/// The film has all rows of the samples [0, samples), and their error is estimated. If the film
/// also has some rows of later samples, the estimate includes them. So PassMerged is sent again
/// just before the finished image is written, with the error of exactly the image's samples.
struct PassMerged {
  JobId job = 0;
  std::uint64_t samples = 0;
  std::optional<ErrorEstimate> error;      ///< std::nullopt: cannot be estimated yet
  std::vector<HalfTileErrors> tiles = {};  ///< for an adaptive job: Film::tile_errors

  /// Returns the upper bound of the error; negative: unknown.
  double error_at_most() const { return known_error(error, samples); }
};
struct ResultWritten {
  JobId job = 0;
};
/// The data of these bands on disk is damaged, and their pixels are no longer in the film.
struct BandsDamaged {
  struct DamagedBand {
    Band band;  ///< consecutive rows that one AddToFilm named
    WorkerProcessId process = 0;
  };
  JobId job = 0;
  std::vector<DamagedBand> bands;
};
/// Writing to disk or allocating memory failed; the job is paused with the reason until
/// StorageBack.
struct StorageFailed {
  JobId job = 0;
  std::string reason;
};
/// Writing works again; jobs that StorageFailed paused continue.
struct StorageBack {};
/// A user puts a machine into quarantine, as if it had returned wrong pixels: the machine gets no
/// work, and all that it rendered is void.
struct Quarantine {
  std::string worker;  ///< its name, as displayed or as the worker reports it
};
/// A user lifts a quarantine. Worker processes that were quarantined MUST be restarted.
struct LiftQuarantine {
  std::string worker;
};
/// Removes final jobs; jobs that are not final are skipped.
struct Forget {
  std::vector<JobId> jobs;
};
/// Time has passed. MUST be sent at least once per heartbeat interval.
struct Tick {};
}  // namespace input

using Input =
    std::variant<input::Submit, input::SubmitSequence, input::AddFrames, input::RetryFrames,
                 input::Cancel, input::Pause, input::Resume, input::SetPriority, input::Hello,
                 input::Heartbeat, input::Draining, input::SessionEnded, input::BandFailed,
                 input::BandStored, input::PassMerged, input::ResultWritten, input::BandsDamaged,
                 input::StorageFailed, input::StorageBack, input::Quarantine, input::LiftQuarantine,
                 input::Forget, input::Tick>;

// ---- actions ----
namespace action {
/// Admits the worker of a session and gives it a displayed name that no other worker has.
struct Welcome {
  SessionId session = 0;
  std::string name;
  std::uint32_t heartbeat_ms = 1000;
};
/// Does not admit the worker; it may try again after `retry_after_ms`.
struct Refuse {
  SessionId session = 0;
  std::string reason;
  std::uint32_t retry_after_ms = 0;
};
/// Closes a session: the worker opened another one, went silent, or is quarantined.
struct Close {
  SessionId session = 0;
  std::string reason;
};
/// Gives a band of a job to a worker to render, or confirms a lease that it still holds.
struct Lease {
  SessionId session = 0;
  LeaseId lease = 0;
  JobId job = 0;
  DigestHex manifest;
  RenderSettings settings;
  Band band;
  TileSamples tiles = {};     ///< samples that each half tile of the band takes (adaptive jobs)
  std::uint32_t attempt = 1;  ///< 1 + number of times that the band was given back; for logs
  bool audit = false;         ///< the rows are stored already; this result is compared with them
};
/// Tells a worker to stop rendering these leases and to drop their results.
struct Revoke {
  SessionId session = 0;
  std::vector<LeaseId> leases;
};
/// Log that an idle worker was given rows for which another worker holds a lease.
struct LogReassignment {
  JobId job = 0;
  Band band;
  std::string from;  ///< displayed name of the worker that holds the lease
  std::string to;    ///< displayed name of the idle worker
  /// True: `from` has begun the band, and both workers render it (a backup task). False: the band
  /// is taken from `from`, which has not begun it.
  bool begun = false;
};
/// Log that a worker could not render a band.
struct LogFailure {
  JobId job = 0;
  Band band;
  std::string worker;
  std::string reason;
};
/// Add these rows of the stored band to the film; its other rows were there already.
struct AddToFilm {
  JobId job = 0;
  Band band;
  std::vector<RowRange> rows;
  std::string worker;      ///< displayed name; empty: the worker is not known any more
  TileSamples tiles = {};  ///< as in Lease
};
/// Discard everything that this worker process rendered of the job: rebuild the film without it,
/// and send PassMerged again for its passes as they become complete.
struct Retract {
  JobId job = 0;
  WorkerProcessId process = 0;
};
/// Write the image of samples [0, samples), then send ResultWritten.
struct WriteResult {
  JobId job = 0;
  std::uint64_t samples = 0;
};
/// The job was forgotten: its result is no longer needed.
struct DropJob {
  JobId job = 0;
};
/// The job is final: its bands and its film are no longer needed; the result is kept.
struct DropBands {
  JobId job = 0;
};
}  // namespace action

using Action =
    std::variant<action::Welcome, action::Refuse, action::Close, action::Lease, action::Revoke,
                 action::LogReassignment, action::LogFailure, action::AddToFilm, action::Retract,
                 action::WriteResult, action::DropBands, action::DropJob>;

/// The outcome of one input. The records MUST be on disk before any action is done or the caller is
/// answered.
struct Step {
  std::vector<Record> records;
  std::vector<Action> actions;
  /// Answer to a user's request. After any other input, INTERNAL says that the scheduler has a bug.
  absl::Status status;
  JobId job = 0;  ///< the job of Submit
};

}  // namespace bandsaw::coordinator
