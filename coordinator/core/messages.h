#pragma once

// What goes into the core and what comes out: inputs (requests and observations), events (facts;
// applying one is the only way the state changes) and actions (what the world must do once the
// durable events are on disk).

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "coordinator/core/records.h"
#include "coordinator/core/types.h"

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
/// To be said of a duplicate that was not written too: its digests are compared.
struct BandStored {
  JobId job = 0;
  Band band;
  std::vector<std::uint64_t> row_digests;
  std::string instance;        ///< the worker that rendered it; empty when read back from disk
  std::uint64_t renderer = 0;  ///< who it was (core/renderer.h), when read back; 0: unknown
  Counters counters;
  double render_s = 0;
  double cpu_s = 0;
  bool written = true;  ///< false: it was there already and was only compared
};
/// The film has merged every row of samples [0, samples); error: nothing when it cannot be told
/// yet. Said once more of the finished image.
struct PassMerged {
  JobId job = 0;
  std::uint64_t samples = 0;
  std::optional<ErrorEstimate> error;
  std::vector<HalfTileErrors> tiles = {};  ///< of an adaptive job (Film::tile_errors)

  /// The error that is not passed; below 0: not known.
  double error_at_most() const { return known_error(error, samples); }
};
struct ResultWritten {
  JobId job = 0;
};
/// What lies on disk of these bands is damaged. They are not in the film any more.
struct BandsDamaged {
  struct Lost {
    Band band;  ///< rows that one AddToFilm named, next to each other
    std::uint64_t renderer = 0;
  };
  JobId job = 0;
  std::vector<Lost> bands;
};
/// The disk or memory refused; the job is paused with the reason until StorageBack.
struct StorageFailed {
  JobId job = 0;
  std::string reason;
};
struct StorageBack {};
/// A person wants this machine kept away as if it had returned wrong pixels.
struct Quarantine {
  std::string worker;  ///< its name, as shown or as it says itself
};
/// … or let in again. A worker process that was sent away MUST be started again for it.
struct LiftQuarantine {
  std::string worker;
};
/// Final jobs that are old enough; others are left alone.
struct Forget {
  std::vector<JobId> jobs;
};
struct Tick {};
}  // namespace input

using Input =
    std::variant<input::Submit, input::Cancel, input::Pause, input::Resume, input::SetPriority,
                 input::Hello, input::Heartbeat, input::Draining, input::Lost, input::BandFailed,
                 input::BandStored, input::PassMerged, input::ResultWritten, input::BandsDamaged,
                 input::StorageFailed, input::StorageBack, input::Quarantine, input::LiftQuarantine,
                 input::Forget, input::Tick>;

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
  TileSamples tiles = {};  ///< of the band
  std::uint32_t attempt = 1;
  bool audit = false;  ///< the rows are there; another machine renders them to compare
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
  std::string worker;      ///< whose it is, for people; empty: one that is not known any more
  TileSamples tiles = {};  ///< of the band
};
/// What this worker rendered of the job is void: the film is made anew without it, and tells its
/// passes again as they become whole.
struct Retract {
  JobId job = 0;
  std::uint64_t renderer = 0;
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

using Action =
    std::variant<action::Welcome, action::Refuse, action::Close, action::Lease, action::Revoke,
                 action::Shared, action::Faulted, action::AddToFilm, action::Retract,
                 action::WriteResult, action::DropBands, action::DropJob>;

}  // namespace bandsaw::coordinator
