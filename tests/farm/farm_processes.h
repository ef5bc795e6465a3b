#pragma once

// A real farm for one test: a coordinator on a port of its own, workers, and the command; all on
// loopback, or each on a machine of its own.

#include <map>
#include <string>
#include <vector>

#include "tests/farm/hosts.h"
#include "tests/support/process.h"
#include "tests/support/temp_dir.h"

namespace bandsaw::test {

class FarmProcesses {
 public:
  /// Starts the coordinator, with `options` besides (none that renders bands twice: tests count
  /// them); on the machine "house" where there are
  /// `hosts`, which MUST stay. A worker is then started on the machine of its name.
  explicit FarmProcesses(const Hosts* hosts = nullptr,
                         std::vector<std::string> options = {"--audit", "0%"});

  /// Starts a worker and waits until it has joined.
  Process& add_worker(const std::string& name, int threads,
                      const std::string& program = BANDSAW_WORKER_BIN);
  Process& worker(const std::string& name) { return workers_.at(name); }
  /// Everything the worker has logged.
  std::string worker_log(const std::string& name) { return worker(name).err(); }
  std::vector<std::string> worker_names() const;

  Process& coordinator() { return *coordinator_; }
  /// Everything that it has logged, in all its lives.
  std::string coordinator_log() const { return earlier_log_ + coordinator_->err(); }
  /// Starts the coordinator again, on the same data and port.
  void restart_coordinator();

  /// `bandsaw ARGUMENTS --farm …`
  std::vector<std::string> command(std::vector<std::string> arguments) const;
  /// The command as it is started on the machine `host`, where there are hosts.
  std::vector<std::string> on(const std::string& host, std::vector<std::string> argv) const;
  std::string path(const std::string& name) const { return folder_ / name; }
  std::string join_file() const { return folder_ / "data/join"; }
  std::string farm_file() const { return folder_ / "data/farm"; }

 private:
  void start_coordinator();
  TempDir folder_;
  const Hosts* hosts_;
  std::vector<std::string> options_;
  std::string listen_;
  std::unique_ptr<Process> coordinator_;
  std::string earlier_log_;
  std::map<std::string, Process> workers_;
};

/// The bytes of a file; the test fails when it cannot be read.
std::string file_bytes(const std::string& path);

}  // namespace bandsaw::test
