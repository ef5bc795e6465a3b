// The command `bandsaw link`: shows, makes or revokes the link by which browsers join as workers.
// On a terminal it also shows the link's QR code.

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "coordinator/cli/base/json.h"
#include "coordinator/cli/base/text.h"
#include "coordinator/cli/farm/farm_client.h"
#include "coordinator/cli/farm/farm_errors.h"
#include "coordinator/cli/machines/qr_text.h"
#include "coordinator/cli/options/commands.h"
#include "coordinator/web/qr_code.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

/// Returns true if the link's address is of the loopback interface.
bool is_for_this_machine_only(const std::string& url) {
  return absl::StartsWith(url, "http://127.") || absl::StartsWith(url, "http://localhost:") ||
         absl::StartsWith(url, "http://[::1]:");
}

absl::Status show(const farm::BrowserLinkReply& link, const Console& console) {
  console.line(link.url());
  if (console.is_terminal()) {
    ASSIGN_OR_RETURN(const QrCode code, qr_code(link.url()));
    console.write(qr_text(code));
  }
  console.line(absl::StrCat(
      "for the next ", duration(link.left_s()),
      ", browsers that open this link render for this farm; bandsaw link --revoke ends the link"));
  if (is_for_this_machine_only(link.url())) {
    console.complain(
        "this link works on the coordinator's machine only; for other machines, start the "
        "coordinator with: bandsaw serve --web 0.0.0.0:8787");
  }
  return absl::OkStatus();
}

absl::Status link(const LinkOptions& options, const Console& console) {
  ASSIGN_OR_RETURN(const auto client, connect_to_farm(options.farm));
  ASSIGN_OR_RETURN(const farm::BrowserLinkReply link,
                   client->browser_link(options.seconds.value_or(0), options.revoke));
  if (options.verbosity.json) {
    console.line(options.revoke ? JsonObject().text("event", "revoked").str()
                                : JsonObject()
                                      .text("event", "link")
                                      .text("url", link.url())
                                      .number("left_s", link.left_s())
                                      .str());
    return absl::OkStatus();
  }
  if (options.revoke) {
    console.line("the link is void; browsers that joined by it are disconnected");
    return absl::OkStatus();
  }
  return show(link, console);
}

}  // namespace

ExitCode run(const LinkOptions& options, Process& process) {
  return finished(link(options, process.console), process.console);
}

}  // namespace bandsaw::coordinator
