// Fuzz target (fuzz.h): the messages of the coordinator to a worker. Two bytes before each message
// are its length, little-endian. Every task that the worker then starts must be one that can be
// rendered.

#include "renderlib/base/check.h"
#include "tests/fuzz/fuzz.h"
#include "worker/session/session.h"

void bandsaw::fuzz::run(absl::Span<const std::uint8_t> in) {
  worker::Session session({.instance = std::string(32, '0'), .name = "fuzz", .build = ""});
  std::vector<worker::TaskId> tasks;
  while (in.size() >= 2) {
    const std::size_t length = std::min<std::size_t>(in[0] + 256u * in[1], in.size() - 2);
    farm::ToWorker message;
    if (message.ParseFromArray(in.data() + 2, static_cast<int>(length))) {
      for (const worker::Task& task : session.receive(message).start) {
        tasks.push_back(task.id);
        BANDSAW_CHECK(validate(task.band, task.settings).ok(), "a task can be rendered");
      }
      session.heartbeat();
      session.hello();
      if (tasks.size() % 3 == 1) {  // some tasks end before the next message, and some do not
        session.finished(tasks.back());
      }
    }
    in.remove_prefix(2 + length);
  }
}
