// The handlers of the requests of browsers that render (/join/…). The handlers send the renderer
// and the blobs (byte arrays) of scenes. They receive bands: ranges of rows of an image, which were
// leased to a browser (given to it for a limited time). Only the request for the renderer needs no
// secret. All others need the secret of the link by which browsers join.

#include <algorithm>
#include <atomic>
#include <cstring>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "coordinator/engine/blocking_call.h"
#include "coordinator/rpc/band_intake.h"
#include "coordinator/web/access.h"
#include "coordinator/web/reply.h"
#include "coordinator/web/routes.h"
#include "proto/web.pb.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

/// Maximum number of blobs and bands in transfer at a time. The HTTP server has more threads, so
/// some of them remain for the dashboard even if the browsers are slow.
constexpr int kMaxTransfers = 20;
/// The body of a band begins with the length of its BandHeader: a little-endian number of
/// kLengthBytes bytes, at most kMaxHeaderBytes.
constexpr std::size_t kLengthBytes = 4;
constexpr std::uint32_t kMaxHeaderBytes = 64 << 10;

absl::Status check_link(BrowserAccess& access, const HttpRequest& request) {
  return access.check(bearer_secret(request), request.remote_address);
}

/// Returns an object that counts as one transfer until it is destroyed; nullptr: too many transfers
/// are in progress.
std::shared_ptr<const void> begin_transfer(const std::shared_ptr<std::atomic<int>>& transfers) {
  if (transfers->fetch_add(1) >= kMaxTransfers) {
    transfers->fetch_sub(1);
    return nullptr;
  }
  return {transfers.get(), [transfers](const void*) { transfers->fetch_sub(1); }};
}

HttpReply too_many_transfers() {
  HttpReply reply = refuse(absl::UnavailableError(
      absl::StrCat(kMaxTransfers, " transfers of browsers are in progress; try again")));
  reply.headers.emplace_back("Retry-After", "1");
  return reply;
}

/// Reads a band from the body: the length of its header, the header, the pixels. PERMISSION_DENIED:
/// the band was not leased to this browser. INVALID_ARGUMENT: the band is malformed or cut off.
/// RESOURCE_EXHAUSTED: `memory`, the budget for bands, has no space for the band.
absl::StatusOr<BandIntake> read_band(const HttpBody& body, BrowserLeases& leases,
                                     MemoryBudget& memory) {
  BandIntake intake(memory);
  std::string head;
  while (true) {
    ASSIGN_OR_RETURN(const absl::string_view bytes, body());
    if (bytes.empty()) {
      break;
    }
    if (intake.begun()) {
      RETURN_IF_ERROR(intake.append(bytes));
      continue;
    }
    head.append(bytes.data(), bytes.size());
    if (head.size() < kLengthBytes) {
      continue;
    }
    std::uint32_t length = 0;
    std::memcpy(&length, head.data(), kLengthBytes);  // all machines are little-endian
    if (length > kMaxHeaderBytes) {
      return absl::InvalidArgumentError(
          absl::StrCat("the band's header has at most ", kMaxHeaderBytes, " bytes, not ", length));
    }
    if (head.size() < kLengthBytes + length) {
      continue;
    }
    farm::BandHeader header;
    if (!header.ParseFromArray(head.data() + kLengthBytes, static_cast<int>(length))) {
      return absl::InvalidArgumentError("the band's header is no serialised BandHeader");
    }
    RETURN_IF_ERROR(leases.check(header));
    RETURN_IF_ERROR(intake.begin(header));
    RETURN_IF_ERROR(intake.append(absl::string_view(head).substr(kLengthBytes + length)));
  }
  if (!intake.whole()) {
    return absl::InvalidArgumentError(
        absl::StrCat("the band is cut off: ", intake.received(), " bytes of its pixels came"));
  }
  return intake;
}

/// Reads a band from the body and gives it to the engine. Returns what the engine did with it.
absl::StatusOr<farm::PutBandReply> take_band(Engine& engine, BrowserLeases& leases,
                                             const HttpBody& body) {
  ASSIGN_OR_RETURN(BandIntake intake, read_band(body, leases, engine.bands()));
  using Outcome = absl::StatusOr<BandOutcome>;
  ASSIGN_OR_RETURN(const BandOutcome outcome, blocking_call<Outcome>([&](auto answer) {
                     intake.put(engine, answer, /*browser=*/true);
                   }));
  farm::PutBandReply reply;
  reply.set_outcome(to_message(outcome));
  return reply;
}

/// Returns the blob that the path names by its digest. `transfer`: the object of begin_transfer(),
/// which is kept until the response is sent.
HttpReply blob_reply(BrowserLeases& leases, const HttpRequest& request,
                     std::shared_ptr<const void> transfer) {
  const absl::StatusOr<wire::Digest> digest = wire::digest_from_hex(request.captured);
  if (!digest.ok()) {
    return refuse(absl::NotFoundError("a blob is named by 64 hexadecimal digits"));
  }
  absl::StatusOr<std::unique_ptr<BlobBytes>> blob = leases.blob(*digest);
  if (!blob.ok()) {
    return refuse(blob.status());
  }
  struct Held {
    std::unique_ptr<BlobBytes> blob;
    std::shared_ptr<const void> transfer;
  };
  const auto held = std::make_shared<Held>(Held{*std::move(blob), std::move(transfer)});
  const auto bytes = held->blob->bytes();
  // The blob's name is its digest, so its bytes never change.
  return {.type = "application/octet-stream",
          .headers = {{"Cache-Control", "private, max-age=31536000, immutable"}},
          .bytes = {reinterpret_cast<const char*>(bytes.data()), bytes.size()},
          .held = held};
}

bool accepts_brotli(const HttpRequest& request) {
  for (const absl::string_view one : absl::StrSplit(request.header("Accept-Encoding"), ',')) {
    if (absl::StripAsciiWhitespace(one) == "br") {
      return true;
    }
  }
  return false;
}

/// Returns the renderer, compressed if the browser accepts it. If the browser has stored this
/// version already, returns a response 304 without the renderer.
HttpReply program_reply(const BrowserProgram& program, const HttpRequest& request) {
  if (program.bytes.empty()) {
    return refuse(absl::NotFoundError(
        "the renderer for browsers is not installed on the host: install share/bandsaw/browser "
        "beside Bandsaw's programs, and start the coordinator again"));
  }
  const bool compressed = !program.compressed.empty() && accepts_brotli(request);
  const std::string tag = absl::StrCat("\"", program.tag, compressed ? "-br" : "", "\"");
  HttpReply reply{.type = "application/wasm",
                  .headers = {{"ETag", tag},
                              {"Cache-Control", "no-cache"},  // stored, but revalidated each time
                              {"Vary", "Accept-Encoding"}}};
  if (request.header("If-None-Match") == tag) {
    reply.status = 304;
    reply.type.clear();
    return reply;
  }
  reply.bytes = compressed ? program.compressed : program.bytes;
  if (compressed) {
    reply.headers.emplace_back("Content-Encoding", "br");
  }
  return reply;
}

}  // namespace

void add_join(Router& router, Engine& engine, BrowserAccess& access, BrowserLeases& leases,
              BrowserSockets& sockets, const BrowserProgram& program) {
  const auto transfers = std::make_shared<std::atomic<int>>(0);
  router.get("/join/bandsaw.wasm",
             [&](const HttpRequest& request) { return program_reply(program, request); });
  router.get("/join/about", [&](const HttpRequest& request) {
    if (const absl::Status status = check_link(access, request); !status.ok()) {
      return refuse(status);
    }
    web::JoinAbout about;
    const std::optional<BrowserAccess::Link> link = access.present();
    about.set_left_s(link ? link->left_s : 0);
    about.set_renderer(!program.bytes.empty());
    return reply(about);
  });
  router.get("/join/session", [&](const HttpRequest& request) { return sockets.answer(request); });
  router.get("/join/blob/*", [&, transfers](const HttpRequest& request) {
    if (const absl::Status status = check_link(access, request); !status.ok()) {
      return refuse(status);
    }
    const auto transfer = begin_transfer(transfers);
    return transfer == nullptr ? too_many_transfers() : blob_reply(leases, request, transfer);
  });
  router.post("/join/band", [&, transfers](const HttpRequest& request, const HttpBody& body) {
    if (const absl::Status status = check_link(access, request); !status.ok()) {
      return refuse(status);
    }
    const auto transfer = begin_transfer(transfers);
    if (transfer == nullptr) {
      return too_many_transfers();
    }
    const auto put = take_band(engine, leases, body);
    return put.ok() ? text_reply(put->SerializeAsString(), "application/octet-stream")
                    : refuse(put.status());
  });
}

}  // namespace bandsaw::coordinator
