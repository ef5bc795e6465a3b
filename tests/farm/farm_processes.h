#pragma once

// A farm of real processes for one test: a coordinator on a free port, workers, and commands of
// users. All processes are on loopback, or each is on a simulated machine of its own (hosts.h).

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "tests/farm/hosts.h"
#include "tests/support/process.h"
#include "tests/support/temp_dir.h"

namespace bandsaw::test {

/// The scene that most tests of the farm render.
inline const std::string kCornell = std::string(BANDSAW_GALLERY) + "/cornell.textproto";

/// The test fails unless the command succeeded.
inline void expect_success(const Finished& finished) {
  ASSERT_EQ(finished.code, 0) << finished.err;
}

/// The processes of one farm. The destructor ends all of them.
class FarmProcesses {
 public:
  /// Starts `program`, the command bandsaw, as the coordinator with additional `options`. Audits
  /// render some bands a second time. Tests count rendered bands, so the default options disable
  /// audits. If `hosts` is given, the coordinator runs on machine "coordinator" and each
  /// worker on the machine of its name; `hosts` MUST outlive this object. nullptr: all processes
  /// are on loopback.
  explicit FarmProcesses(const Hosts* hosts = nullptr,
                         std::vector<std::string> options = {"--audit", "0%"},
                         std::string program = BANDSAW_BIN);

  /// Starts a worker and waits until it has joined. A worker of the same name is replaced.
  Process& add_worker(const std::string& name, int threads,
                      const std::string& program = BANDSAW_WORKER_BIN);
  Process& worker(const std::string& name) { return workers_.at(name); }
  /// Returns the worker's whole log.
  std::string worker_log(const std::string& name) { return worker(name).err(); }
  std::vector<std::string> worker_names() const;

  Process& coordinator() { return *coordinator_; }
  /// Returns the log of the coordinator, from its first start through all restarts.
  std::string coordinator_log() const { return earlier_log_ + coordinator_->err(); }
  /// Restarts the coordinator with the same data folder and port.
  void restart_coordinator();

  /// Returns the command line `bandsaw ARGUMENTS --farm …`.
  std::vector<std::string> command(std::vector<std::string> arguments) const;
  /// Returns the command line that runs `argv` on machine `host`; `argv` itself if all processes
  /// are on loopback.
  std::vector<std::string> on(const std::string& host, std::vector<std::string> argv) const;
  std::string path(const std::string& name) const { return folder_ / name; }
  std::string join_file() const { return folder_ / "data/join"; }  ///< join string of workers
  std::string farm_file() const { return folder_ / "data/farm"; }  ///< join string of users

 private:
  void start_coordinator();
  TempDir folder_;
  const Hosts* hosts_;
  std::vector<std::string> options_;
  std::string program_;
  std::string listen_;
  std::unique_ptr<Process> coordinator_;
  std::string earlier_log_;
  std::map<std::string, Process> workers_;
};

/// Waits until `serve` has printed the line that a user pastes on a machine without a worker.
/// Returns the line. The test fails if the line does not come.
std::string line_to_paste(Process& coordinator);

/// Returns the bytes of a file; the test fails if it cannot be read.
std::string file_bytes(const std::string& path);

}  // namespace bandsaw::test
