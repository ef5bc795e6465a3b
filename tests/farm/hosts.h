#pragma once

// Machines of one test: network namespaces, each with one cable to a switch of its own, which this
// test makes and takes away. Addresses are 10.77.0.1, .2, … in the order of the names.

#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"

namespace bandsaw::test {

class Hosts {
 public:
  /// PERMISSION_DENIED: namespaces may not be made here (it takes root and the command `ip`).
  static absl::StatusOr<std::unique_ptr<Hosts>> create(std::vector<std::string> names);
  ~Hosts();
  Hosts(const Hosts&) = delete;
  Hosts& operator=(const Hosts&) = delete;

  std::string address(const std::string& name) const;
  /// The command as it is started on that machine; the process is the command's own.
  std::vector<std::string> on(const std::string& name, std::vector<std::string> argv) const;

  /// The cable: packets vanish both ways, connections stay as they are.
  void unplug(const std::string& name) const;
  void plug(const std::string& name) const;
  /// Packets of `from` to `to` vanish, those the other way arrive.
  void deafen(const std::string& from, const std::string& to) const;
  /// Shapes what the machine sends: arguments of `tc qdisc … root`. False: this kernel cannot.
  bool shape(const std::string& name, const std::vector<std::string>& discipline) const;

 private:
  explicit Hosts(std::vector<std::string> names);
  std::string space_of(const std::string& name) const;
  /// `ip` in the namespace of the switch, or of a machine; true: it worked.
  bool ip(const std::string& space, std::vector<std::string> arguments) const;
  bool add(const std::string& name) const;
  std::vector<std::string> names_;
  std::string prefix_;  ///< of the names of the namespaces
};

}  // namespace bandsaw::test
