// The checks of this machine, and the pure parts of the checks of a farm (doctor_farm.cpp).

#include "coordinator/cli/machines/doctor_checks.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_join.h"
#include "coordinator/cli/machines/worker_file.h"
#include "coordinator/cli/scene/import_process.h"
#include "coordinator/rpc/port_check.h"
#include "coordinator/store/data_folder.h"
#include "proto/wire/versions.h"
#include "renderlib/base/file.h"
#include "renderlib/render/pixel_version.h"

namespace bandsaw::coordinator {
namespace {

// Enough for some passes (ranges of samples) of a large image.
constexpr std::uint64_t kMinFreeBytes = 1ull << 30;
constexpr std::uint64_t kMinMemory = 1ull << 30;  // enough for a moderate scene and its BVHs
constexpr double kMaxClockDifference_s = 60;      // beyond it, logs cannot be compared
constexpr double kDay_s = 24 * 60 * 60;

Check problem(std::string name, std::string found) {
  return {.name = std::move(name), .ok = false, .found = std::move(found)};
}

/// Returns the text for a number of bytes.
std::string size(std::uint64_t bytes) {
  return absl::StrFormat("%.1f GB", static_cast<double>(bytes) / 1e9);
}

/// Returns the folder itself, or its nearest existing parent.
std::string existing_part(std::string folder) {
  while (!file_exists(folder) && folder.size() > 1) {
    const std::size_t slash = folder.rfind('/');
    folder = slash == std::string::npos ? "." : slash == 0 ? "/" : folder.substr(0, slash);
  }
  return folder;
}

/// Returns true if the host of `address` (HOST:PORT) is this machine. This is tested by listening
/// on any free port of that host. Returns false if `address` is empty.
bool is_here(const std::string& address) {
  return !address.empty() && check_can_listen(address.substr(0, address.rfind(':')) + ":0").ok();
}

}  // namespace

Check disk_space_check(const std::string& name, const std::string& where,
                       std::uint64_t free_bytes) {
  if (free_bytes < kMinFreeBytes) {
    return problem(name, absl::StrCat(where, ": only ", size(free_bytes),
                                      " free; make room, or jobs "
                                      "will pause when the disk is full"));
  }
  return {.name = name, .ok = true, .found = absl::StrCat(where, ": ", size(free_bytes), " free")};
}

Check check_data_folder(const std::string& folder) {
  const std::string name = "data folder";
  const std::string there = existing_part(folder);
  if (access(there.c_str(), W_OK | X_OK) != 0) {
    return problem(name, absl::StrCat(there, ": ", std::strerror(errno),
                                      "; give this account the right to write there, or name "
                                      "another folder with --data"));
  }
  const absl::StatusOr<std::uint64_t> free = free_bytes(there);
  if (!free.ok()) {
    return problem(name, std::string(free.status().message()));
  }
  return disk_space_check(name, there == folder ? folder : folder + " (does not exist yet)", *free);
}

Check check_memory() {
  std::ifstream file("/proc/meminfo");
  std::string word;
  std::uint64_t kilobytes = 0;
  while (file >> word) {
    if (word == "MemAvailable:" && file >> kilobytes) {
      const std::uint64_t bytes = kilobytes * 1024;
      return bytes >= kMinMemory
                 ? Check{"memory", true, absl::StrCat(size(bytes), " available")}
                 : problem("memory", absl::StrCat("only ", size(bytes),
                                                  " available; end other programs, or render small "
                                                  "scenes only"));
    }
  }
  return problem("memory", "/proc/meminfo does not list the available memory; is /proc mounted?");
}

Check check_import_program() {
  const absl::StatusOr<std::string> program = import_program();
  return program.ok() ? Check{"import", true, *program}
                      : problem("import", std::string(program.status().message()));
}

Check check_worker_programs() {
  std::vector<std::string> found;
  for (const Machine machine : kMachines) {
    const absl::StatusOr<WorkerProgram> program = load_worker_program(machine);
    if (program.ok()) {
      found.push_back(absl::StrCat(machine_name(machine), " (", program->version, ")"));
    } else if (!absl::IsNotFound(program.status())) {
      return problem("workers", std::string(program.status().message()));
    }
  }
  return {"workers", true,
          found.empty()
              ? "no worker program to hand out"
              : absl::StrCat("a worker program to hand out for ", absl::StrJoin(found, ", "))};
}

Check check_port(const std::string& listen, const std::string& answered,
                 const std::vector<std::string>& own) {
  const absl::Status free = check_can_listen(listen);
  if (free.ok()) {
    return {"port", true, absl::StrCat(listen, " is free for a coordinator")};
  }
  const std::size_t colon = listen.rfind(':');
  const std::string host = listen.substr(0, colon);
  // The farm has the port if it answers on this machine at this port, and if `listen` is one of its
  // addresses or stands for all addresses of the machine.
  const bool everywhere = host == "0.0.0.0" || host == "[::]";
  const bool ours = is_here(answered) &&
                    answered.substr(answered.rfind(':')) == listen.substr(colon) &&
                    (everywhere || std::find(own.begin(), own.end(), listen) != own.end());
  return ours ? Check{"port", true, absl::StrCat(listen, " is in use by this farm")}
              : problem("port", std::string(free.message()));
}

Check certificate_check(double from, double until, double now) {
  if (now < from || now > until) {
    return problem(
        "certificate",
        absl::StrCat(
            now < from ? "not valid yet" : "not valid any more",
            ": check this machine's clock; if it is right, move the file `identity` "
            "out of the coordinator's data folder, restart the coordinator, and join again"));
  }
  return {"certificate", true,
          absl::StrFormat("the one that the join string names; valid for %.0f more days",
                          (until - now) / kDay_s)};
}

Check clock_check(double ours_before, double theirs, double ours_after) {
  const double difference = theirs - (ours_before + ours_after) / 2;
  if (std::abs(difference) > kMaxClockDifference_s) {
    return problem("clock", absl::StrFormat("the coordinator's is %+.0f s from this machine's; set "
                                            "both by a time server: timedatectl set-ntp true",
                                            difference));
  }
  return {"clock", true, absl::StrFormat("%+.2f s from the coordinator's", difference)};
}

Check versions_check(const farm::AboutReply& about) {
  const std::string found =
      absl::StrCat("coordinator ", about.version(), ", protocol ", about.protocol(),
                   ", pixel version ", about.pixel_version());
  if (about.protocol() != wire::kProtocol || about.pixel_version() != kPixelVersion) {
    return problem("versions",
                   absl::StrCat(found, "; here protocol ", wire::kProtocol, ", pixel version ",
                                kPixelVersion, ": install the same version on all machines"));
  }
  return {"versions", true, found + ", as here"};
}

}  // namespace bandsaw::coordinator
