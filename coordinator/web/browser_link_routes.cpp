// The handlers of /api/link show, make and revoke the link by which browsers join as workers. The
// handler of /api/link.svg shows the link as a QR code.

#include "coordinator/web/qr_code.h"
#include "coordinator/web/reply.h"
#include "coordinator/web/routes.h"
#include "proto/web.pb.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

/// Returns the message that describes the link. If there is no link, none of its fields is set.
web::BrowserLink link_message(const std::optional<BrowserAccess::Link>& link) {
  web::BrowserLink message;
  if (link) {
    message.set_url(link->url);
    message.set_left_s(link->left_s);
  }
  return message;
}

/// Makes a link that is valid for the time in `body`, a MakeBrowserLink in JSON, or for the
/// standard time if that time is 0. Returns the message that describes the link.
absl::StatusOr<web::BrowserLink> make_link(BrowserAccess& access, const HttpBody& body) {
  web::MakeBrowserLink wanted;
  RETURN_IF_ERROR(read_json(body, wanted));
  ASSIGN_OR_RETURN(
      const BrowserAccess::Link link,
      access.make(wanted.seconds() == 0 ? BrowserAccess::kStandardSeconds : wanted.seconds()));
  return link_message(link);
}

}  // namespace

void add_browser_link(Router& router, BrowserAccess& access) {
  router.get("/api/link",
             [&](const HttpRequest&) { return reply(link_message(access.present())); });
  router.get("/api/link.svg", [&](const HttpRequest&) {
    const std::optional<BrowserAccess::Link> link = access.present();
    const absl::StatusOr<QrCode> code =
        link ? qr_code(link->url)
             : absl::StatusOr<QrCode>(absl::NotFoundError("there is no link for browsers now"));
    return code.ok() ? text_reply(qr_svg(*code), "image/svg+xml") : refuse(code.status());
  });
  router.post("/api/link", [&](const HttpRequest&, const HttpBody& body) {
    return answer(make_link(access, body));
  });
  router.post("/api/link/revoke", [&](const HttpRequest&, const HttpBody&) {
    const absl::Status status = access.revoke();
    return status.ok() ? reply(link_message(access.present())) : refuse(status);
  });
}

}  // namespace bandsaw::coordinator
