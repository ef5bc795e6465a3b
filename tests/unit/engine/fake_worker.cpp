// A worker on its own thread. It renders its leases (the bands that the engine gives it) with the
// real renderer. It may be stopped at any time.

#include "tests/unit/engine/fake_worker.h"

#include <algorithm>
#include <atomic>
#include <utility>

#include "proto/wire/versions.h"
#include "renderlib/render/canary.h"
#include "renderlib/render/pixel_version.h"
#include "renderlib/render/render_band.h"
#include "tests/unit/engine/box.h"

namespace bandsaw::coordinator {

/// The engine calls a link where it would send messages to a worker over the network. The link
/// keeps leases until the worker takes them. Thread-safe.
class FakeWorker::Link : public WorkerLink {
 public:
  void welcome(const action::Welcome&, const std::string&) override {}
  void refuse(const action::Refuse& refuse) override {
    MutexLock lock(mutex_);
    refused_ = refuse.reason;
  }
  void lease(const action::Lease& lease) override {
    MutexLock lock(mutex_);
    leases_.push_back(lease);
    leased_.push_back(lease.band);
    changed_.notify_all();
  }
  void revoke(const action::Revoke& revoke) override {
    MutexLock lock(mutex_);
    std::erase_if(leases_, [&](const action::Lease& lease) {
      return std::count(revoke.leases.begin(), revoke.leases.end(), lease.lease) != 0;
    });
  }
  void close(const std::string&) override { stop(); }

  void stop() {
    MutexLock lock(mutex_);
    stopped_ = true;
    changed_.notify_all();
  }
  /// Waits for a lease and removes it from the queue. Returns false if the worker was stopped.
  bool next(action::Lease& lease) {
    MutexLock lock(mutex_);
    while (leases_.empty() && !stopped_) {
      changed_.wait(mutex_);
    }
    if (stopped_) {
      return false;
    }
    lease = leases_.front();
    leases_.pop_front();
    return true;
  }
  /// Waits for a short time, after which a band is sent again. Returns false if the worker was
  /// stopped.
  bool rest() {
    MutexLock lock(mutex_);
    if (!stopped_) {
      changed_.wait_for(mutex_, std::chrono::milliseconds(10));
    }
    return !stopped_;
  }
  std::vector<Band> leased() {
    MutexLock lock(mutex_);
    return leased_;
  }
  std::string refused() {
    MutexLock lock(mutex_);
    return refused_;
  }

 private:
  Mutex mutex_;
  CondVar changed_;
  std::deque<action::Lease> leases_ GUARDED_BY(mutex_);
  std::vector<Band> leased_ GUARDED_BY(mutex_);
  std::string refused_ GUARDED_BY(mutex_);
  bool stopped_ GUARDED_BY(mutex_) = false;
};

FakeWorker::FakeWorker(std::shared_ptr<const Scene> scene, std::string name, Answered answered)
    : scene_(std::move(scene)), name_(std::move(name)), answered_(std::move(answered)) {}

FakeWorker::~FakeWorker() { leave(); }

void FakeWorker::join(Engine& engine) {
  leave();
  engine_ = &engine;
  link_ = std::make_shared<Link>();
  WorkerHello hello;
  hello.instance = name_ + std::string(32 - name_.size(), '0');  // the id of the worker's process
  hello.name = name_;
  hello.protocol = wire::kProtocol;
  hello.pixel_version = kPixelVersion;
  hello.canary = canary();
  session_ = engine.hello(link_, hello);
  thread_ = std::thread([this] { work(); });
}

void FakeWorker::leave() {
  if (!thread_.joinable()) {
    return;
  }
  link_->stop();
  thread_.join();
  engine_->lost(session_, "left");
  const std::vector<Band> bands = link_->leased();
  earlier_.insert(earlier_.end(), bands.begin(), bands.end());
}

std::vector<Band> FakeWorker::leased() const {
  std::vector<Band> all = earlier_;
  if (thread_.joinable()) {
    const std::vector<Band> bands = link_->leased();
    all.insert(all.end(), bands.begin(), bands.end());
  }
  return all;
}

std::string FakeWorker::refused() const { return link_->refused(); }

void FakeWorker::work() {
  action::Lease lease;
  while (link_->next(lease)) {
    render(lease);
  }
}

void FakeWorker::render(const action::Lease& lease) {
  Pool pool(1);
  const std::atomic<bool> stop{false};
  const absl::StatusOr<BandPixels> pixels =
      render_band(*scene_, lease.settings, lease.band, pool, stop, [](std::uint32_t) {});
  BANDSAW_CHECK(pixels.ok(), "the leases are valid");
  while (true) {
    const auto answer = std::make_shared<Box<absl::StatusOr<BandOutcome>>>();
    engine_->put_band(
        lease.job, /*work=*/0, name_ + std::string(32 - name_.size(), '0'), *pixels,
        /*render_s=*/0.01, /*cpu_s=*/0.01,
        [answer](absl::StatusOr<BandOutcome> outcome) { answer->put(std::move(outcome)); });
    const absl::StatusOr<BandOutcome> outcome = answer->take();
    if (answered_) {
      answered_(lease.band, outcome);
    }
    if (!absl::IsResourceExhausted(outcome.status()) || !link_->rest()) {
      return;
    }
  }
}

}  // namespace bandsaw::coordinator
