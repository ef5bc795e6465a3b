#pragma once

#include <atomic>
#include <map>
#include <string>

#include "absl/status/statusor.h"
#include "coordinator/cli/machines/remote_hosts.h"
#include "coordinator/web/worker_program.h"

namespace bandsaw::coordinator {

/// Makes workers of other machines: asks a host for its architecture, then sends the program for
/// that and no other.
class Invitation {
 public:
  /// Reads the programs that lie with this one. `join`: the workers' join string. The error is that
  /// of this machine's own architecture where there is no program that can be sent, else the
  /// system's.
  static absl::StatusOr<Invitation> create(const std::string& join);

  /// Takes at most `seconds`. Else as RemoteScript::run; a host for which there is no program is
  /// told how to get it.
  RemoteOutcome invite(const std::string& host, double seconds,
                       const std::atomic<bool>& stop) const;

 private:
  using Scripts = std::map<Machine, absl::StatusOr<RemoteScript>>;
  Invitation(RemoteScript ask, Scripts scripts)
      : ask_(std::move(ask)), scripts_(std::move(scripts)) {}
  RemoteScript ask_;
  Scripts scripts_;  // one for every architecture; an error says why its program cannot be sent
};

}  // namespace bandsaw::coordinator
