// The command `bandsaw serve`: runs the coordinator with its gRPC server and its dashboard until a
// signal comes.

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "absl/strings/str_cat.h"
#include "coordinator/cli/base/data_folder.h"
#include "coordinator/cli/options/commands.h"
#include "coordinator/cli/serve/join_addresses.h"
#include "coordinator/cli/serve/join_files.h"
#include "coordinator/cli/serve/serve_dashboard.h"
#include "coordinator/engine/engine.h"
#include "coordinator/rpc/browser_access.h"
#include "coordinator/rpc/server.h"
#include "proto/link/identity.h"
#include "renderlib/base/atomic_file.h"
#include "renderlib/base/mutex.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

/// The join strings of this run. start() holds the mutex until it has written the strings to their
/// files, so that a renewal of a secret waits until then. If a role has no string after that,
/// start() has failed.
struct JoinStrings {
  Mutex mutex;
  /// These strings keep the secrets that were valid at the start. A renewal of a secret does not
  /// change these strings.
  std::map<link::Role, link::JoinString> by_role GUARDED_BY(mutex);
};

/// All that runs, and what is printed about it.
struct Serving {
  std::unique_ptr<Engine> engine;
  // The link by which browsers join the farm. Destroyed after the dashboard and the server, which
  // use it.
  std::unique_ptr<BrowserAccess> browsers;
  std::unique_ptr<ServedDashboard> web;  // destroyed before the engine
  // Destroyed after the server, which uses it.
  std::unique_ptr<JoinStrings> joins = std::make_unique<JoinStrings>();
  std::unique_ptr<Server> server;  // destroyed before `web`, which it notifies
  std::string folder;              // the data folder
  std::string join;                // workers' join string
  std::string line;                // shell line that fetches and starts a worker; may be empty
  std::string address;             // host:port
};

absl::Status make_folder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  return error ? errno_status(error.value(), absl::StrCat("the data folder ", folder))
               : absl::OkStatus();
}

/// Revokes the link for browsers, and renews the role's secret everywhere: in the identity, in the
/// file with the join string, in the dashboard's logins and in the link to the dashboard. The
/// server calls it for `bandsaw secret rotate`. UNAVAILABLE: the coordinator could not start.
absl::StatusOr<RenewedSecret> renew_everywhere(const std::string& folder, link::Role role,
                                               JoinStrings& joins, const ServedDashboard& web,
                                               BrowserAccess& browsers) {
  MutexLock lock(joins.mutex);
  const auto present = joins.by_role.find(role);
  if (present == joins.by_role.end()) {
    return absl::UnavailableError("the coordinator could not start and is being stopped");
  }
  // The link must be revoked too. A user who has the old secret may have read the link. And when
  // the workers' secret is renewed, machines that do not get the new secret must be excluded.
  RETURN_IF_ERROR(browsers.revoke());
  ASSIGN_OR_RETURN(RenewedSecret renewed, rotate_secret(folder, role, present->second));
  if (web.dashboard != nullptr) {
    web.dashboard->renew(renewed.identity);
  }
  renewed.written.Update(web.write_link(folder, renewed.identity));
  return renewed;
}

/// Returns `written`, the result of writing a file. If the disk is full, logs the error and returns
/// OK, because the file of an earlier start remains.
absl::Status unless_full(const absl::Status& written) {
  if (!absl::IsResourceExhausted(written)) {
    return written;
  }
  spdlog::error(
      "{}; the file is unchanged and may name another address; start again when the disk has space",
      written.ToString());
  return absl::OkStatus();
}

/// Starts the engine, the dashboard and the server, and writes the files with the join strings.
absl::StatusOr<Serving> start(const ServeOptions& options) {
  Serving serving;
  std::string folder = options.data;
  if (folder.empty()) {
    ASSIGN_OR_RETURN(folder, default_data_folder());
  }
  // Secrets, scenes and images are private: every file that is created from here on has mode 0600.
  umask(S_IRWXG | S_IRWXO);
  RETURN_IF_ERROR(make_folder(folder));
  // The engine is started first, because it locks the folder.
  EngineOptions engine_options;
  engine_options.data_folder = folder;
  engine_options.keep.seconds = options.keep_days * 24 * 60 * 60;
  engine_options.keep.jobs = options.keep_jobs;
  engine_options.keep.bytes = static_cast<std::uint64_t>(options.keep_gb * 1e9);
  engine_options.audit_share = options.audit_share;
  engine_options.browser_audit_share = options.browser_audit_share;
  engine_options.browsers = options.browsers;
  ASSIGN_OR_RETURN(serving.engine, Engine::start(engine_options));
  ASSIGN_OR_RETURN(const link::Identity identity, link::load_or_make_identity(folder));
  serving.folder = folder;
  ASSIGN_OR_RETURN(serving.browsers, BrowserAccess::load(folder));
  ASSIGN_OR_RETURN(ServedDashboard web,
                   serve_dashboard(options, *serving.engine, identity, *serving.browsers));
  serving.web = std::make_unique<ServedDashboard>(std::move(web));
  const MutexLock until_written(serving.joins->mutex);
  ASSIGN_OR_RETURN(serving.server,
                   Server::start(*serving.engine, identity,
                                 {.listen = options.listen,
                                  .insecure = options.insecure,
                                  .reflection = options.reflection,
                                  .renew =
                                      [folder, joins = serving.joins.get(), web = serving.web.get(),
                                       browsers = serving.browsers.get()](link::Role role) {
                                        return renew_everywhere(folder, role, *joins, *web,
                                                                *browsers);
                                      },
                                  .browsers = serving.browsers.get()}));
  RETURN_IF_ERROR(unless_full(serving.web->write_link(folder, identity)));
  const std::string host = options.listen.substr(0, options.listen.rfind(':'));
  ASSIGN_OR_RETURN(const std::vector<LocalAddress> local, local_addresses());
  const std::vector<std::string> addresses = join_addresses(host, serving.server->port(), local);
  // The users' file is written last: scripts wait for it, and then start a worker with the workers'
  // file.
  for (const link::Role role : {link::Role::kWorker, link::Role::kFarm}) {
    link::JoinString join = join_string(role, identity, addresses, options.insecure);
    join.web = role == link::Role::kFarm ? serving.web->place(options) : "";
    RETURN_IF_ERROR(unless_full(write_join_file(folder, join)));
    serving.joins->by_role[role] = join;
    if (role == link::Role::kWorker) {
      serving.join = join.text();
    }
  }
  ASSIGN_OR_RETURN(serving.line, serving.web->worker_line(options, identity, serving.join));
  serving.address = absl::StrCat(host, ":", serving.server->port());
  return serving;
}

/// Raises the limit of open files: each worker has two connections, and each connection is an open
/// file. The usual soft limit, 1,024, is meant for programs that use select(2).
void raise_file_limit() {
  constexpr rlim_t kEnough = 65'536;
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) == 0 && limit.rlim_cur < kEnough) {
    limit.rlim_cur = std::min(kEnough, limit.rlim_max);
    ::setrlimit(RLIMIT_NOFILE, &limit);
  }
}

}  // namespace

ExitCode run(const ServeOptions& options, Process& process) {
  raise_file_limit();
  // Standard output is for users and scripts; the log goes to standard error.
  spdlog::set_default_logger(
      std::make_shared<spdlog::logger>("", std::make_shared<spdlog::sinks::stderr_sink_mt>()));
  auto serving = start(options);
  if (!serving.ok()) {
    return process.console.fail(ExitCode::kFailed, std::string(serving.status().message()));
  }
  // Without a Listener, a signal would end the program at once. With it, wait() below returns.
  const Interrupts::Listener listener(process.interrupts, [] {});
  const std::string& url = serving->web->url;
  process.console.line(absl::StrCat("bandsaw ", BANDSAW_VERSION, " · coordinator on ",
                                    serving->address,
                                    url.empty() ? "" : absl::StrCat(" · dashboard ", url)));
  if (!url.empty()) {
    process.console.line(
        absl::StrCat("dashboard: to log in, open the link in ", dashboard_file(serving->folder)));
    process.console.line(
        "phones and other browsers join by the link that this command prints:  bandsaw link");
  }
  if (options.insecure) {
    process.console.complain(
        "warning: --insecure: nothing is encrypted, and whoever reads the network has the secrets");
  }
  process.console.line(absl::StrCat("join with:  bandsaw-worker --join ", serving->join));
  if (!serving->line.empty()) {
    process.console.line(absl::StrCat("or where there is no bandsaw-worker:  ", serving->line));
  } else if (!serving->web->workers.empty()) {
    process.console.line(
        "with --web 0.0.0.0:8787, a shell line that fetches and starts a worker is printed here");
  }
  process.interrupts.wait();
  process.console.line("stopping; jobs continue when the coordinator is started again");
  serving->server.reset();
  serving->web.reset();
  serving->engine.reset();
  return ExitCode::kDone;
}

}  // namespace bandsaw::coordinator
