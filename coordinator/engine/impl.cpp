#include "coordinator/engine/impl.h"

#include <spdlog/spdlog.h>

#include <chrono>
#include <random>
#include <utility>

#include "absl/strings/str_format.h"
#include "coordinator/engine/apart.h"
#include "coordinator/store/sqlite_journal.h"
#include "proto/wire/versions.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/render/canary.h"
#include "renderlib/render/pixel_version.h"

namespace bandsaw::coordinator {
namespace {

using std::chrono::milliseconds;

constexpr std::uint64_t kMaxBandBytes = 2ull << 30;
constexpr std::uint64_t kMaxImageBytes = 1ull << 30;
static_assert(kMaxImageBytes > kMaxPixels * sizeof(Rgb), "the largest image can be downloaded");

std::string new_epoch() {
  std::random_device random;
  std::string epoch;
  for (int i = 0; i < 4; ++i) {
    absl::StrAppendFormat(&epoch, "%08x", random());
  }
  return epoch;
}

double unix_seconds() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

SchedulerOptions core_options(const EngineOptions& options, const std::string& epoch) {
  SchedulerOptions core;
  core.compatibility = {
      .protocol = wire::kProtocol, .pixel_version = kPixelVersion, .canary = canary()};
  core.heartbeat_timeout_s = options.heartbeat_timeout_s;
  core.progress_timeout_s = options.progress_timeout_s;
  core.reattach_grace_s = options.reattach_grace_s;
  core.audit_share = options.audit_share;
  core.epoch = epoch;
  return core;
}

/// Whether the disk takes a little beside the reserve. Where it does not the reserve is released,
/// so that the journal can be opened and the rest of the start has room for small files.
absl::Status find_room(const DataFolder& folder) {
  constexpr std::uint64_t kLittle = 1 << 20;
  Reserve reserve(folder.reserve());
  absl::Status room = reserve.hold();
  room.Update(probe_disk(folder.path(), kLittle));
  if (!room.ok()) {
    reserve.release();
  }
  return room;
}

}  // namespace

Engine::Impl::Impl(const EngineOptions& options, EngineDoors doors, DataFolder folder,
                   std::unique_ptr<BlobStore> blobs)
    : folder_(std::move(folder)),
      blobs_(std::move(blobs)),
      journal_(std::move(doors.journal)),
      clock_(std::move(doors.clock)),
      epoch_(new_epoch()),
      bands_(kMaxBandBytes),
      images_(kMaxImageBytes),
      core_(core_options(options, epoch_), *journal_, Reserve(folder_.reserve()), *clock_,
            core_hooks()),
      store_(folder_, *clock_, store_hooks()),
      collector_(folder_, *blobs_, options.keep),
      film_(folder_, film_hooks()),
      core_thread_([this] { core_.settle(); }, milliseconds(100)),
      store_thread_([this] { store_.settle(); }, milliseconds(100)),
      film_thread_([] {}, milliseconds(1000)) {}

absl::StatusOr<std::unique_ptr<Engine::Impl>> Engine::Impl::start(EngineOptions options,
                                                                  EngineDoors doors) {
  ASSIGN_OR_RETURN(DataFolder folder, DataFolder::open(options.data_folder));
  const absl::Status room = find_room(folder);
  if (!room.ok() && !absl::IsResourceExhausted(room)) {
    return room;
  }
  ASSIGN_OR_RETURN(std::unique_ptr<BlobStore> blobs, BlobStore::open(folder.blobs()));
  if (doors.journal == nullptr) {
    ASSIGN_OR_RETURN(doors.journal, SqliteJournal::open(folder.journal()));
  }
  if (doors.clock == nullptr) {
    doors.clock = std::make_unique<SteadyClock>();
  }
  std::unique_ptr<Impl> impl(
      new Impl(options, std::move(doors), std::move(folder), std::move(blobs)));
  RETURN_IF_ERROR(impl->core_.restore(impl->store_, impl->film_, room));
  impl->film_thread_.start();
  impl->store_thread_.start();
  impl->core_thread_.start();
  return impl;
}

Engine::Impl::~Impl() {
  core_thread_.stop();
  store_thread_.stop();
  film_thread_.stop();
}

void Engine::Impl::collect(const std::vector<Collector::Job>& jobs) {
  const double now = unix_seconds();
  // What is forgotten goes when the journal says so (action::DropJob), its blobs with the next
  // sweep.
  collector_.sweep(jobs, now);
  std::vector<JobId> old = collector_.to_forget(jobs, now);
  if (!old.empty()) {
    on_core([old = std::move(old)](CoreDesk& core) { core.forget(old); });
  }
}

CoreDesk::Hooks Engine::Impl::core_hooks() {
  return {
      .add_job =
          [this](JobId job, const JobSpec& spec) {
            on_store([job, spec](StoreDesk& store) {
              store.add_job(job, spec).IgnoreError();  // tried again at its first band
            });
            on_film([job, settings = spec.settings, adaptive = is_adaptive(spec.stop)](
                        FilmDesk& film) { film.add_job(job, settings, adaptive); });
          },
      .plan_pass =
          [this](JobId job, std::uint64_t samples) {
            on_film([job, samples](FilmDesk& film) { film.plan(job, samples); });
          },
      .store_band =
          [this](PutBand put) {
            on_store(
                [put = std::move(put)](StoreDesk& store) mutable { store.append(std::move(put)); });
          },
      .compare_band =
          [this](PutBand put) {
            on_store([put = std::move(put)](StoreDesk& store) mutable {
              store.compare(std::move(put));
            });
          },
      .add_to_film =
          [this](PutBand put, std::vector<RowRange> rows) {
            on_film([put = std::move(put), rows = std::move(rows)](FilmDesk& film) mutable {
              const JobId job = put.job;
              film.add(job, std::move(put), std::move(rows))
                  .IgnoreError();  // the hook has told the core
            });
          },
      .retract =
          [this](JobId job, std::uint64_t renderer) {
            on_film([job, renderer](FilmDesk& film) { film.retract(job, renderer); });
          },
      .make_result =
          [this](JobId job, std::uint64_t samples) {
            on_film([job, samples](FilmDesk& film) { film.want_image(job, samples); });
          },
      .drop_bands =
          [this](JobId job) {
            on_store([job](StoreDesk& store) { store.drop_bands(job); });
            on_film([job](FilmDesk& film) { film.drop(job); });
          },
      .drop_job = [this](JobId job) { on_store([job](StoreDesk& store) { store.drop_job(job); }); },
      .collect =
          [this](std::vector<Collector::Job> jobs) {
            on_store([this, jobs = std::move(jobs)](StoreDesk&) { collect(jobs); });
          },
      .expect_trouble = [this] { on_store([](StoreDesk& store) { store.expect_trouble(); }); },
      .room = [this](bool there) { room_ = there; },
      .retry_film = [this] { on_film([](FilmDesk& film) { film.retry(); }); }};
}

StoreDesk::Hooks Engine::Impl::store_hooks() {
  return {
      .stored =
          [this](PutBand put, std::vector<std::uint64_t> digests) {
            on_core([put = std::move(put), digests = std::move(digests)](CoreDesk& core) mutable {
              core.band_stored(std::move(put), std::move(digests));
            });
          },
      .failed =
          [this](PutBand put, absl::Status status) {
            on_core([put = std::move(put), status = apart(status)](CoreDesk& core) mutable {
              core.band_failed(std::move(put), status);
            });
          },
      .result_written =
          [this](JobId job, absl::Status status) {
            on_core([job, status = apart(status)](CoreDesk& core) {
              core.result_written(job, status);
            });
          },
      .disk_is_back = [this] { on_core([](CoreDesk& core) { core.disk_is_back(); }); }};
}

FilmDesk::Hooks Engine::Impl::film_hooks() {
  return {.merged =
              [this](input::PassMerged merged) {
                on_core([merged](CoreDesk& core) { core.hear(merged); });
              },
          .image =
              [this](JobId job, Finished finished) {
                on_store([job, finished = std::move(finished)](StoreDesk& store) {
                  store.write_result(job, finished);
                });
              },
          .failed =
              [this](JobId job, absl::Status status) {
                // The core hears of it before the store can tell it that the disk is back.
                on_core([job, status = apart(status)](CoreDesk& core) {
                  core.storage_failed(job, status);
                });
                on_store([](StoreDesk& store) { store.expect_trouble(); });
              },
          .damaged =
              [this](JobId job, std::vector<input::BandsDamaged::DamagedBand> bands) {
                // Before the first of them is leased again.
                on_store([job](StoreDesk& store) { store.reopen(job); });
                on_core([job, bands = std::move(bands)](CoreDesk& core) mutable {
                  core.bands_damaged({.job = job, .bands = std::move(bands)});
                });
              }};
}

}  // namespace bandsaw::coordinator
