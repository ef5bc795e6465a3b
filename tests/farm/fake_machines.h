#pragma once

// Machines behind an `ssh` that is a script: each is a HOME below a folder, and what the command
// would run elsewhere runs here.

#include <string>
#include <vector>

#include "tests/support/temp_dir.h"

namespace bandsaw::test {

class FakeMachines {
 public:
  FakeMachines();
  /// Ends the workers that are still there.
  ~FakeMachines();
  FakeMachines(const FakeMachines&) = delete;
  FakeMachines& operator=(const FakeMachines&) = delete;

  /// A command of this machine's that runs `script` (of a shell) in the place of its own.
  void replace(const std::string& host, const std::string& command, const std::string& script);
  /// systemctl and loginctl that keep one user service, and write down what they are asked.
  void add_systemd(const std::string& host);
  /// With our `ssh` before the real one. A host "nobody" cannot be reached, "stranger" has an
  /// unknown key, "frozen" never answers.
  std::vector<std::string> environment() const;
  std::string home(const std::string& host) const { return folder_ / ("homes/" + host); }
  std::string worker_folder(const std::string& host) const {
    return home(host) + "/.local/share/bandsaw-worker";
  }

 private:
  TempDir folder_;
};

}  // namespace bandsaw::test
