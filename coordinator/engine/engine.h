#pragma once

// The coordinator without network and user interface: three threads that hand work to each other.
// This is the path of a band (a range of rows and samples of a job, rendered by a worker):
//
//   any thread -> scheduler (decides, writes the journal) -> store (files) -> scheduler -> film
//   (pixels) -> store (result)

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "coordinator/engine/clock.h"
#include "coordinator/engine/collector.h"
#include "coordinator/engine/film_thread.h"
#include "coordinator/engine/incoming_band.h"
#include "coordinator/engine/mailbox.h"
#include "coordinator/engine/memory_budget.h"
#include "coordinator/engine/posted_inboxes.h"
#include "coordinator/engine/scheduler_thread.h"
#include "coordinator/engine/store_thread.h"
#include "coordinator/engine/worker_link.h"
#include "coordinator/scheduler/api/messages.h"
#include "coordinator/store/blob_store.h"
#include "coordinator/store/data_folder.h"
#include "coordinator/store/journal.h"
#include "coordinator/store/result_file.h"
#include "renderlib/package/blob_source.h"
#include "renderlib/render/band.h"

namespace bandsaw::coordinator {

struct EngineOptions {
  std::string data_folder;         ///< created if missing; locked against other engines
  double heartbeat_timeout_s = 4;  ///< a worker that is silent for this time counts as lost
  /// A lease (a band that a worker was given to render) without progress for this time is revoked,
  /// and its rows are given to another worker.
  double progress_timeout_s = 30;
  /// After a restart, nothing is leased until all workers of the previous run have connected again,
  /// or until this time has passed.
  double reattach_grace_s = 6;
  /// Share of the bands of native workers that two machines render, [0, 1].
  double audit_share = 0.01;
  double browser_audit_share = 0.1;  ///< as audit_share, for bands of browsers
  Browsers browsers = Browsers::kAlso;
  /// Retention of jobs that are over; applied every ten minutes, and after every 1,000 new jobs.
  Keep keep = {};
};

/// Parts that tests replace. nullptr selects the real part: SQLite in the data folder, and the
/// steady clock.
struct EngineDependencies {
  std::unique_ptr<Journal> journal;
  std::unique_ptr<Clock> clock;
};

/// All calls may come from any thread. They return at once unless their comment says that they may
/// block. Results are passed to callbacks on one of the engine's threads, so callbacks MUST be
/// quick. Each callback, except that of watch(), is called exactly once. If the engine stops before
/// it has the result, it calls the callback with UNAVAILABLE, or with an empty list if the callback
/// takes no status.
class Engine {
 public:
  /// Opens the data folder, replays the journal and the band logs, and starts the threads.
  /// FAILED_PRECONDITION: another coordinator uses the folder. DATA_LOSS: a file is damaged; the
  /// message names it.
  static absl::StatusOr<std::unique_ptr<Engine>> start(EngineOptions options,
                                                       EngineDependencies dependencies = {});
  /// Stops the threads. Everything that was acknowledged is on disk.
  ~Engine();
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  // Requests of users.

  /// Adds a job. Returns its id once it is in the journal. FAILED_PRECONDITION: a blob is missing;
  /// the message names it. INVALID_ARGUMENT: a field or the priority is out of range.
  /// RESOURCE_EXHAUSTED: too many jobs, or the disk is full.
  void submit(JobSpec spec, std::function<void(absl::StatusOr<JobId>)> done,
              std::int32_t priority = 0);
  /// Submits a sequence: a job of many frames, each of which is rendered by a job of its own. The
  /// scenes of the frames are given later, by add_frames. Errors as submit.
  void submit_sequence(SequenceSpec spec, std::function<void(absl::StatusOr<JobId>)> done,
                       std::int32_t priority = 0);
  /// Gives frames of a sequence their scenes. Returns the sequence after this change. NOT_FOUND: no
  /// such job. INVALID_ARGUMENT: the sequence has no such frame, or a package is broken.
  /// FAILED_PRECONDITION: a blob is missing, or the sequence was cancelled.
  void add_frames(JobId sequence, std::vector<FrameScene> scenes,
                  std::function<void(absl::StatusOr<JobView>)> done);
  /// Renders these failed frames again; if `frames` is empty, all failed frames. Returns the
  /// sequence after this change.
  void retry_frames(JobId sequence, std::vector<FrameNumber> frames,
                    std::function<void(absl::StatusOr<JobView>)> done);
  /// Returns the frames that changed after `after` (FrameView::changed); 0: all.
  void frames(JobId sequence, std::uint64_t after,
              std::function<void(absl::StatusOr<std::vector<FrameView>>)> done);
  /// cancel, pause, resume and set_priority return the job after the change, once the change is in
  /// the journal. NOT_FOUND: no such job. FAILED_PRECONDITION: the job is over. cancel does not
  /// return this error.
  void cancel(JobId job, std::function<void(absl::StatusOr<JobView>)> done);
  void pause(JobId job, std::function<void(absl::StatusOr<JobView>)> done);
  void resume(JobId job, std::function<void(absl::StatusOr<JobView>)> done);
  /// Further error: INVALID_ARGUMENT if the priority is beyond kMaxPriority.
  void set_priority(JobId job, std::int32_t priority,
                    std::function<void(absl::StatusOr<JobView>)> done);
  /// Puts a machine into quarantine as if it had returned wrong pixels, or lifts its quarantine.
  /// NOT_FOUND: no such worker.
  void quarantine(std::string worker, bool lift, std::function<void(absl::Status)> done);
  /// Explains in sentences why the job is not done; empty: no such job.
  void why(JobId job, std::function<void(std::vector<std::string>)> done);
  /// Calls `changed` with the present state and after each change, until it returns false or the
  /// job is final. There are at most ten calls a second, and at least one call a second. The
  /// final state is always delivered. If there is no such job, `changed` is called with NOT_FOUND.
  void watch(JobId job, std::function<bool(absl::StatusOr<JobView>)> changed);
  /// Returns the jobs and sequences that `page` selects, ascending by id, without the jobs of
  /// frames. JobView::curve, log and shares are empty.
  void jobs(std::function<void(std::vector<JobView>)> done, JobPage page = {});
  void workers(std::function<void(std::vector<WorkerView>)> done);
  /// Returns the last lines of a worker's log. NOT_FOUND: no lines of such a worker.
  void logs(std::string worker, std::function<void(absl::StatusOr<std::vector<std::string>>)> done);
  /// Returns every row_step-th row of the present image of a job that is not over; `row_step` >= 1.
  /// NOT_FOUND: no such job, or none of its bands is stored.
  void preview(JobId job, std::uint32_t row_step, std::function<void(absl::StatusOr<Image>)> done);
  /// Returns the workers of the rows that are rendered, in the order of rows. After a restart, the
  /// names of the workers are empty in the jobs that are not over. A name becomes known again when
  /// the worker sends another band.
  void rendered_by(JobId job, std::function<void(std::vector<RowsBy>)> done);
  /// Returns a part of the result of a job: its image, the number of samples of each pixel
  /// (kSamples, of adaptive jobs), or the mean of the first samples (kFirst; store/finished.h).
  /// NOT_FOUND: no such job, or its result has no such part. FAILED_PRECONDITION: the job is not
  /// done. DATA_LOSS: the file is missing or damaged.
  void result(JobId job, FinishedPart part, std::function<void(absl::StatusOr<StoredResult>)> done);

  /// Returns the budget of the memory for images that are made or downloaded (1 GiB). A caller of
  /// result or preview takes the image's bytes from this budget first, and returns them when it
  /// frees the image.
  MemoryBudget& images();

  /// Returns the budget of the memory for bands (2 GiB): those that are arriving, and those that
  /// are not yet on disk and in the film.
  MemoryBudget& bands();

  // Blobs. These calls may block on the disk. So they MUST NOT be called on gRPC's own threads.
  class BlobWriter {
   public:
    virtual ~BlobWriter() = default;  ///< without commit, the bytes are kept for the next upload
    virtual absl::Status append(absl::Span<const std::byte> bytes) = 0;
    /// OK: the blob is on disk. INVALID_ARGUMENT: digest or size differ. DATA_LOSS: digest or size
    /// differ, and the blob contains bytes of an earlier upload.
    virtual absl::Status commit() = 0;
  };
  /// Returns true if the whole blob is stored.
  bool has_blob(const wire::Digest& digest) const;
  /// Returns the number of bytes at the beginning of a blob that an interrupted upload has stored.
  std::uint64_t partial_blob(const wire::Digest& digest) const;
  /// Begins the upload of a blob of `size` bytes. `offset`: continues an interrupted upload after
  /// this many bytes. FAILED_PRECONDITION: fewer bytes of the blob are stored. RESOURCE_EXHAUSTED:
  /// the disk is full.
  absl::StatusOr<std::unique_ptr<BlobWriter>> write_blob(const wire::Digest& digest,
                                                         std::uint64_t size,
                                                         std::uint64_t offset = 0);
  /// Returns the blobs, to read them.
  BlobSource& blobs();

  // Messages of workers. Replies go to the worker's link.

  /// A worker has connected. Returns the id of its session; the link receives `welcome` or
  /// `refuse`.
  SessionId hello(std::shared_ptr<WorkerLink> link, WorkerHello hello);
  void heartbeat(SessionId session, std::vector<LeaseProgress> leases, std::string doing);
  void draining(SessionId session, std::string reason);
  void band_failed(SessionId session, LeaseId lease, std::string reason,
                   std::vector<std::string> log);
  /// The worker's connection has ended.
  void lost(SessionId session, std::string reason);
  /// Adds lines to the worker's log. The lines MUST have been checked with log_lines()
  /// (rpc/checked_messages.h).
  void worker_log(SessionId session, std::vector<std::string> lines);
  /// Takes a band from a worker. The answer is OK once the band's pixels are on disk and the
  /// scheduler's decision about the band is in the journal, or if the band is not wanted
  /// (BandOutcome). RESOURCE_EXHAUSTED: disk or memory is full; the worker has to keep the band and
  /// send it again. INVALID_ARGUMENT: not a band of that job. FAILED_PRECONDITION: a browser sent
  /// the band, and `instance` is not a browser that has sent Hello. This check keeps a browser from
  /// sending bands in the name of a native worker.
  ///
  /// `work`: hash of the scene and settings that the band was rendered for
  /// (renderlib/render/work_hash.h), 0 if unknown. The hash shows whether the band was rendered for
  /// an earlier job with the same id: such a band is not wanted. `render_s`: seconds in which the
  /// worker rendered the band. `cpu_s`: CPU seconds of the worker's threads for the band.
  /// `browser`: a browser sent the band. `share`: the band's share of bands(); std::nullopt:
  /// put_band takes the share.
  void put_band(JobId job, std::uint64_t work, std::string instance, BandPixels pixels,
                double render_s, double cpu_s,
                std::function<void(absl::StatusOr<BandOutcome>)> done, bool browser = false,
                std::optional<MemoryBudget::Share> share = std::nullopt);

  /// Returns the free bytes of the disk with the data folder, 0 if that is unknown. May wait for
  /// the disk.
  std::uint64_t free_bytes() const;

  /// Returns the id of this epoch (run of the coordinator).
  const std::string& epoch() const;

 private:
  Engine(const EngineOptions& options, EngineDependencies dependencies, DataFolder folder,
         std::unique_ptr<BlobStore> blobs);
  void command(JobId job, const Input& input, std::function<void(absl::StatusOr<JobView>)> done);

  const DataFolder folder_;
  const std::unique_ptr<BlobStore> blobs_;
  const std::unique_ptr<Journal> journal_;
  const std::unique_ptr<Clock> clock_;
  const std::string epoch_;
  std::atomic<SessionId> last_session_{0};
  MemoryBudget bands_;   ///< bytes of the bands in memory
  MemoryBudget images_;  ///< bytes of the images that are made or downloaded
  // scheduler_, store_ and film_ each belong to one thread. Other threads send them messages by
  // these inboxes.
  PostedSchedulerInbox to_scheduler_;
  PostedStoreInbox to_store_;
  PostedFilmInbox to_film_;
  SchedulerThread scheduler_;
  StoreThread store_;
  FilmThread film_;
  Mailbox scheduler_mailbox_;
  Mailbox store_mailbox_;
  Mailbox film_mailbox_;
};

}  // namespace bandsaw::coordinator
