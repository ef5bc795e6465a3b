// Starts the three threads (scheduler, store and film), and turns each call into a message to the
// thread that answers it.

#include "coordinator/engine/engine.h"

#include <spdlog/spdlog.h>

#include <chrono>
#include <random>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "coordinator/engine/submit_check.h"
#include "coordinator/store/sqlite_journal.h"
#include "proto/wire/versions.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/render/canary.h"
#include "renderlib/render/pixel_version.h"

namespace bandsaw::coordinator {
namespace {

using std::chrono::milliseconds;

/// Bounds of the memory for bands on their way to disk and film, and for images that are made or
/// downloaded (README.md, "Why").
constexpr std::uint64_t kMaxBandBytes = 2ull << 30;
constexpr std::uint64_t kMaxImageBytes = 1ull << 30;
static_assert(kMaxImageBytes > kMaxPixels * sizeof(Rgb), "the largest image can be downloaded");

/// Returns a random name for this run of the coordinator, 32 hexadecimal digits.
std::string new_epoch() {
  std::random_device random;
  std::string epoch;
  for (int i = 0; i < 4; ++i) {
    absl::StrAppendFormat(&epoch, "%08x", random());
  }
  return epoch;
}

SchedulerOptions scheduler_options(const EngineOptions& options, const std::string& epoch) {
  SchedulerOptions wanted;
  wanted.compatibility = {
      .protocol = wire::kProtocol, .pixel_version = kPixelVersion, .canary = canary()};
  wanted.heartbeat_timeout_s = options.heartbeat_timeout_s;
  wanted.progress_timeout_s = options.progress_timeout_s;
  wanted.reattach_grace_s = options.reattach_grace_s;
  wanted.audit_share = options.audit_share;
  wanted.browser_audit_share = options.browser_audit_share;
  wanted.browsers = options.browsers;
  wanted.epoch = epoch;
  return wanted;
}

/// Makes the reserve, a file that keeps disk space for the journal, and returns OK if a little more
/// data can be written. Otherwise releases the reserve, so that the journal can be opened and the
/// rest of the start has space for small files.
absl::Status ensure_disk_space(const DataFolder& folder) {
  constexpr std::uint64_t kLittle = 1 << 20;
  Reserve reserve(folder.reserve());
  absl::Status space = reserve.hold();
  space.Update(probe_disk(folder.path(), kLittle));
  if (!space.ok()) {
    reserve.release();
  }
  return space;
}

class BlobUpload : public Engine::BlobWriter {
 public:
  explicit BlobUpload(BlobStore::Writer writer) : writer_(std::move(writer)) {}
  absl::Status append(absl::Span<const std::byte> bytes) override { return writer_.append(bytes); }
  absl::Status commit() override { return writer_.commit(); }

 private:
  BlobStore::Writer writer_;
};

/// Returns an Answer that calls `done` with its list, or with an empty list instead of an error.
template <class T>
Answer<std::vector<T>> list_answer(std::function<void(std::vector<T>)> done) {
  return Answer<std::vector<T>>([done = std::move(done)](absl::StatusOr<std::vector<T>> list) {
    done(list.ok() ? *std::move(list) : std::vector<T>());
  });
}

}  // namespace

Engine::Engine(const EngineOptions& options, EngineDependencies dependencies, DataFolder folder,
               std::unique_ptr<BlobStore> blobs)
    : folder_(std::move(folder)),
      blobs_(std::move(blobs)),
      journal_(std::move(dependencies.journal)),
      clock_(std::move(dependencies.clock)),
      epoch_(new_epoch()),
      bands_(kMaxBandBytes),
      images_(kMaxImageBytes),
      to_scheduler_(scheduler_, scheduler_mailbox_),
      to_store_(store_, store_mailbox_),
      to_film_(film_, film_mailbox_),
      scheduler_(scheduler_options(options, epoch_), *journal_, Reserve(folder_.reserve()), *clock_,
                 to_store_, to_film_),
      store_(folder_, *blobs_, options.keep, *clock_, to_scheduler_),
      film_(folder_, to_scheduler_, to_store_),
      // If no messages arrive, settle() is called at these intervals, for the scheduler's ticks and
      // the store's tests of the disk. The film's thread has no such work.
      scheduler_mailbox_([this] { scheduler_.settle(); }, milliseconds(100)),
      store_mailbox_([this] { store_.settle(); }, milliseconds(100)),
      film_mailbox_([] {}, milliseconds(1000)) {}

absl::StatusOr<std::unique_ptr<Engine>> Engine::start(EngineOptions options,
                                                      EngineDependencies dependencies) {
  ASSIGN_OR_RETURN(DataFolder folder, DataFolder::open(options.data_folder));
  const absl::Status space = ensure_disk_space(folder);
  if (!space.ok() && !absl::IsResourceExhausted(space)) {
    return space;
  }
  ASSIGN_OR_RETURN(std::unique_ptr<BlobStore> blobs, BlobStore::open(folder.blobs()));
  if (dependencies.journal == nullptr) {
    ASSIGN_OR_RETURN(dependencies.journal, SqliteJournal::open(folder.journal()));
  }
  if (dependencies.clock == nullptr) {
    dependencies.clock = std::make_unique<SteadyClock>();
  }
  std::unique_ptr<Engine> engine(
      new Engine(options, std::move(dependencies), std::move(folder), std::move(blobs)));
  RETURN_IF_ERROR(engine->scheduler_.restore(engine->store_, engine->film_, space));
  engine->film_mailbox_.start();
  engine->store_mailbox_.start();
  engine->scheduler_mailbox_.start();
  return engine;
}

Engine::~Engine() {
  scheduler_mailbox_.stop();
  store_mailbox_.stop();
  film_mailbox_.stop();
}

void Engine::submit(JobSpec spec, std::function<void(absl::StatusOr<JobId>)> done,
                    std::int32_t priority) {
  // The check reads the package from the disk. So it runs on the store's thread, where it delays
  // neither the caller nor the scheduler.
  to_store_.post([this, spec = std::move(spec), priority,
                  answer = Answer<JobId>(std::move(done))](StoreThread&) mutable {
    if (const absl::Status fit = check_submit(spec, *blobs_); !fit.ok()) {
      answer(fit);
    } else {
      to_scheduler_.call(&SchedulerThread::submit,
                         Input(input::Submit{.spec = std::move(spec), .priority = priority}),
                         std::move(answer));
    }
  });
}

void Engine::submit_sequence(SequenceSpec spec, std::function<void(absl::StatusOr<JobId>)> done,
                             std::int32_t priority) {
  Answer<JobId> answer(std::move(done));
  if (const absl::Status fit = check_sequence(spec); !fit.ok()) {
    answer(fit);
    return;
  }
  to_scheduler_.call(&SchedulerThread::submit,
                     Input(input::SubmitSequence{.spec = std::move(spec), .priority = priority}),
                     std::move(answer));
}

void Engine::add_frames(JobId sequence, std::vector<FrameScene> scenes,
                        std::function<void(absl::StatusOr<JobView>)> done) {
  to_store_.post([this, sequence, scenes = std::move(scenes),
                  answer = Answer<JobView>(std::move(done))](StoreThread&) mutable {
    for (FrameScene& scene : scenes) {
      const absl::StatusOr<std::uint64_t> bytes = check_package(scene.manifest, *blobs_);
      if (!bytes.ok()) {
        answer(absl::Status(bytes.status().code(),
                            absl::StrCat("frame ", scene.number, ": ", bytes.status().message())));
        return;
      }
      scene.package_bytes = *bytes;
    }
    to_scheduler_.call(&SchedulerThread::command, sequence,
                       Input(input::AddFrames{.job = sequence, .scenes = std::move(scenes)}),
                       std::move(answer));
  });
}

void Engine::retry_frames(JobId sequence, std::vector<FrameNumber> frames,
                          std::function<void(absl::StatusOr<JobView>)> done) {
  command(sequence, input::RetryFrames{.job = sequence, .frames = std::move(frames)},
          std::move(done));
}

void Engine::frames(JobId sequence, std::uint64_t after,
                    std::function<void(absl::StatusOr<std::vector<FrameView>>)> done) {
  to_scheduler_.post(
      [sequence, after, answer = Answer<std::vector<FrameView>>(std::move(done))](
          SchedulerThread& scheduler) mutable { answer(scheduler.frames(sequence, after)); });
}

void Engine::command(JobId job, const Input& input,
                     std::function<void(absl::StatusOr<JobView>)> done) {
  to_scheduler_.call(&SchedulerThread::command, job, input, Answer<JobView>(std::move(done)));
}

void Engine::cancel(JobId job, std::function<void(absl::StatusOr<JobView>)> done) {
  command(job, input::Cancel{.job = job}, std::move(done));
}

void Engine::pause(JobId job, std::function<void(absl::StatusOr<JobView>)> done) {
  command(job, input::Pause{.job = job}, std::move(done));
}

void Engine::resume(JobId job, std::function<void(absl::StatusOr<JobView>)> done) {
  command(job, input::Resume{.job = job}, std::move(done));
}

void Engine::set_priority(JobId job, std::int32_t priority,
                          std::function<void(absl::StatusOr<JobView>)> done) {
  command(job, input::SetPriority{.job = job, .priority = priority}, std::move(done));
}

void Engine::quarantine(std::string worker, bool lift, std::function<void(absl::Status)> done) {
  Answer<bool> answer(
      [done = std::move(done)](const absl::StatusOr<bool>& changed) { done(changed.status()); });
  const Input input = lift ? Input(input::LiftQuarantine{std::move(worker)})
                           : Input(input::Quarantine{std::move(worker)});
  to_scheduler_.call(&SchedulerThread::command_worker, input, std::move(answer));
}

void Engine::why(JobId job, std::function<void(std::vector<std::string>)> done) {
  to_scheduler_.post([job, answer = list_answer(std::move(done))](
                         SchedulerThread& scheduler) mutable { answer(scheduler.why(job)); });
}

void Engine::watch(JobId job, std::function<bool(absl::StatusOr<JobView>)> changed) {
  to_scheduler_.call(&SchedulerThread::watch, job, std::move(changed));
}

void Engine::jobs(std::function<void(std::vector<JobView>)> done, JobPage page) {
  to_scheduler_.post([page, answer = list_answer(std::move(done))](
                         SchedulerThread& scheduler) mutable { answer(scheduler.jobs(page)); });
}

void Engine::workers(std::function<void(std::vector<WorkerView>)> done) {
  to_scheduler_.post([answer = list_answer(std::move(done))](SchedulerThread& scheduler) mutable {
    answer(scheduler.workers());
  });
}

void Engine::logs(std::string worker,
                  std::function<void(absl::StatusOr<std::vector<std::string>>)> done) {
  to_scheduler_.post(
      [worker = std::move(worker), answer = Answer<std::vector<std::string>>(std::move(done))](
          SchedulerThread& scheduler) mutable { answer(scheduler.worker_log(worker)); });
}

void Engine::preview(JobId job, std::uint32_t row_step,
                     std::function<void(absl::StatusOr<Image>)> done) {
  to_film_.post([job, row_step, answer = Answer<Image>(std::move(done))](FilmThread& film) mutable {
    answer(film.preview(job, row_step));
  });
}

void Engine::rendered_by(JobId job, std::function<void(std::vector<RowsBy>)> done) {
  to_film_.post([job, answer = list_answer(std::move(done))](FilmThread& film) mutable {
    answer(film.rendered_by(job));
  });
}

void Engine::result(JobId job, FinishedPart part,
                    std::function<void(absl::StatusOr<StoredResult>)> done) {
  to_scheduler_.post([this, job, part, answer = Answer<StoredResult>(std::move(done))](
                         SchedulerThread& scheduler) mutable {
    const std::optional<JobView> view = scheduler.job(job);
    if (!view) {
      answer(absl::NotFoundError(absl::StrCat("there is no job ", job)));
    } else if (view->has_frames()) {
      answer(absl::FailedPreconditionError(
          absl::StrCat("job ", job, " has frames, each with an image of its own: bandsaw watch ",
                       job, " -o NAME.####.png fetches them")));
    } else if (view->state != JobState::kDone) {
      answer(absl::FailedPreconditionError(absl::StrCat("job ", job, " is not done")));
    } else {
      to_store_.post([this, job, part, manifest = view->spec.manifest,
                      answer = std::move(answer)](StoreThread& store) mutable {
        absl::StatusOr<StoredResult> result = store.read_result(job, part);
        if (result.ok()) {
          result->display = display_of(manifest, *blobs_);
        }
        answer(std::move(result));
      });
    }
  });
}

MemoryBudget& Engine::images() { return images_; }

MemoryBudget& Engine::bands() { return bands_; }

bool Engine::has_blob(const wire::Digest& digest) const { return blobs_->has(digest); }

std::uint64_t Engine::partial_blob(const wire::Digest& digest) const {
  return blobs_->partial(digest);
}

absl::StatusOr<std::unique_ptr<Engine::BlobWriter>> Engine::write_blob(const wire::Digest& digest,
                                                                       std::uint64_t size,
                                                                       std::uint64_t offset) {
  if (!scheduler_.has_disk_space()) {
    return absl::ResourceExhaustedError(
        "the coordinator's disk is full: it takes no scene now; cancel jobs, or free some room");
  }
  ASSIGN_OR_RETURN(BlobStore::Writer writer, blobs_->write(digest, size, offset));
  return std::make_unique<BlobUpload>(std::move(writer));
}

BlobSource& Engine::blobs() { return *blobs_; }

SessionId Engine::hello(std::shared_ptr<WorkerLink> link, WorkerHello hello) {
  const SessionId session = ++last_session_;
  to_scheduler_.call(&SchedulerThread::hello, session, std::move(link), std::move(hello));
  return session;
}

void Engine::heartbeat(SessionId session, std::vector<LeaseProgress> leases, std::string doing) {
  to_scheduler_.call(
      &SchedulerThread::observe,
      input::Heartbeat{.session = session, .leases = std::move(leases), .doing = std::move(doing)});
}

void Engine::draining(SessionId session, std::string reason) {
  to_scheduler_.call(&SchedulerThread::observe,
                     input::Draining{.session = session, .reason = std::move(reason)});
}

void Engine::band_failed(SessionId session, LeaseId lease, std::string reason,
                         std::vector<std::string> log) {
  to_scheduler_.call(
      &SchedulerThread::observe,
      input::BandFailed{
          .session = session, .lease = lease, .reason = std::move(reason), .log = std::move(log)});
}

void Engine::lost(SessionId session, std::string reason) {
  to_scheduler_.call(&SchedulerThread::lost, session, std::move(reason));
}

void Engine::worker_log(SessionId session, std::vector<std::string> lines) {
  to_scheduler_.call(&SchedulerThread::add_worker_log, session, std::move(lines));
}

void Engine::put_band(JobId job, std::uint64_t work, std::string instance, BandPixels pixels,
                      double render_s, double cpu_s,
                      std::function<void(absl::StatusOr<BandOutcome>)> done, bool browser,
                      std::optional<MemoryBudget::Share> share) {
  IncomingBand incoming{.job = job,
                        .work = work,
                        .instance = std::move(instance),
                        .browser = browser,
                        .pixels = std::move(pixels),
                        .worker = {},
                        .render_s = render_s,
                        .cpu_s = cpu_s,
                        .answer = Answer<BandOutcome>(std::move(done)),
                        .share = {}};
  if (!share) {
    share = bands_.take(incoming.pixels.sums.size() * sizeof(double));
  }
  if (!share) {
    incoming.answer(no_memory_for_band());
    return;
  }
  incoming.share = *std::move(share);
  to_scheduler_.call(&SchedulerThread::put_band, std::move(incoming));
}

std::uint64_t Engine::free_bytes() const {
  return coordinator::free_bytes(folder_.path()).value_or(0);
}

const std::string& Engine::epoch() const { return epoch_; }

}  // namespace bandsaw::coordinator
