// Each function converts its arguments, calls a BrowserSession or BrowserRenderer, and keeps the
// answer, as JSON, text or bytes, until the object's next call.

#include "worker/browser/exports.h"

#include <memory>
#include <new>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "proto/convert/render_values.h"
#include "proto/wire/limits.h"
#include "renderlib/base/clean_text.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/render/canary.h"
#include "renderlib/render/pixel_version.h"
#include "worker/browser/answerer.h"
#include "worker/browser/browser_renderer.h"
#include "worker/browser/browser_session.h"
#include "worker/browser/json_text.h"
#include "worker/session/lease_task.h"

#ifdef __wasm__
/// Defined by the page's JavaScript. Called after each step of the renderer's preparation before
/// the first row. Such a step counts as progress of the band.
extern "C" __attribute__((import_module("page"), import_name("step"))) void page_step();
#else
static void page_step() {}
#endif

namespace {

using bandsaw::worker::Answerer;
using bandsaw::worker::BrowserBand;
using bandsaw::worker::BrowserOrders;
using bandsaw::worker::BrowserRenderer;
using bandsaw::worker::BrowserSession;
using bandsaw::worker::json_text;

std::string text_of(const void* data, std::size_t size) {
  return std::string(static_cast<const char*>(data), size);
}

const char* boolean(bool value) { return value ? "true" : "false"; }

/// Converts a number of JavaScript: negative numbers and NaN become 0, numbers above 2^63 become
/// 2^63.
std::uint64_t whole(double number) {
  if (!(number > 0)) {
    return 0;
  }
  return number < 0x1p63 ? static_cast<std::uint64_t>(number) : std::uint64_t{1} << 63;
}

/// Returns the lines of the text that are not empty.
std::vector<std::string> lines_of(const char* text, std::size_t size) {
  return absl::StrSplit(absl::string_view(text, size), '\n', absl::SkipWhitespace());
}

std::string base64(const std::string& bytes) { return json_text(absl::Base64Escape(bytes)); }

std::string json_of(const std::optional<BrowserBand>& band) {
  if (!band) {
    return "null";
  }
  const bandsaw::worker::Task& task = band->task;
  return absl::StrCat("{\"task\":", task.id, ",\"job\":", task.job, ",\"manifest\":\"",
                      task.manifest.hex(), "\",\"width\":", task.settings.width,
                      ",\"height\":", task.settings.height, ",\"first\":", task.band.rows.first,
                      ",\"last\":", task.band.rows.last,
                      ",\"samples\":", task.tiles.count(task.settings.width, task.band),
                      ",\"lease\":", base64(band->lease), "}");
}

std::string json_of(const std::optional<bandsaw::worker::Dismissal>& dismissal) {
  if (!dismissal) {
    return "null";
  }
  const std::string reason = bandsaw::clean_text(dismissal->reason, bandsaw::wire::kReasonBytes);
  return absl::StrCat("{\"reason\":", json_text(reason), ",\"wait_ms\":", dismissal->wait.count(),
                      ",\"for_ever\":", boolean(dismissal->for_ever), "}");
}

std::string json_of(const BrowserOrders& orders) {
  const auto message = [](std::string* out, const std::string& bytes) {
    out->append(base64(bytes));
  };
  return absl::StrCat("{\"stop\":[", absl::StrJoin(orders.stop, ","),
                      "],\"start\":", json_of(orders.start), ",\"send\":[",
                      absl::StrJoin(orders.send, ",", message),
                      "],\"dismissal\":", json_of(orders.dismissal), "}");
}

std::string json_of(const std::vector<bandsaw::BlobRef>& blobs) {
  return absl::StrCat("[",
                      absl::StrJoin(blobs, ",",
                                    [](std::string* out, const bandsaw::BlobRef& blob) {
                                      absl::StrAppend(out, "{\"digest\":\"", blob.digest.hex(),
                                                      "\",\"size\":", blob.size, "}");
                                    }),
                      "]");
}

absl::StatusOr<bandsaw::wire::Digest> digest_of(const char* hex, std::size_t size) {
  return bandsaw::wire::digest_from_hex(std::string(hex, size));
}

}  // namespace

struct BandsawSession {
  Answerer answer;
  absl::StatusOr<BrowserSession> session;
};

struct BandsawRenderer {
  Answerer answer;
  BrowserRenderer renderer;
  /// The task, the pixels and the picture of the rows that were rendered last.
  bandsaw::worker::Task task;
  bandsaw::BandPixels pixels;
  std::vector<std::uint8_t> picture;
};

namespace {

/// Calls `body` with the session, and returns the answer of `body`. If the session could not be
/// made, returns an answer with the reason instead.
template <class Body>
const BandsawAnswer* with(BandsawSession* session, Body body) {
  return session->session.ok() ? body(*session->session)
                               : session->answer.error(session->session.status());
}

}  // namespace

void* bandsaw_allocate(std::size_t size) { return ::operator new(size); }
void bandsaw_free(void* memory) { ::operator delete(memory); }

BandsawSession* bandsaw_session_new(const char* instance, std::size_t instance_size,
                                    const char* name, std::size_t name_size, const char* build,
                                    std::size_t build_size, std::uint32_t threads,
                                    double memory_bytes) {
  auto session = BrowserSession::create({.instance = text_of(instance, instance_size),
                                         .name = text_of(name, name_size),
                                         .build = text_of(build, build_size),
                                         .threads = threads,
                                         .pixel_version = bandsaw::kPixelVersion,
                                         .canary = bandsaw::canary(),
                                         .memory_bytes = whole(memory_bytes)});
  auto made = std::make_unique<BandsawSession>(BandsawSession{{}, std::move(session)});
  made->answer.status(made->session.status());
  return made.release();
}

void bandsaw_session_delete(BandsawSession* session) { delete session; }

const BandsawAnswer* bandsaw_session_answer(BandsawSession* session) {
  return session->answer.last();
}

const BandsawAnswer* bandsaw_session_hello(BandsawSession* session) {
  return with(session, [&](BrowserSession& s) { return session->answer.bytes(s.hello()); });
}

const BandsawAnswer* bandsaw_session_heartbeat(BandsawSession* session) {
  return with(session, [&](BrowserSession& s) { return session->answer.bytes(s.heartbeat()); });
}

const BandsawAnswer* bandsaw_session_offer(BandsawSession* session, std::uint32_t threads,
                                           double memory_bytes) {
  return with(session, [&](BrowserSession& s) {
    s.offer(threads, whole(memory_bytes));
    return session->answer.none();
  });
}

const BandsawAnswer* bandsaw_session_receive(BandsawSession* session, const void* message,
                                             std::size_t size) {
  return with(session, [&](BrowserSession& s) {
    const absl::StatusOr<BrowserOrders> orders = s.receive(text_of(message, size));
    return orders.ok() ? session->answer.bytes(json_of(*orders))
                       : session->answer.error(orders.status());
  });
}

const BandsawAnswer* bandsaw_session_disconnected(BandsawSession* session) {
  return with(session, [&](BrowserSession& s) {
    s.disconnected();
    return session->answer.none();
  });
}

const BandsawAnswer* bandsaw_session_state(BandsawSession* session) {
  return with(session, [&](BrowserSession& s) {
    const bandsaw::worker::Session& state = s.session();
    const std::string name = bandsaw::clean_text(state.name(), bandsaw::wire::kReasonBytes);
    return session->answer.bytes(
        absl::StrCat("{\"connected\":", boolean(state.connected()),
                     ",\"welcomed\":", boolean(state.was_welcomed()),
                     ",\"drained\":", boolean(state.drained()), ",\"name\":", json_text(name),
                     ",\"heartbeat_ms\":", state.heartbeat_interval().count(), "}"));
  });
}

const BandsawAnswer* bandsaw_session_preparing(BandsawSession* session, std::uint32_t task,
                                               double prepared) {
  return with(session, [&](BrowserSession& s) {
    s.preparing(task, whole(prepared));
    return session->answer.none();
  });
}

const BandsawAnswer* bandsaw_session_rendering(BandsawSession* session, std::uint32_t task,
                                               std::uint32_t rows_done, const void* counters,
                                               std::size_t counters_size) {
  return with(session, [&](BrowserSession& s) {
    return session->answer.status(s.rendering(task, rows_done, text_of(counters, counters_size)));
  });
}

const BandsawAnswer* bandsaw_session_finished(BandsawSession* session, std::uint32_t task) {
  return with(session,
              [&](BrowserSession& s) { return session->answer.bytes(boolean(s.finished(task))); });
}

const BandsawAnswer* bandsaw_session_failed(BandsawSession* session, std::uint32_t task,
                                            const char* reason, std::size_t reason_size,
                                            const char* log, std::size_t log_size) {
  return with(session, [&](BrowserSession& s) {
    return session->answer.bytes(
        s.failed(task, text_of(reason, reason_size), lines_of(log, log_size)));
  });
}

const BandsawAnswer* bandsaw_session_band_header(BandsawSession* session, std::uint32_t task,
                                                 const void* digest, std::size_t digest_size,
                                                 double size, double render_s, double cpu_s) {
  return with(session, [&](BrowserSession& s) {
    const auto checked = bandsaw::wire::digest_from_raw(text_of(digest, digest_size));
    return checked.ok() ? session->answer.text(s.band_header(
                              task, whole(size), *checked, {.render_s = render_s, .cpu_s = cpu_s}))
                        : session->answer.error(checked.status());
  });
}

const BandsawAnswer* bandsaw_session_band_reply(BandsawSession* session, std::uint32_t task,
                                                const void* reply, std::size_t size) {
  return with(session, [&](BrowserSession& s) {
    return session->answer.text(s.band_reply(task, text_of(reply, size)));
  });
}

const BandsawAnswer* bandsaw_session_drain(BandsawSession* session, const char* reason,
                                           std::size_t size) {
  return with(session, [&](BrowserSession& s) {
    return session->answer.bytes(s.drain(text_of(reason, size)));
  });
}

const BandsawAnswer* bandsaw_session_resume(BandsawSession* session) {
  return with(session, [&](BrowserSession& s) {
    s.resume();
    return session->answer.none();
  });
}

const BandsawAnswer* bandsaw_session_log(BandsawSession* session, const char* lines,
                                         std::size_t size) {
  std::vector<std::string> list = lines_of(lines, size);
  if (list.size() > bandsaw::wire::kLogLines) {
    list.resize(bandsaw::wire::kLogLines);
  }
  return session->answer.bytes(bandsaw::worker::log_message(list).SerializeAsString());
}

const BandsawAnswer* bandsaw_session_sha256(BandsawSession* session, const void* bytes,
                                            std::size_t size) {
  return session->answer.bytes(
      bandsaw::wire::sha256({static_cast<const std::byte*>(bytes), size}).raw());
}

BandsawRenderer* bandsaw_renderer_new() { return std::make_unique<BandsawRenderer>().release(); }
void bandsaw_renderer_delete(BandsawRenderer* renderer) { delete renderer; }

const BandsawAnswer* bandsaw_renderer_begin_scene(BandsawRenderer* renderer, const char* digest,
                                                  std::size_t digest_size, const void* manifest,
                                                  std::size_t size) {
  const auto name = digest_of(digest, digest_size);
  if (!name.ok()) {
    return renderer->answer.error(name.status());
  }
  const auto blobs = renderer->renderer.begin_scene(*name, text_of(manifest, size));
  return blobs.ok() ? renderer->answer.bytes(json_of(*blobs))
                    : renderer->answer.error(blobs.status());
}

const BandsawAnswer* bandsaw_renderer_add_blob(BandsawRenderer* renderer, const char* digest,
                                               std::size_t digest_size, void* memory,
                                               std::size_t size) {
  const bandsaw::SharedBytes bytes(
      std::shared_ptr<const void>(
          memory, [](const void* owned) { bandsaw_free(const_cast<void*>(owned)); }),
      {static_cast<const std::byte*>(memory), size});
  const auto name = digest_of(digest, digest_size);
  return renderer->answer.status(name.ok() ? renderer->renderer.add_blob(*name, bytes)
                                           : name.status());
}

const BandsawAnswer* bandsaw_renderer_build_scene(BandsawRenderer* renderer, const char* digest,
                                                  std::size_t digest_size) {
  const auto step = [&]() -> absl::StatusOr<std::string> {
    ASSIGN_OR_RETURN(const bandsaw::wire::Digest name, digest_of(digest, digest_size));
    RETURN_IF_ERROR(renderer->renderer.build_scene());
    ASSIGN_OR_RETURN(const std::uint32_t rows, renderer->renderer.row_step(name));
    return absl::StrCat("{\"row_step\":", rows, "}");
  };
  return renderer->answer.text(step());
}

const BandsawAnswer* bandsaw_renderer_drop_scene(BandsawRenderer* renderer, const char* digest,
                                                 std::size_t digest_size) {
  const auto name = digest_of(digest, digest_size);
  if (!name.ok()) {
    return renderer->answer.error(name.status());
  }
  renderer->renderer.drop_scene(*name);
  return renderer->answer.none();
}

const BandsawAnswer* bandsaw_renderer_render(BandsawRenderer* renderer, const void* bytes,
                                             std::size_t size, std::uint32_t first,
                                             std::uint32_t last) {
  const auto render = [&]() -> absl::Status {
    bandsaw::farm::Lease lease;
    if (!lease.ParseFromString(text_of(bytes, size))) {
      return absl::InvalidArgumentError("the lease is no message");
    }
    ASSIGN_OR_RETURN(renderer->task, bandsaw::worker::task_of(lease));
    ASSIGN_OR_RETURN(renderer->pixels,
                     renderer->renderer.render(renderer->task, {first, last}, page_step));
    return absl::OkStatus();
  };
  const absl::Status status = render();
  const std::vector<double>& sums = renderer->pixels.sums;
  return status.ok()
             ? renderer->answer.refer(sums.data(), sums.size() * sizeof(double), /*failed=*/0)
             : renderer->answer.error(status);
}

const BandsawAnswer* bandsaw_renderer_counters(BandsawRenderer* renderer) {
  return renderer->answer.bytes(bandsaw::to_message(renderer->pixels.counters).SerializeAsString());
}

const BandsawAnswer* bandsaw_renderer_picture(BandsawRenderer* renderer) {
  renderer->picture = renderer->renderer.picture(renderer->task, renderer->pixels);
  return renderer->answer.refer(renderer->picture.data(), renderer->picture.size(), /*failed=*/0);
}
