#pragma once

// Implements the inboxes of the engine's threads (inboxes.h). Each message is posted to the mailbox
// of the receiving thread. That thread then calls the method of SchedulerThread, StoreThread or
// FilmThread that has the same name. Only pass_merged() calls a method with another name,
// observe().

#include <utility>
#include <vector>

#include "coordinator/engine/answer.h"
#include "coordinator/engine/film_thread.h"
#include "coordinator/engine/inboxes.h"
#include "coordinator/engine/mailbox.h"
#include "coordinator/engine/scheduler_thread.h"
#include "coordinator/engine/store_thread.h"

namespace bandsaw::coordinator {

class PostedSchedulerInbox final : public SchedulerInbox, public Posting<SchedulerThread> {
 public:
  using Posting::Posting;
  void band_stored(IncomingBand incoming, std::vector<std::uint64_t> row_digests) override {
    call(&SchedulerThread::band_stored, std::move(incoming), std::move(row_digests));
  }
  void band_failed(IncomingBand incoming, const absl::Status& status) override {
    call(&SchedulerThread::band_failed, std::move(incoming), unshared_status(status));
  }
  void result_written(JobId job, const absl::Status& status) override {
    call(&SchedulerThread::result_written, job, unshared_status(status));
  }
  void disk_is_back() override { call(&SchedulerThread::disk_is_back); }
  void forget(std::vector<JobId> jobs) override { call(&SchedulerThread::forget, std::move(jobs)); }
  void pass_merged(input::PassMerged merged) override {
    call(&SchedulerThread::observe, std::move(merged));
  }
  void storage_failed(JobId job, const absl::Status& status) override {
    call(&SchedulerThread::storage_failed, job, unshared_status(status));
  }
  void bands_damaged(input::BandsDamaged damaged) override {
    call(&SchedulerThread::bands_damaged, std::move(damaged));
  }
};

class PostedStoreInbox final : public StoreInbox, public Posting<StoreThread> {
 public:
  using Posting::Posting;
  void add_job(JobId job, const JobSpec& spec) override { call(&StoreThread::add_job, job, spec); }
  void append(IncomingBand incoming) override { call(&StoreThread::append, std::move(incoming)); }
  void compare(IncomingBand incoming) override { call(&StoreThread::compare, std::move(incoming)); }
  void write_result(JobId job, Finished finished) override {
    call(&StoreThread::write_result, job, std::move(finished));
  }
  void reopen(JobId job) override { call(&StoreThread::reopen, job); }
  void drop_bands(JobId job) override { call(&StoreThread::drop_bands, job); }
  void drop_job(JobId job) override { call(&StoreThread::drop_job, job); }
  void collect(std::vector<KeptJob> jobs) override { call(&StoreThread::collect, std::move(jobs)); }
  void test_disk_until_writable() override { call(&StoreThread::test_disk_until_writable); }
};

class PostedFilmInbox final : public FilmInbox, public Posting<FilmThread> {
 public:
  using Posting::Posting;
  void add_job(JobId job, const RenderSettings& settings, bool adaptive) override {
    call(&FilmThread::add_job, job, settings, adaptive);
  }
  void plan(JobId job, std::uint64_t samples) override { call(&FilmThread::plan, job, samples); }
  void add(IncomingBand incoming, std::vector<RowRange> rows) override {
    const JobId job = incoming.job;
    call(&FilmThread::add, job, std::move(incoming), std::move(rows));
  }
  void request_image(JobId job, std::uint64_t samples) override {
    call(&FilmThread::request_image, job, samples);
  }
  void retry() override { call(&FilmThread::retry); }
  void retract(JobId job, std::uint64_t process) override {
    call(&FilmThread::retract, job, process);
  }
  void drop(JobId job) override { call(&FilmThread::drop, job); }
};

}  // namespace bandsaw::coordinator
