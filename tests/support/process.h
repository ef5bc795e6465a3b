#pragma once

// A child process whose output is read while it runs. The destructor kills and reaps it.

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

  /// Starts the program argv[0], a path that MUST exist. Its standard input is empty.
  /// `environment`: entries "NAME=value" that are added to the environment of the test. An entry
  /// replaces the test's variable of the same name.
  static Process start(std::vector<std::string> argv, std::vector<std::string> environment = {});
  Process(Process&&) noexcept;
  Process& operator=(Process&&) noexcept;
  ~Process();

  pid_t pid() const;
  /// Sends the signal `number`. Does nothing if the process has ended.
  void signal(int number);

  /// Standard output and standard error so far.
  std::string out() const;
  std::string err() const;

  /// Waits until either output contains `text`. Returns false if the process ended without it, or
  /// the time expired.
  bool wait_for(const std::string& text, Milliseconds timeout = std::chrono::seconds(60));

  /// Waits until `holds(standard output, standard error)` is true. Returns false if the process
  /// ended before that, or the time expired.
  bool wait_until(const std::function<bool(const std::string&, const std::string&)>& holds,
                  Milliseconds timeout = std::chrono::seconds(60));

  /// Waits for the end of the process and of its output. Returns the exit code, or 128 + the number
  /// of the signal that ended it; std::nullopt if the time expired. The default timeout is shorter
  /// than the 300 s after which CTest ends a test of a farm.
  std::optional<int> wait(Milliseconds timeout = std::chrono::seconds(250));

 private:
  struct State;
  explicit Process(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Result of a process that was run to its end.
struct Finished {
  int code = -1;  ///< -1: killed because the time expired
  std::string out;
  std::string err;
};
/// Runs a program to its end. The parameters are those of Process::start().
Finished run(std::vector<std::string> argv, std::vector<std::string> environment = {});

}  // namespace bandsaw::test
