#include "coordinator/engine/engine.h"

#include <utility>

#include "absl/strings/str_cat.h"
#include "coordinator/engine/impl.h"
#include "coordinator/engine/submit_check.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

class BlobUpload : public Engine::BlobWriter {
 public:
  explicit BlobUpload(BlobStore::Writer writer) : writer_(std::move(writer)) {}
  absl::Status append(absl::Span<const std::byte> bytes) override { return writer_.append(bytes); }
  absl::Status commit() override { return writer_.commit(); }

 private:
  BlobStore::Writer writer_;
};

}  // namespace

Engine::Engine(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Engine::~Engine() = default;

absl::StatusOr<std::unique_ptr<Engine>> Engine::start(EngineOptions options) {
  return start(std::move(options), EngineDependencies{});
}

absl::StatusOr<std::unique_ptr<Engine>> Engine::start(EngineOptions options,
                                                      EngineDependencies dependencies) {
  ASSIGN_OR_RETURN(std::unique_ptr<Impl> impl,
                   Impl::start(std::move(options), std::move(dependencies)));
  return std::unique_ptr<Engine>(new Engine(std::move(impl)));
}

void Engine::submit(JobSpec spec, std::function<void(absl::StatusOr<JobId>)> done,
                    std::int32_t priority) {
  // The package is read from the disk, so not on the caller's thread and not on the core's.
  impl_->on_store([impl = impl_.get(), spec = std::move(spec), priority,
                   answer = Answer<JobId>(std::move(done))](StoreThread&) mutable {
    if (const absl::Status fit = check_submit(spec, impl->blobs()); !fit.ok()) {
      answer(fit);
      return;
    }
    impl->on_core([spec = std::move(spec), priority,
                   answer = std::move(answer)](SchedulerThread& core) mutable {
      core.submit(std::move(spec), priority, std::move(answer));
    });
  });
}

void Engine::cancel(JobId job, std::function<void(absl::StatusOr<JobView>)> done) {
  impl_->tell(job, input::Cancel{.job = job}, std::move(done));
}

void Engine::pause(JobId job, std::function<void(absl::StatusOr<JobView>)> done) {
  impl_->tell(job, input::Pause{.job = job}, std::move(done));
}

void Engine::resume(JobId job, std::function<void(absl::StatusOr<JobView>)> done) {
  impl_->tell(job, input::Resume{.job = job}, std::move(done));
}

void Engine::set_priority(JobId job, std::int32_t priority,
                          std::function<void(absl::StatusOr<JobView>)> done) {
  impl_->tell(job, input::SetPriority{.job = job, .priority = priority}, std::move(done));
}

void Engine::quarantine(std::string worker, bool lift, std::function<void(absl::Status)> done) {
  Answer<bool> answer(
      [done = std::move(done)](const absl::StatusOr<bool>& told) { done(told.status()); });
  const Input input = lift ? Input(input::LiftQuarantine{std::move(worker)})
                           : Input(input::Quarantine{std::move(worker)});
  impl_->on_core([input, answer = std::move(answer)](SchedulerThread& core) mutable {
    core.tell_of_worker(input, std::move(answer));
  });
}

void Engine::why(JobId job, std::function<void(std::vector<std::string>)> done) {
  Answer<std::vector<std::string>> answer([done = std::move(done)](auto lines) {
    done(lines.ok() ? *std::move(lines) : std::vector<std::string>());
  });
  impl_->on_core(
      [job, answer = std::move(answer)](SchedulerThread& core) mutable { answer(core.why(job)); });
}

void Engine::watch(JobId job, std::function<bool(absl::StatusOr<JobView>)> changed) {
  impl_->on_core([job, changed = std::move(changed)](SchedulerThread& core) mutable {
    core.watch(job, std::move(changed));
  });
}

void Engine::jobs(std::function<void(std::vector<JobView>)> done) {
  Answer<std::vector<JobView>> answer([done = std::move(done)](auto jobs) {
    done(jobs.ok() ? *std::move(jobs) : std::vector<JobView>());
  });
  impl_->on_core(
      [answer = std::move(answer)](SchedulerThread& core) mutable { answer(core.jobs()); });
}

void Engine::workers(std::function<void(std::vector<WorkerView>)> done) {
  Answer<std::vector<WorkerView>> answer([done = std::move(done)](auto workers) {
    done(workers.ok() ? *std::move(workers) : std::vector<WorkerView>());
  });
  impl_->on_core(
      [answer = std::move(answer)](SchedulerThread& core) mutable { answer(core.workers()); });
}

void Engine::logs(std::string worker,
                  std::function<void(absl::StatusOr<std::vector<std::string>>)> done) {
  impl_->on_core(
      [worker = std::move(worker), answer = Answer<std::vector<std::string>>(std::move(done))](
          SchedulerThread& core) mutable { answer(core.worker_log(worker)); });
}

void Engine::worker_log(SessionId session, std::vector<std::string> lines) {
  impl_->on_core([session, lines = std::move(lines)](SchedulerThread& core) mutable {
    core.worker_log(session, std::move(lines));
  });
}

void Engine::preview(JobId job, std::uint32_t row_step,
                     std::function<void(absl::StatusOr<Image>)> done) {
  impl_->on_film([job, row_step, answer = Answer<Image>(std::move(done))](
                     FilmThread& film) mutable { answer(film.preview(job, row_step)); });
}

void Engine::rendered_by(JobId job, std::function<void(std::vector<RowsBy>)> done) {
  Answer<std::vector<RowsBy>> answer([done = std::move(done)](auto rows) {
    done(rows.ok() ? *std::move(rows) : std::vector<RowsBy>());
  });
  impl_->on_film([job, answer = std::move(answer)](FilmThread& film) mutable {
    answer(film.rendered_by(job));
  });
}

void Engine::result(JobId job, FinishedPart part,
                    std::function<void(absl::StatusOr<StoredResult>)> done) {
  impl_->on_core([impl = impl_.get(), job, part,
                  answer = Answer<StoredResult>(std::move(done))](SchedulerThread& core) mutable {
    const std::optional<JobView> view = core.job(job);
    if (!view) {
      answer(absl::NotFoundError(absl::StrCat("there is no job ", job)));
    } else if (view->state != JobState::kDone) {
      answer(absl::FailedPreconditionError(absl::StrCat("job ", job, " is not done")));
    } else {
      impl->on_store([impl, job, part, manifest = view->spec.manifest,
                      answer = std::move(answer)](StoreThread& store) mutable {
        absl::StatusOr<StoredResult> result = store.read_result(job, part);
        if (result.ok()) {
          result->display = display_of(manifest, impl->blobs());
        }
        answer(std::move(result));
      });
    }
  });
}

bool Engine::has_blob(const wire::Digest& digest) const { return impl_->blobs().has(digest); }

std::uint64_t Engine::partial_blob(const wire::Digest& digest) const {
  return impl_->blobs().partial(digest);
}

absl::StatusOr<std::unique_ptr<Engine::BlobWriter>> Engine::write_blob(const wire::Digest& digest,
                                                                       std::uint64_t size,
                                                                       std::uint64_t offset) {
  if (!impl_->room()) {
    return absl::ResourceExhaustedError(
        "the coordinator's disk is full: it takes no scene now; cancel jobs, or free some room");
  }
  ASSIGN_OR_RETURN(BlobStore::Writer writer, impl_->blobs().write(digest, size, offset));
  return std::make_unique<BlobUpload>(std::move(writer));
}

BlobSource& Engine::blobs() { return impl_->blobs(); }

SessionId Engine::hello(std::shared_ptr<WorkerLink> link, WorkerHello hello) {
  const SessionId session = impl_->next_session();
  impl_->on_core(
      [session, link = std::move(link), hello = std::move(hello)](SchedulerThread& core) mutable {
        core.hello(session, std::move(link), std::move(hello));
      });
  return session;
}

void Engine::heartbeat(SessionId session, std::vector<LeaseProgress> leases, std::string doing) {
  impl_->on_core([beat = input::Heartbeat{.session = session,
                                          .leases = std::move(leases),
                                          .doing = std::move(doing)}](SchedulerThread& core) {
    core.hear(beat);
  });
}

void Engine::draining(SessionId session, std::string reason) {
  impl_->on_core([in = input::Draining{.session = session, .reason = std::move(reason)}](
                     SchedulerThread& core) { core.hear(in); });
}

void Engine::band_failed(SessionId session, LeaseId lease, std::string reason,
                         std::vector<std::string> log) {
  impl_->on_core(
      [in = input::BandFailed{.session = session,
                              .lease = lease,
                              .reason = std::move(reason),
                              .log = std::move(log)}](SchedulerThread& core) { core.hear(in); });
}

void Engine::lost(SessionId session, std::string reason) {
  impl_->on_core([session, reason = std::move(reason)](SchedulerThread& core) mutable {
    core.lost(session, std::move(reason));
  });
}

void Engine::put_band(JobId job, std::uint64_t work, std::string instance, BandPixels pixels,
                      double render_s, double cpu_s,
                      std::function<void(absl::StatusOr<BandOutcome>)> done) {
  IncomingBand incoming{.job = job,
                        .work = work,
                        .instance = std::move(instance),
                        .pixels = std::move(pixels),
                        .worker = {},
                        .render_s = render_s,
                        .cpu_s = cpu_s,
                        .answer = Answer<BandOutcome>(std::move(done)),
                        .share = {}};
  std::optional<MemoryBudget::Share> share =
      impl_->bands().take(incoming.pixels.sums.size() * sizeof(double));
  if (!share) {
    incoming.answer(absl::ResourceExhaustedError(
        "the coordinator holds as many bands in memory as it may; send this one again soon"));
    return;
  }
  incoming.share = *std::move(share);
  impl_->on_core([incoming = std::move(incoming)](SchedulerThread& core) mutable {
    core.put_band(std::move(incoming));
  });
}

MemoryBudget& Engine::images() { return impl_->images(); }

std::uint64_t Engine::free_bytes() const {
  return coordinator::free_bytes(impl_->data_folder()).value_or(0);
}

const std::string& Engine::epoch() const { return impl_->epoch(); }

}  // namespace bandsaw::coordinator
