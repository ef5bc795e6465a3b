#include "coordinator/cli/serve_dashboard.h"

#include <spdlog/spdlog.h>

#include <cstdlib>
#include <filesystem>
#include <span>

#include "absl/strings/str_cat.h"
#include "coordinator/cli/bring_scene.h"
#include "coordinator/cli/data_folder.h"
#include "coordinator/cli/join_addresses.h"
#include "renderlib/base/atomic_file.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

/// Installed, and in a build folder: bin beside share.
std::string gallery_folder() {
  std::error_code error;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
  return (program.parent_path().parent_path() / "share/bandsaw/gallery").string();
}

absl::StatusOr<std::unique_ptr<Dashboard>> start(const ServeOptions& options, Engine& engine,
                                                 const link::Identity& identity) {
  DashboardOptions wanted;
  wanted.insecure = options.insecure;
  wanted.gallery = gallery_folder();
  wanted.bring = bring_scene(engine);
  if (options.web.empty()) {
    auto dashboard = Dashboard::start(engine, identity, wanted);
    if (dashboard.ok()) {
      return dashboard;
    }
    wanted.port = 0;
    dashboard = Dashboard::start(engine, identity, wanted);
    if (!dashboard.ok()) {  // nobody asked for it: a farm does without
      spdlog::warn("there is no dashboard: {}", std::string(dashboard.status().message()));
      return nullptr;
    }
    return dashboard;
  }
  const std::size_t colon = options.web.rfind(':');
  wanted.host = options.web.substr(0, colon);
  wanted.port = std::atoi(options.web.c_str() + colon + 1);
  if (wanted.host.front() == '[' && wanted.host.back() == ']') {
    wanted.host = wanted.host.substr(1, wanted.host.size() - 2);
  }
  auto dashboard = Dashboard::start(engine, identity, wanted);
  if (!dashboard.ok()) {
    return absl::FailedPreconditionError(
        absl::StrCat("--web: ", dashboard.status().message(),
                     "; its port is taken, or the address is none of this machine"));
  }
  return dashboard;
}

}  // namespace

absl::Status ServedDashboard::write_link(const std::string& data_folder,
                                         const link::Identity& identity) const {
  const std::string file = dashboard_file(data_folder);
  if (dashboard == nullptr) {
    std::error_code error;
    std::filesystem::remove(file, error);
    return error ? errno_status(error.value(), file) : absl::OkStatus();
  }
  // Behind the #: browsers keep that to themselves.
  const std::string link = absl::StrCat(url, "/#key=", identity.farm_secret, "\n");
  return write_file_atomically(file, std::as_bytes(std::span(link)));
}

absl::StatusOr<ServedDashboard> serve_dashboard(const ServeOptions& options, Engine& engine,
                                                const link::Identity& identity) {
  ServedDashboard served;
  if (options.web != "none") {
    ASSIGN_OR_RETURN(served.dashboard, start(options, engine, identity));
  }
  if (served.dashboard != nullptr) {
    const std::string host =
        options.web.empty() ? "127.0.0.1" : options.web.substr(0, options.web.rfind(':'));
    ASSIGN_OR_RETURN(const std::vector<LocalAddress> local, local_addresses());
    const auto addresses = join_addresses(host, served.dashboard->port(), local);
    served.url =
        absl::StrCat(served.dashboard->secure() ? "https://" : "http://", addresses.front());
  }
  return served;
}

}  // namespace bandsaw::coordinator
