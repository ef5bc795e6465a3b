#pragma once

// Simulated machines of one test: network namespaces that are connected by one switch, which is a
// namespace too. The test creates and removes them. Addresses are 10.77.0.1, .2, … in the order of
// the names.

#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"

namespace bandsaw::test {

/// The machines and their switch. The functions take the names of machines.
class Hosts {
 public:
  /// While this object exists, the sockets that the calling thread opens and the processes that the
  /// thread starts belong to the visited machine. The thread that created the object MUST destroy
  /// it.
  class Visit {
   public:
    ~Visit();
    Visit(const Visit&) = delete;
    Visit& operator=(const Visit&) = delete;

   private:
    friend class Hosts;
    explicit Visit(const std::string& space);
    int home_;  ///< file descriptor of the thread's own namespace
  };

  /// Creates the machines of these names and the switch. PERMISSION_DENIED: this process cannot
  /// create namespaces, which needs root and the command `ip`.
  static absl::StatusOr<std::unique_ptr<Hosts>> create(std::vector<std::string> names);
  ~Hosts();
  Hosts(const Hosts&) = delete;
  Hosts& operator=(const Hosts&) = delete;

  std::string address(const std::string& name) const;  ///< IPv4, without a port
  /// Returns the command line that runs `argv` on machine `name`. The process that it starts
  /// becomes `argv`, so signals to this process reach `argv`.
  std::vector<std::string> on(const std::string& name, std::vector<std::string> argv) const;
  /// Moves the calling thread to machine `name` while the returned object exists.
  std::unique_ptr<Visit> visit(const std::string& name) const;

  /// Disconnects the cable: packets are dropped in both directions, connections are not reset.
  /// plug() connects it again.
  void unplug(const std::string& name) const;
  void plug(const std::string& name) const;
  /// Drops packets from `from` to `to`; the other direction works.
  void deafen(const std::string& from, const std::string& to) const;
  /// Applies traffic shaping to what the machine sends; `discipline` holds the arguments of `tc
  /// qdisc … root`. Returns false if the kernel does not support it.
  bool shape(const std::string& name, const std::vector<std::string>& discipline) const;

 private:
  explicit Hosts(std::vector<std::string> names);
  std::string space_of(const std::string& name) const;
  /// Runs `ip` in the namespace of the switch or of a machine; returns true on success.
  bool ip(const std::string& space, std::vector<std::string> arguments) const;
  /// Creates a machine and its cable to the switch; returns true on success.
  bool add(const std::string& name) const;
  std::vector<std::string> names_;
  std::string prefix_;  ///< prefix of the namespaces' names
};

}  // namespace bandsaw::test
