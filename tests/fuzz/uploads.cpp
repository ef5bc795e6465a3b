// Fuzz target (fuzz.h): the chunks in which a blob, the bytes that belong to a digest, is uploaded
// to the coordinator. First the whole input is parsed as one chunk. Then each group of three bytes
// selects what happens next: a sender begins, continues, skips bytes, sends wrong bytes or is
// interrupted, or the disk is damaged. After every step, a stored blob must have the bytes of
// its digest.

#include <algorithm>
#include <cstring>
#include <fstream>
#include <optional>
#include <span>

#include "coordinator/rpc/blob_intake.h"
#include "coordinator/store/blob_store.h"
#include "proto/wire/limits.h"
#include "renderlib/base/check.h"
#include "tests/fuzz/fuzz.h"
#include "tests/support/pattern.h"
#include "tests/support/temp_dir.h"

namespace {

using namespace bandsaw;
using namespace bandsaw::coordinator;

/// Returns the bytes of the blob. The blob is so large that the store keeps the received part of an
/// interrupted upload.
const std::string& content() {
  static const std::string bytes = test::pattern(PartialBlobs::kMinBytes + 40'000);
  return bytes;
}

/// Uploads one blob to a store again and again, with interruptions and wrong bytes.
class Sender {
 public:
  explicit Sender(const std::string& folder) : folder_(folder), store_(*BlobStore::open(folder)) {}

  /// Does the next step. `number` selects lengths and places. `what` modulo 6 selects the kind of
  /// the step:
  /// - 0: The upload is interrupted.
  /// - 1: The coordinator restarts.
  /// - 2: A byte of the stored part is damaged.
  /// - 3: The sender ends the upload.
  /// - 4 and 5: The sender sends a chunk.
  void step(std::uint8_t what, std::uint32_t number) {
    switch (what % 6) {
      case 0:
        leave();
        return;
      case 1:
        leave();
        store_ = *BlobStore::open(folder_);
        break;
      case 2:
        damage(number);
        break;
      case 3:
        finish();
        break;
      default:
        send(what, number);
    }
    check();
  }

 private:
  /// Ends the upload. The next chunk begins another upload.
  void leave() {
    writer_.reset();
    intake_ = {};
  }

  /// Overwrites a byte of the stored part; `number` selects its place.
  void damage(std::uint32_t number) {
    const std::uint64_t size = store_->partial(digest_);
    if (size > 0) {
      std::fstream part(folder_ + "/incoming/" + digest_.hex() + ".part",
                        std::ios::in | std::ios::out | std::ios::binary);
      part.seekp(static_cast<std::streamoff>(number * 32 % size)).put('x');
    }
  }

  /// Ends the upload. If all bytes have come, they must be stored or, if they are wrong, forgotten.
  void finish() {
    if (!intake_.end().ok()) {
      return leave();
    }
    const absl::Status status = writer_->commit();
    BANDSAW_CHECK(!status.ok() || store_->has(digest_), "what was stored is there");
    leave();
    BANDSAW_CHECK(status.ok() || store_->partial(digest_) == 0, "wrong bytes are not kept");
  }

  /// Sends a chunk. Three bits of `what` select its kind. 32: a bit of the data is wrong. 64: a new
  /// upload continues after the stored bytes; otherwise it begins at 16 * `number`. 128: the offset
  /// in the chunk is too large by `number`.
  void send(std::uint8_t what, std::uint32_t number) {
    farm::BlobChunk chunk;
    std::uint64_t offset = intake_.received();
    if (!intake_.begun()) {
      offset = (what & 64) != 0 ? store_->partial(digest_) : number * 16;
      chunk.set_sha256(digest_.raw());
      chunk.set_size(content().size());
    }
    chunk.set_offset(offset + ((what & 128) != 0 ? number : 0));
    const std::size_t from = std::min<std::size_t>(offset, content().size());
    std::string data = content().substr(from, number * 32);
    if ((what & 32) != 0 && !data.empty()) {
      data[number % data.size()] ^= 1;
    }
    chunk.set_data(data);
    const bool first = !intake_.begun();
    if (!intake_.add(chunk).ok()) {
      return leave();
    }
    if (first) {
      auto writer = store_->write(intake_.digest(), intake_.size(), intake_.first_offset());
      if (!writer.ok()) {
        return leave();
      }
      writer_.emplace(*std::move(writer));
    }
    BANDSAW_CHECK(writer_->append(std::as_bytes(std::span(data))).ok(), "there is room");
  }

  /// Checks that a stored part is not too long. If the whole blob is stored, checks its bytes and
  /// removes it, so that it can be uploaded again.
  void check() {
    BANDSAW_CHECK(store_->partial(digest_) <= content().size(),
                  "a part is not more than the whole");
    if (!store_->has(digest_)) {
      return;
    }
    const auto blob = store_->get(digest_);
    BANDSAW_CHECK(blob.ok(), "a stored blob can be read");
    const auto bytes = (*blob)->bytes();
    BANDSAW_CHECK(bytes.size() == content().size() &&
                      std::memcmp(bytes.data(), content().data(), bytes.size()) == 0,
                  "a stored blob has the bytes of its digest");
    BANDSAW_CHECK(store_->remove(digest_).ok(), "a blob can be removed");
  }

  const std::string folder_;
  const wire::Digest digest_ = wire::sha256(content());
  std::unique_ptr<BlobStore> store_;
  BlobIntake intake_;
  std::optional<BlobStore::Writer> writer_;
};

}  // namespace

void bandsaw::fuzz::run(absl::Span<const std::uint8_t> in) {
  farm::BlobChunk message;
  if (message.ParseFromArray(in.data(), static_cast<int>(in.size()))) {
    BlobIntake intake;
    if (intake.add(message).ok()) {
      BANDSAW_CHECK(intake.received() <= intake.size() && intake.size() <= wire::kBlobBytes,
                    "the accepted bytes are within the announced size");
    }
  }
  const test::TempDir folder;
  Sender sender(folder.path());
  constexpr std::size_t kSteps = 64;
  each_step(in, kSteps, [&](auto what, auto number) { sender.step(what, number); });
}
