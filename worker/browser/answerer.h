#pragma once

#include <string>
#include <utility>

#include "absl/status/statusor.h"
#include "proto/wire/limits.h"
#include "renderlib/base/clean_text.h"
#include "worker/browser/exports.h"

namespace bandsaw::worker {

/// Holds the last answer of one object, a session or a renderer of exports.h. Each function below
/// returns a pointer to the answer, and all but last() overwrite it. The page's JavaScript reads
/// the answer from the memory of the WebAssembly module.
class Answerer {
 public:
  /// Keeps a copy of the bytes.
  const BandsawAnswer* bytes(std::string bytes) {
    bytes_ = std::move(bytes);
    return refer(bytes_.data(), bytes_.size(), /*failed=*/0);
  }
  const BandsawAnswer* none() { return bytes(""); }
  /// Answers with bytes of the caller. `data` MUST live until the next answer; `failed`: 0 or 1.
  const BandsawAnswer* refer(const void* data, std::size_t size, std::uint32_t failed) {
    answer_ = {data, size, failed};
    return &answer_;
  }
  /// Answers with the error's message, cleaned and bounded in length, and marks it as failed.
  const BandsawAnswer* error(const absl::Status& status) {
    bytes_ = clean_text(std::string(status.message()), wire::kReasonBytes);
    return refer(bytes_.data(), bytes_.size(), /*failed=*/1);
  }
  const BandsawAnswer* status(const absl::Status& status) {
    return status.ok() ? none() : error(status);
  }
  const BandsawAnswer* text(const absl::StatusOr<std::string>& text) {
    return text.ok() ? bytes(*text) : error(text.status());
  }
  const BandsawAnswer* last() const { return &answer_; }

 private:
  std::string bytes_;
  BandsawAnswer answer_ = {nullptr, 0, 0};
};

}  // namespace bandsaw::worker
