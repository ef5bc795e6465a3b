// Fuzz target (fuzz.h): the messages of a worker to the coordinator. Two bytes before each message
// are its length, little-endian. The messages are checked as the coordinator checks them, then
// given to a scheduler that has a job. The scheduler's invariants must hold.

#include "coordinator/rpc/checked_messages.h"
#include "coordinator/scheduler/scheduler.h"
#include "renderlib/base/check.h"
#include "tests/fuzz/fuzz.h"

namespace {

using namespace bandsaw;
using namespace bandsaw::coordinator;

SchedulerOptions fuzz_options() {
  SchedulerOptions options;
  options.epoch = "fuzz";
  options.audit_share = 0.5;  // half of the bands are rendered twice, so audits are often tried
  return options;
}

void submit_job(Scheduler& scheduler) {
  JobSpec spec;
  spec.request_id = "0123456789abcdef";
  spec.manifest = std::string(64, 'a');
  spec.settings = {.width = 8, .height = 8, .max_depth = 2, .seed = 0};
  spec.stop = StopAtSamples{64};
  scheduler.step(input::Submit{spec}, 0);
}

/// Returns the scheduler's input for a message. Returns nullopt if the coordinator refuses the
/// message, or does not give messages of this kind to the scheduler.
std::optional<Input> as_input(const farm::FromWorker& message) {
  constexpr SessionId kSession = 1;
  switch (message.kind_case()) {
    case farm::FromWorker::kHello:
      if (auto hello = worker_hello(message.hello(), "address"); hello.ok()) {
        hello->protocol = 0;  // compatible with the coordinator, whatever the input contains
        hello->pixel_version = 0;
        hello->canary = 0;
        return input::Hello{kSession, *std::move(hello)};
      }
      return std::nullopt;
    case farm::FromWorker::kHeartbeat:
      if (auto beat = heartbeat(message.heartbeat()); beat.ok()) {
        beat->session = kSession;
        return *std::move(beat);
      }
      return std::nullopt;
    case farm::FromWorker::kFailed:
      if (auto failed = band_failed(message.failed()); failed.ok()) {
        failed->session = kSession;
        return *std::move(failed);
      }
      return std::nullopt;
    case farm::FromWorker::kDraining:
      if (auto reason = reason_field("reason", message.draining().reason()); reason.ok()) {
        return input::Draining{kSession, *std::move(reason)};
      }
      return std::nullopt;
    case farm::FromWorker::kLog:
      log_lines("line", message.log().line()).IgnoreError();
      return std::nullopt;
    case farm::FromWorker::KIND_NOT_SET:
      return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace

void bandsaw::fuzz::run(absl::Span<const std::uint8_t> in) {
  Scheduler scheduler(fuzz_options());
  submit_job(scheduler);
  double now = 0;
  while (in.size() >= 2) {
    const std::size_t length = std::min<std::size_t>(in[0] + 256u * in[1], in.size() - 2);
    farm::FromWorker message;
    if (message.ParseFromArray(in.data() + 2, static_cast<int>(length))) {
      if (const auto input = as_input(message)) {
        scheduler.step(*input, now += 0.25);
      }
      scheduler.step(input::Tick{}, now += 0.25);
      const auto broken = scheduler.broken_invariant();
      BANDSAW_CHECK(!broken, broken->c_str());
    }
    in.remove_prefix(2 + length);
  }
}
