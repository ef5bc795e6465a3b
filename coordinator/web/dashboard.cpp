// Collects the routes of all parts of the dashboard, and starts the HTTP server.

#include "coordinator/web/dashboard.h"

#include <optional>
#include <utility>
#include <vector>

#include "absl/strings/match.h"
#include "coordinator/web/http_server.h"
#include "coordinator/web/reply.h"
#include "coordinator/web/routes.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

std::vector<HttpField> headers_of_every_answer() {
  return {{"Content-Security-Policy",
           "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self'; "
           "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"},
          {"X-Content-Type-Options", "nosniff"},
          {"Referrer-Policy", "no-referrer"},
          {"Cache-Control", "no-store"}};
}

}  // namespace

bool is_loopback(const std::string& host) {
  return host == "localhost" || host == "::1" || absl::StartsWith(host, "127.");
}

/// Owns all parts of the dashboard. The HTTP server passes each request to access_, then to
/// router_.
class Dashboard::Impl {
 public:
  Impl(Engine& engine, const link::Identity& identity, TlsContext tls,
       const DashboardOptions& options)
      : secure_(tls != nullptr),
        access_(identity, secure_, options.host),
        pictures_(engine),
        clean_pictures_(engine),
        report_(options.report),
        scenes_(engine, options.import_scene),
        gallery_(options.gallery),
        workers_(options.workers),
        browser_program_(options.browser_program),
        browser_leases_(engine),
        server_(std::move(tls), headers_of_every_answer(),
                [this](const HttpRequest& request, const HttpBody& body) {
                  const absl::Status status = access_.check(request);
                  return status.ok() ? router_.answer(request, body) : refuse(status);
                }) {
    add_page(router_);
    add_worker_programs(router_, workers_);
    add_login(router_, access_);
    add_farm(router_, engine);
    add_jobs(router_, engine);
    add_pictures(router_, pictures_, report_);
    add_clean_pictures(router_, clean_pictures_);
    add_scenes(router_, scenes_);
    add_scene_files(router_, engine, scenes_);
    add_gallery(router_, engine, scenes_, gallery_);
    if (options.browsers != nullptr) {
      browser_sockets_.emplace(engine, *options.browsers, browser_leases_, options.browser_limits);
      add_browser_link(router_, *options.browsers);
      add_join(router_, engine, *options.browsers, browser_leases_, *browser_sockets_,
               browser_program_);
    }
  }

  ~Impl() { scenes_.stop(); }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  absl::Status start(const DashboardOptions& options) {
    ASSIGN_OR_RETURN(port_, server_.start(options.host, options.port));
    return absl::OkStatus();
  }
  void renew(const link::Identity& identity) {
    if (access_.renew(identity)) {
      server_.cut();
    }
  }
  int port() const { return port_; }
  bool secure() const { return secure_; }

 private:
  const bool secure_;
  Access access_;
  Pictures pictures_;
  CleanPictures clean_pictures_;
  const MakeReport report_;
  Scenes scenes_;
  const Gallery gallery_;
  const WorkerPrograms workers_;
  const BrowserProgram browser_program_;
  BrowserLeases browser_leases_;
  std::optional<BrowserSockets> browser_sockets_;
  Router router_;
  int port_ = 0;
  HttpServer server_;  // last, because its threads use the other members
};

Dashboard::Dashboard(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Dashboard::~Dashboard() = default;
void Dashboard::renew(const link::Identity& identity) { impl_->renew(identity); }
int Dashboard::port() const { return impl_->port(); }
bool Dashboard::secure() const { return impl_->secure(); }

absl::StatusOr<std::unique_ptr<Dashboard>> Dashboard::start(Engine& engine,
                                                            const link::Identity& identity,
                                                            const DashboardOptions& options) {
  TlsContext tls;
  if (!is_loopback(options.host) && !options.insecure) {
    ASSIGN_OR_RETURN(tls, make_tls_context(identity));
  }
  auto impl = std::make_unique<Impl>(engine, identity, std::move(tls), options);
  RETURN_IF_ERROR(impl->start(options));
  return std::unique_ptr<Dashboard>(new Dashboard(std::move(impl)));
}

}  // namespace bandsaw::coordinator
