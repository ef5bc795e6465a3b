// Simulated machines: network namespaces, whose virtual cables lead to one switch. Cables are
// pulled, delayed and made lossy with the command `ip` and its companion `tc`.

#include "tests/farm/hosts.h"

#include <fcntl.h>
#include <sched.h>
#include <unistd.h>

#include <algorithm>

#include "renderlib/base/check.h"
#include "tests/support/process.h"

namespace bandsaw::test {
namespace {

const std::string kIp = "/usr/sbin/ip";

// The switch has a namespace of its own, so that no interface name or route of the test's machine
// is changed.
const std::string kSwitch = "switch";

}  // namespace

Hosts::Visit::Visit(const std::string& space)
    : home_(open("/proc/thread-self/ns/net", O_RDONLY | O_CLOEXEC)) {
  const int there = open(("/run/netns/" + space).c_str(), O_RDONLY | O_CLOEXEC);
  BANDSAW_CHECK(home_ >= 0 && there >= 0 && setns(there, CLONE_NEWNET) == 0, space.c_str());
  close(there);
}

Hosts::Visit::~Visit() {
  BANDSAW_CHECK(setns(home_, CLONE_NEWNET) == 0, "the thread's own namespace exists");
  close(home_);
}

std::unique_ptr<Hosts::Visit> Hosts::visit(const std::string& name) const {
  return std::unique_ptr<Visit>(new Visit(space_of(name)));
}

Hosts::Hosts(std::vector<std::string> names)
    : names_(std::move(names)), prefix_("bandsaw-" + std::to_string(getpid()) + "-") {}

Hosts::~Hosts() {
  for (const std::string& name : names_) {
    run({kIp, "netns", "delete", space_of(name)});
  }
  run({kIp, "netns", "delete", space_of(kSwitch)});
}

absl::StatusOr<std::unique_ptr<Hosts>> Hosts::create(std::vector<std::string> names) {
  auto hosts = std::unique_ptr<Hosts>(new Hosts(std::move(names)));
  if (access(kIp.c_str(), X_OK) != 0) {
    return absl::PermissionDeniedError("needs the command ip (package iproute2)");
  }
  const Finished made = run({kIp, "netns", "add", hosts->space_of(kSwitch)});
  if (made.code != 0) {
    return absl::PermissionDeniedError("may not make network namespaces (run as root): " +
                                       made.err);
  }
  bool all = hosts->ip(kSwitch, {"link", "add", "bridge", "type", "bridge"}) &&
             hosts->ip(kSwitch, {"link", "set", "bridge", "up"});
  for (const std::string& name : hosts->names_) {
    all = all && hosts->add(name);
  }
  if (!all) {
    return absl::PermissionDeniedError("this kernel has no bridges or veth pairs");
  }
  return hosts;
}

bool Hosts::add(const std::string& name) const {
  return run({kIp, "netns", "add", space_of(name)}).code == 0 &&
         ip(kSwitch, {"link", "add", name, "type", "veth", "peer", "name", "cable", "netns",
                      space_of(name)}) &&
         ip(kSwitch, {"link", "set", name, "master", "bridge", "up"}) &&
         ip(name, {"link", "set", "lo", "up"}) &&
         ip(name, {"address", "add", address(name) + "/24", "dev", "cable"}) &&
         ip(name, {"link", "set", "cable", "up"});
}

std::string Hosts::address(const std::string& name) const {
  const auto found = std::find(names_.begin(), names_.end(), name);
  BANDSAW_CHECK(found != names_.end(), name.c_str());
  return "10.77.0." + std::to_string(found - names_.begin() + 1);
}

std::string Hosts::space_of(const std::string& name) const { return prefix_ + name; }

bool Hosts::ip(const std::string& space, std::vector<std::string> arguments) const {
  std::vector<std::string> argv = {kIp, "-netns", space_of(space)};
  argv.insert(argv.end(), arguments.begin(), arguments.end());
  return run(argv).code == 0;
}

std::vector<std::string> Hosts::on(const std::string& name, std::vector<std::string> argv) const {
  argv.insert(argv.begin(), {kIp, "netns", "exec", space_of(name)});
  return argv;
}

void Hosts::unplug(const std::string& name) const {
  BANDSAW_CHECK(ip(kSwitch, {"link", "set", name, "nomaster"}), name.c_str());
}

void Hosts::plug(const std::string& name) const {
  BANDSAW_CHECK(ip(kSwitch, {"link", "set", name, "master", "bridge"}), name.c_str());
}

void Hosts::deafen(const std::string& from, const std::string& to) const {
  // `from` sends its packets for `to` to a hardware address that no machine has.
  BANDSAW_CHECK(ip(from, {"neighbour", "replace", address(to), "lladdr", "02:00:00:00:00:99", "dev",
                          "cable", "nud", "permanent"}),
                from.c_str());
}

bool Hosts::shape(const std::string& name, const std::vector<std::string>& discipline) const {
  std::vector<std::string> argv = {"/usr/sbin/tc", "qdisc", "replace", "dev", "cable", "root"};
  argv.insert(argv.end(), discipline.begin(), discipline.end());
  return run(on(name, argv)).code == 0;
}

}  // namespace bandsaw::test
