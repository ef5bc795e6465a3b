#pragma once

// A worker without a network, for tests of the engine. It takes leases (bands to render) from the
// engine by function calls, and renders them on a thread of its own with the real renderer.

#include <deque>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "coordinator/engine/engine.h"
#include "renderlib/base/mutex.h"
#include "renderlib/scene/scene.h"

namespace bandsaw::coordinator {

class FakeWorker {
 public:
  /// Called on the worker's thread with the engine's answer to each band.
  using Answered = std::function<void(const Band&, const absl::StatusOr<BandOutcome>&)>;

  /// The worker renders `scene` for every job. `name`: at most 32 characters. The id of the
  /// worker's process is made from `name`.
  FakeWorker(std::shared_ptr<const Scene> scene, std::string name, Answered answered = nullptr);
  /// Ends the session and the thread.
  ~FakeWorker();

  /// Begins a session. Ends an earlier one first. `engine` MUST outlive the session.
  void join(Engine& engine);
  /// Ends the session after the present band. The worker's other leases are lost.
  void leave();

  /// Returns all bands that were leased to the worker, in all sessions.
  std::vector<Band> leased() const;
  /// Returns why the last session was refused, or an empty text if it was not refused.
  std::string refused() const;

 private:
  class Link;
  /// Renders leases until the worker is stopped.
  void work();
  /// Renders the band of a lease and sends it. Sends it again while the engine answers that its
  /// disk or memory is full.
  void render(const action::Lease& lease);

  std::shared_ptr<const Scene> scene_;
  std::string name_;
  Answered answered_;
  Engine* engine_ = nullptr;
  SessionId session_ = 0;
  std::shared_ptr<Link> link_;
  std::thread thread_;
  std::vector<Band> earlier_;  ///< leased in earlier sessions
};

}  // namespace bandsaw::coordinator
