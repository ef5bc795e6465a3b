#pragma once

// The functions of bandsaw.wasm, in C. The JavaScript of a tab that renders
// (coordinator/web/page/join_wasm.js) uses them to call the classes BrowserSession and
// BrowserRenderer. Texts and bytes are passed as an address and a length. A tab has one
// module and several instances of it. One instance holds a session, and each of the other instances
// holds a renderer. No function throws. A call that fails has the reason in its answer. If memory
// cannot be allocated, the instance ends.

#include <stddef.h>
#include <stdint.h>

extern "C" {

/// Result of a call. If `failed` is 1, the bytes are the text of an error. Otherwise they are the
/// answer that the comment of the function describes. If no answer is described, there are no
/// bytes. The answer belongs to the object that was called, and is valid until the next call.
struct BandsawAnswer {
  const void* data;
  size_t size;
  uint32_t failed;
};

struct BandsawSession;
struct BandsawRenderer;

/// Returns memory for arguments; bandsaw_free frees it.
void* bandsaw_allocate(size_t size);
void bandsaw_free(void* memory);

// ---- BrowserSession; its header says more. A task is a band that the tab holds; numbers of tasks
// are below 2^32. Memory sizes are doubles, because JavaScript's numbers are doubles. ----

/// Returns a new session, which is not connected. `instance`: 32 hexadecimal digits, new for each
/// tab. bandsaw_session_answer tells whether the arguments were right.
BandsawSession* bandsaw_session_new(const char* instance, size_t instance_size, const char* name,
                                    size_t name_size, const char* build, size_t build_size,
                                    uint32_t threads, double memory_bytes);
void bandsaw_session_delete(BandsawSession* session);
/// Returns the answer of the last call.
const BandsawAnswer* bandsaw_session_answer(BandsawSession* session);
/// The answer is a message for the coordinator. The functions heartbeat, failed, drain and log have
/// such an answer, too. If the message is empty, there is nothing to send.
const BandsawAnswer* bandsaw_session_hello(BandsawSession* session);
const BandsawAnswer* bandsaw_session_heartbeat(BandsawSession* session);
/// Changes the number of threads and the memory for scenes that the next hello offers.
const BandsawAnswer* bandsaw_session_offer(BandsawSession* session, uint32_t threads,
                                           double memory_bytes);
/// Takes a message of the coordinator. The answer is JSON: {"stop": [task…], "start": {"task",
/// "job", "manifest", "width", "height", "first", "last", "samples", "lease"} or null, "send":
/// [message…], "dismissal": {"reason", "wait_ms", "for_ever"} or null}. The band has the rows
/// [first, last) and "samples" samples, of all its pixels together; "lease" and messages are
/// base64.
const BandsawAnswer* bandsaw_session_receive(BandsawSession* session, const void* message,
                                             size_t size);
const BandsawAnswer* bandsaw_session_disconnected(BandsawSession* session);
/// The answer is JSON: {"connected", "welcomed", "drained": booleans, "name", "heartbeat_ms"}.
const BandsawAnswer* bandsaw_session_state(BandsawSession* session);
/// Notes progress of the preparation of a band. `prepared`: bytes fetched and steps done, a number
/// that only increases.
const BandsawAnswer* bandsaw_session_preparing(BandsawSession* session, uint32_t task,
                                               double prepared);
/// `counters`: the answer of bandsaw_renderer_counters.
const BandsawAnswer* bandsaw_session_rendering(BandsawSession* session, uint32_t task,
                                               uint32_t rows_done, const void* counters,
                                               size_t counters_size);
/// The answer is "true", or "false" if the band is not wanted any more.
const BandsawAnswer* bandsaw_session_finished(BandsawSession* session, uint32_t task);
/// `log`: lines that end with line breaks.
const BandsawAnswer* bandsaw_session_failed(BandsawSession* session, uint32_t task,
                                            const char* reason, size_t reason_size, const char* log,
                                            size_t log_size);
/// The answer is the bytes that precede the sums in the body of POST /join/band. `digest`: the
/// SHA-256 of the sums, 32 bytes. `size`: the size of the sums in bytes. Times are in seconds.
const BandsawAnswer* bandsaw_session_band_header(BandsawSession* session, uint32_t task,
                                                 const void* digest, size_t digest_size,
                                                 double size, double render_s, double cpu_s);
/// `reply`: the coordinator's reply to POST /join/band. The answer is "stored", "duplicate" or
/// "unwanted".
const BandsawAnswer* bandsaw_session_band_reply(BandsawSession* session, uint32_t task,
                                                const void* reply, size_t size);
/// Requests no more leases. `reason`: for the coordinator. After bandsaw_session_resume, the next
/// stream requests leases again.
const BandsawAnswer* bandsaw_session_drain(BandsawSession* session, const char* reason,
                                           size_t size);
const BandsawAnswer* bandsaw_session_resume(BandsawSession* session);
/// Makes the message that sends `lines`, the tab's log lines, to the coordinator.
const BandsawAnswer* bandsaw_session_log(BandsawSession* session, const char* lines, size_t size);
/// The answer is the SHA-256 of the bytes, 32 bytes. For pages without crypto.subtle.
const BandsawAnswer* bandsaw_session_sha256(BandsawSession* session, const void* bytes,
                                            size_t size);

// ---- BrowserRenderer. Digests are 64 hexadecimal digits. ----

BandsawRenderer* bandsaw_renderer_new(void);
void bandsaw_renderer_delete(BandsawRenderer* renderer);
/// Begins a scene. `digest` is the digest of `manifest`. The answer is JSON, the list of the blobs
/// to add: [{"digest", "size"}…].
const BandsawAnswer* bandsaw_renderer_begin_scene(BandsawRenderer* renderer, const char* digest,
                                                  size_t digest_size, const void* manifest,
                                                  size_t size);
/// `memory`: the blob, in memory of bandsaw_allocate. The renderer frees it, also if the call
/// fails.
const BandsawAnswer* bandsaw_renderer_add_blob(BandsawRenderer* renderer, const char* digest,
                                               size_t digest_size, void* memory, size_t size);
/// Builds the scene that was begun. The answer is JSON: {"row_step"}. A band should be divided only
/// at rows that are multiples of this number (BrowserRenderer::row_step).
const BandsawAnswer* bandsaw_renderer_build_scene(BandsawRenderer* renderer, const char* digest,
                                                  size_t digest_size);
const BandsawAnswer* bandsaw_renderer_drop_scene(BandsawRenderer* renderer, const char* digest,
                                                 size_t digest_size);
/// Renders the rows [first, last) of a lease, which is given as the bytes of a farm.Lease. The
/// answer is the sums of the pixels' samples: rows x width x 3 doubles.
const BandsawAnswer* bandsaw_renderer_render(BandsawRenderer* renderer, const void* lease,
                                             size_t size, uint32_t first, uint32_t last);
/// The answer is a farm.Counters of the rows that were rendered last.
const BandsawAnswer* bandsaw_renderer_counters(BandsawRenderer* renderer);
/// The answer is the rows that were rendered last, as 8-bit RGBA.
const BandsawAnswer* bandsaw_renderer_picture(BandsawRenderer* renderer);

}  // extern "C"
