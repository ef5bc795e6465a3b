#pragma once

// Simulated machines for tests, with a script in the place of `ssh`. Each machine is a home folder
// below a temporary folder, and its commands run on the machine of the test.

#include <string>
#include <vector>

#include "tests/support/temp_dir.h"

namespace bandsaw::test {

/// The machines of one test. A machine is created when `ssh` first names it.
class FakeMachines {
 public:
  FakeMachines();
  /// Ends the workers that are still running.
  ~FakeMachines();
  FakeMachines(const FakeMachines&) = delete;
  FakeMachines& operator=(const FakeMachines&) = delete;

  /// Replaces a command by a shell script on machine `host`; "all": on every machine.
  void replace(const std::string& host, const std::string& command, const std::string& script);
  /// Adds a systemctl and a loginctl that manage one user service and log their calls.
  void add_systemd(const std::string& host);
  /// Returns the environment in which `ssh` is the script. Three hosts have problems: "nobody"
  /// cannot be reached, "stranger" has an unknown key, and "frozen" never answers.
  std::vector<std::string> environment() const;
  std::string home(const std::string& host) const { return folder_ / ("homes/" + host); }
  std::string worker_folder(const std::string& host) const {
    return home(host) + "/.local/share/bandsaw-worker";
  }

 private:
  TempDir folder_;
};

}  // namespace bandsaw::test
