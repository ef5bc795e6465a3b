#pragma once

// The thread that owns the core: command -> events -> journal -> apply -> actions. All calls may
// come from any thread and return at once; answers come through callbacks, on the engine's or the
// store's thread: they MUST be quick.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "coordinator/engine/collector.h"
#include "coordinator/engine/credits.h"
#include "coordinator/engine/memory_budget.h"
#include "coordinator/engine/worker_link.h"
#include "coordinator/scheduler/api/messages.h"
#include "coordinator/store/result_file.h"
#include "renderlib/package/blob_source.h"
#include "renderlib/render/band.h"

namespace bandsaw::coordinator {

struct EngineOptions {
  std::string data_folder;         ///< made if it does not exist; one engine at a time (locked)
  double heartbeat_timeout_s = 4;  ///< a worker that is silent this long is lost
  double progress_timeout_s =
      30;  ///< a lease whose rows do not advance this long is given to another
  double reattach_grace_s =
      6;  ///< after a restart: how long to wait for workers that were there before
  /// Of all bands, [0, 1]: rendered by two machines and compared.
  double audit_share = 0.01;
  Keep keep = {};  ///< of what is over; looked at every ten minutes and every 1,000 jobs
};

/// How a band's upload ended for its worker.
enum class BandOutcome { kStored, kDuplicate, kUnwanted };

struct EngineDoors;

class Engine {
 public:
  /// Opens the folder, replays the journal and the band files, starts the threads.
  /// FAILED_PRECONDITION: another coordinator uses the folder. DATA_LOSS: naming what is damaged.
  static absl::StatusOr<std::unique_ptr<Engine>> start(EngineOptions options);
  /// The same with other doors to the world (engine/doors.h), for tests.
  static absl::StatusOr<std::unique_ptr<Engine>> start(EngineOptions options, EngineDoors doors);
  /// Stops the threads; what was acknowledged is on disk.
  ~Engine();

  // People.
  /// The job id once the job is journalled. FAILED_PRECONDITION: a blob is missing (named).
  /// INVALID_ARGUMENT: the priority is beyond kMaxPriority.
  void submit(JobSpec spec, std::function<void(absl::StatusOr<JobId>)> done,
              std::int32_t priority = 0);
  /// Answered with the job as it is then, once that is journalled. NOT_FOUND. All but cancel also
  /// FAILED_PRECONDITION: the job is over.
  void cancel(JobId job, std::function<void(absl::StatusOr<JobView>)> done);
  void pause(JobId job, std::function<void(absl::StatusOr<JobView>)> done);
  void resume(JobId job, std::function<void(absl::StatusOr<JobView>)> done);
  /// INVALID_ARGUMENT: beyond kMaxPriority.
  void set_priority(JobId job, std::int32_t priority,
                    std::function<void(absl::StatusOr<JobView>)> done);
  /// Keeps a machine away as if it had returned wrong pixels, or lets it in again. NOT_FOUND.
  void quarantine(std::string worker, bool lift, std::function<void(absl::Status)> done);
  /// Why it is not done yet, in sentences; none: no such job.
  void why(JobId job, std::function<void(std::vector<std::string>)> done);
  /// Calls `changed` with the state now and after each change (at most ten a second a job, at least
  /// one a second), until it returns false or the job is final (that state is always delivered).
  /// NOT_FOUND arrives through `changed` too.
  void watch(JobId job, std::function<bool(absl::StatusOr<JobView>)> changed);
  void jobs(std::function<void(std::vector<JobView>)> done);
  void workers(std::function<void(std::vector<WorkerView>)> done);
  /// The last lines of a worker's log. NOT_FOUND.
  void logs(std::string worker, std::function<void(absl::StatusOr<std::vector<std::string>>)> done);
  /// What is there of the image of a job at work: every row_step-th row, `row_step` >= 1.
  /// NOT_FOUND.
  void preview(JobId job, std::uint32_t row_step, std::function<void(absl::StatusOr<Image>)> done);
  /// Who rendered the rows that are there, by row. Of a job at work a name is not known from before
  /// a restart until its worker brings another band.
  void rendered_by(JobId job, std::function<void(std::vector<RowsBy>)> done);
  /// NOT_FOUND: no such job, or samples of one that was not adaptive. FAILED_PRECONDITION: not
  /// done. DATA_LOSS.
  void result(JobId job, FinishedPart part, std::function<void(absl::StatusOr<StoredResult>)> done);

  /// The memory that images may take while they are made for somebody and downloaded, 1 GiB.
  /// Whoever calls result or preview takes the image's bytes of it before, and gives them back when
  /// the image is not held any more.
  MemoryBudget& images();

  // Blobs. Thread-safe, may block on the disk: not for gRPC's own threads.
  class BlobWriter {
   public:
    virtual ~BlobWriter() = default;  ///< without commit: what came is kept for the next try
    virtual absl::Status append(absl::Span<const std::byte> bytes) = 0;
    /// INVALID_ARGUMENT: digest or size differ. DATA_LOSS: so do bytes of an earlier try. OK: on
    /// disk.
    virtual absl::Status commit() = 0;
  };
  bool has_blob(const wire::Digest& digest) const;
  /// Bytes of a blob that is not there, from its beginning, of an upload that was cut.
  std::uint64_t partial_blob(const wire::Digest& digest) const;
  /// `offset`: goes on behind so many of those. FAILED_PRECONDITION: there are fewer.
  absl::StatusOr<std::unique_ptr<BlobWriter>> write_blob(const wire::Digest& digest,
                                                         std::uint64_t size,
                                                         std::uint64_t offset = 0);
  BlobSource& blobs();

  // Workers.
  SessionId hello(std::shared_ptr<WorkerLink> link, WorkerHello hello);
  void heartbeat(SessionId session, std::vector<LeaseProgress> leases, std::string doing);
  void draining(SessionId session, std::string reason);
  void band_failed(SessionId session, LeaseId lease, std::string reason,
                   std::vector<std::string> log);
  void lost(SessionId session, std::string reason);
  /// New lines of its log, checked.
  void worker_log(SessionId session, std::vector<std::string> lines);
  /// `done` once the pixels are on disk and in the journal's reach, or not wanted.
  /// RESOURCE_EXHAUSTED: disk full, keep it and try again. INVALID_ARGUMENT: not a band of that
  /// job. `work` (renderlib/render/work_hash.h): that it was rendered for, 0 where nobody says;
  /// of another job that bore the number before it is not wanted.
  void put_band(JobId job, std::uint64_t work, std::string instance, BandPixels pixels,
                double render_s, double cpu_s,
                std::function<void(absl::StatusOr<BandOutcome>)> done);

  /// Of the disk under the data folder; 0 when it cannot be told. Any thread; may wait for the
  /// disk.
  std::uint64_t free_bytes() const;

  /// Names this life of the coordinator.
  const std::string& epoch() const;

 private:
  class Impl;
  explicit Engine(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace bandsaw::coordinator
