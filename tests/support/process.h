#pragma once

// A child process whose output is read while it runs. Killed and reaped when the object goes.

#include <sys/types.h>

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace bandsaw::test {

class Process {
 public:
  using Milliseconds = std::chrono::milliseconds;

  /// argv[0] is a path. `environment`: "NAME=value", in addition to the test's own, and in the place
  /// of those of the same name.
  static Process start(std::vector<std::string> argv, std::vector<std::string> environment = {});
  Process(Process&&) noexcept;
  Process& operator=(Process&&) noexcept;
  ~Process();

  pid_t pid() const;
  void signal(int number);

  /// Standard output, and standard error, so far.
  std::string out() const;
  std::string err() const;

  /// Waits until either output holds `text`. False: the process ended without it, or the time
  /// passed.
  bool wait_for(const std::string& text, Milliseconds timeout = std::chrono::seconds(60));

  /// Waits until `holds(standard output, standard error)`. False: as above.
  bool wait_until(const std::function<bool(const std::string&, const std::string&)>& holds,
                  Milliseconds timeout = std::chrono::seconds(60));

  /// The exit code, 128 + the signal's number where one ended it; nothing when the time passed.
  std::optional<int> wait(Milliseconds timeout = std::chrono::seconds(250));

 private:
  struct State;
  explicit Process(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Runs to the end.
struct Finished {
  int code = -1;  ///< -1: it did not end in time and was killed
  std::string out;
  std::string err;
};
Finished run(std::vector<std::string> argv, std::vector<std::string> environment = {});

}  // namespace bandsaw::test
