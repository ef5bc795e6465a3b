#pragma once

// The three threads of the engine and how they hand work to each other:
//
//   any thread -> core (decides, journals) -> store (files) -> core -> film (pixels) -> store
//   (result) -> core
//
// Each desk is used by its own thread alone; a thread reaches another desk only by posting to its
// mailbox.

#include <atomic>
#include <memory>
#include <string>

#include "coordinator/engine/clock.h"
#include "coordinator/engine/doors.h"
#include "coordinator/engine/engine.h"
#include "coordinator/engine/film_thread.h"
#include "coordinator/engine/incoming_band.h"
#include "coordinator/engine/mailbox.h"
#include "coordinator/engine/memory_budget.h"
#include "coordinator/engine/scheduler_thread.h"
#include "coordinator/engine/store_thread.h"
#include "coordinator/store/blob_store.h"
#include "coordinator/store/data_folder.h"
#include "coordinator/store/journal.h"

namespace bandsaw::coordinator {

class Engine::Impl {
 public:
  static absl::StatusOr<std::unique_ptr<Impl>> start(EngineOptions options,
                                                     EngineDependencies dependencies);
  ~Impl();

  template <class Task>
  void on_core(Task task) {
    core_thread_.post([this, task = std::move(task)]() mutable { task(core_); });
  }
  template <class Task>
  void on_store(Task task) {
    store_thread_.post([this, task = std::move(task)]() mutable { task(store_); });
  }
  template <class Task>
  void on_film(Task task) {
    film_thread_.post([this, task = std::move(task)]() mutable { task(film_); });
  }

  void tell(JobId job, Input input, std::function<void(absl::StatusOr<JobView>)> done) {
    on_core([job, input = std::move(input), answer = Answer<JobView>(std::move(done))](
                SchedulerThread& core) mutable { core.tell(job, input, std::move(answer)); });
  }

  BlobStore& blobs() { return *blobs_; }
  MemoryBudget& bands() { return bands_; }
  MemoryBudget& images() { return images_; }
  /// True if the disk has room for new data. Callable from any thread.
  bool room() const { return room_; }
  SessionId next_session() { return ++last_session_; }
  const std::string& epoch() const { return epoch_; }
  const std::string& data_folder() const { return folder_.path(); }

 private:
  Impl(const EngineOptions& options, EngineDependencies dependencies, DataFolder folder,
       std::unique_ptr<BlobStore> blobs);
  /// On the store's thread.
  void collect(const std::vector<Collector::Job>& jobs);
  SchedulerThread::Hooks core_hooks();
  StoreThread::Hooks store_hooks();
  FilmThread::Hooks film_hooks();

  const DataFolder folder_;
  const std::unique_ptr<BlobStore> blobs_;
  const std::unique_ptr<Journal> journal_;
  const std::unique_ptr<Clock> clock_;
  const std::string epoch_;
  std::atomic<SessionId> last_session_{0};
  std::atomic<bool> room_{true};
  MemoryBudget bands_;   ///< bytes of the bands in memory
  MemoryBudget images_;  ///< bytes of the images that are made or downloaded
  SchedulerThread core_;
  StoreThread store_;
  Collector collector_;  ///< of the store's thread
  FilmThread film_;
  Mailbox core_thread_;
  Mailbox store_thread_;
  Mailbox film_thread_;
};

}  // namespace bandsaw::coordinator
