// Starts the dashboard and gives it the parts that the folder coordinator/web does not contain: the
// function that imports a scene into the engine's store, the function that writes reports, and the
// programs of workers and of browsers.

#include "coordinator/cli/serve/serve_dashboard.h"

#include <spdlog/spdlog.h>

#include <cstdlib>
#include <filesystem>
#include <span>

#include "absl/strings/str_cat.h"
#include "coordinator/cli/base/data_folder.h"
#include "coordinator/cli/base/program_folder.h"
#include "coordinator/cli/image/report.h"
#include "coordinator/cli/machines/worker_file.h"
#include "coordinator/cli/scene/import_process.h"
#include "coordinator/cli/serve/join_addresses.h"
#include "coordinator/engine/engine.h"
#include "coordinator/web/scenes.h"
#include "proto/link/certificate.h"
#include "proto/wire/digest.h"
#include "renderlib/base/atomic_file.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

/// Time limit of the import of a small scene. It is shorter than for a command, because a user
/// waits in a browser.
constexpr double kImportTimeout_s = 120;
constexpr std::size_t kPieceBytes = 16 << 20;  ///< a blob is written in pieces of this size

/// Writes a blob (a part of a scene, named by its digest) to the store, unless it is there already.
absl::Status store(Engine& engine, const wire::Digest& digest, absl::Span<const std::byte> bytes) {
  if (engine.has_blob(digest)) {
    return absl::OkStatus();
  }
  ASSIGN_OR_RETURN(const auto writer, engine.write_blob(digest, bytes.size()));
  for (std::size_t at = 0; at < bytes.size(); at += kPieceBytes) {
    RETURN_IF_ERROR(writer->append(bytes.subspan(at, kPieceBytes)));
  }
  return writer->commit();
}

/// Returns the import function for the dashboard. `engine` MUST outlive it.
ImportScene import_and_store(Engine& engine) {
  return [&engine](const std::string& path, const std::string& inside,
                   const std::atomic<bool>& stop) -> absl::StatusOr<SceneOnFarm> {
    ImportLimits limits;
    limits.seconds = import_timeout_s(path, kImportTimeout_s);
    limits.stop = &stop;
    ASSIGN_OR_RETURN(ImportedPackage package, import_in_process(path, limits, {.inside = inside}));
    ASSIGN_OR_RETURN(const std::vector<BlobRef> blobs, package_blobs(package.manifest()));
    for (const BlobRef& blob : blobs) {
      ASSIGN_OR_RETURN(const std::unique_ptr<BlobBytes> bytes, package.blobs().get(blob.digest));
      RETURN_IF_ERROR(store(engine, blob.digest, bytes->bytes()));
    }
    const std::string& manifest = package.manifest();
    const wire::Digest digest = wire::sha256(manifest);
    RETURN_IF_ERROR(store(engine, digest, std::as_bytes(std::span(manifest))));
    return SceneOnFarm{digest.hex(), package.info()};
  };
}

/// Returns the host of HOST:PORT, IPv6 without brackets.
std::string host_of(const std::string& address) {
  const std::string host = address.substr(0, address.rfind(':'));
  return host.front() == '[' && host.back() == ']' ? host.substr(1, host.size() - 2) : host;
}

/// Reads the workers' programs in this program's folder. Warns of a file that cannot be handed out.
/// No warning is given for a missing file: few farms have machines of every architecture, and a
/// machine that requests the missing program is told where to install it.
WorkerPrograms load_workers() {
  WorkerPrograms workers;
  for (const Machine machine : kMachines) {
    auto worker = load_worker_program(machine);
    if (worker.ok()) {
      workers.push_back(*std::move(worker));
    } else {
      spdlog::log(absl::IsNotFound(worker.status()) ? spdlog::level::debug : spdlog::level::warn,
                  "no worker for {} is handed out: {}", std::string(machine_name(machine)),
                  std::string(worker.status().message()));
    }
  }
  return workers;
}

/// Reads the renderer for browsers. Without it, the page for browsers says how to install it.
BrowserProgram load_browsers() {
  auto program = load_browser_program(browser_folder());
  if (!program.ok()) {
    spdlog::log(absl::IsNotFound(program.status()) ? spdlog::level::debug : spdlog::level::warn,
                "no renderer for browsers is handed out: {}",
                std::string(program.status().message()));
    return {};
  }
  return *std::move(program);
}

/// Starts the dashboard. If the user gave no address, tries the default port, then any free port,
/// and returns nullptr if none can be used.
absl::StatusOr<std::unique_ptr<Dashboard>> start(const ServeOptions& options, Engine& engine,
                                                 const link::Identity& identity,
                                                 const WorkerPrograms& workers,
                                                 BrowserAccess& browsers) {
  DashboardOptions wanted;
  wanted.workers = workers;
  wanted.insecure = options.insecure;
  wanted.browsers = &browsers;
  wanted.browser_program = load_browsers();
  wanted.gallery = gallery_folder();
  wanted.import_scene = import_and_store(engine);
  wanted.report = [](const JobView& job, const Image& image) {
    const Progress progress{job, bad_sample_text(job.counters)};
    return report_text({progress, pixels_sha256(image), /*outputs=*/{}});
  };
  if (options.web.empty()) {
    auto dashboard = Dashboard::start(engine, identity, wanted);
    if (dashboard.ok()) {
      return dashboard;
    }
    wanted.port = 0;
    dashboard = Dashboard::start(engine, identity, wanted);
    if (!dashboard.ok()) {  // it was not requested, so the farm runs without it
      spdlog::warn("there is no dashboard: {}", std::string(dashboard.status().message()));
      return nullptr;
    }
    return dashboard;
  }
  wanted.host = host_of(options.web);
  wanted.port = std::atoi(options.web.c_str() + options.web.rfind(':') + 1);
  auto dashboard = Dashboard::start(engine, identity, wanted);
  if (!dashboard.ok()) {
    return absl::FailedPreconditionError(
        absl::StrCat("--web: ", dashboard.status().message(),
                     "; its port is taken, or this machine does not have the address"));
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
  // The secret follows the #, because browsers do not send that part of a URL.
  const std::string link = absl::StrCat(url, "/#key=", identity.farm_secret, "\n");
  const absl::StatusOr<std::string> there = read_whole_file(file, 2 * link.size());
  if (there.ok() && *there == link) {
    return absl::OkStatus();
  }
  return write_file_atomically(file, std::as_bytes(std::span(link)));
}

std::string ServedDashboard::place(const ServeOptions& options) const {
  if (dashboard == nullptr) {
    return "";
  }
  const std::string host =
      options.web.empty() ? "127.0.0.1" : options.web.substr(0, options.web.rfind(':'));
  const bool everywhere = host == "0.0.0.0" || host == "[::]";
  return absl::StrCat(everywhere ? "" : host + ":", dashboard->port());
}

absl::StatusOr<std::string> ServedDashboard::worker_line(const ServeOptions& options,
                                                         const link::Identity& identity,
                                                         const std::string& join) const {
  if (dashboard == nullptr || workers.empty()) {
    return "";
  }
  const bool here_only = options.web.empty() || is_loopback(host_of(options.web));
  if (here_only && !is_loopback(host_of(options.listen))) {
    return "";
  }
  std::optional<wire::Digest> key;
  if (dashboard->secure()) {
    ASSIGN_OR_RETURN(key, link::public_key_digest(identity.certificate_pem));
  }
  return coordinator::worker_line(url, key, workers, join);
}

absl::StatusOr<ServedDashboard> serve_dashboard(const ServeOptions& options, Engine& engine,
                                                const link::Identity& identity,
                                                BrowserAccess& browsers) {
  ServedDashboard served;
  if (options.web == "none") {
    return served;
  }
  const WorkerPrograms workers = load_workers();
  for (const WorkerProgram& worker : workers) {
    served.workers.emplace(worker.machine, worker.digest);
  }
  ASSIGN_OR_RETURN(served.dashboard, start(options, engine, identity, workers, browsers));
  if (served.dashboard != nullptr) {
    const std::string host =
        options.web.empty() ? "127.0.0.1" : options.web.substr(0, options.web.rfind(':'));
    ASSIGN_OR_RETURN(const std::vector<LocalAddress> local, local_addresses());
    const auto addresses = join_addresses(host, served.dashboard->port(), local);
    served.url =
        absl::StrCat(served.dashboard->secure() ? "https://" : "http://", addresses.front());
    browsers.set_address(served.url);
  }
  return served;
}

}  // namespace bandsaw::coordinator
