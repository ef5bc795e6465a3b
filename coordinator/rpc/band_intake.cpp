// Assembles a band (the pixels of some rows and samples) from the chunks in which it arrives. The
// first chunk has the header. begin() checks the fields of the header, then takes the size of the
// band from the memory budget for bands, before any byte of the band is kept. take() checks the
// digest and the values of the whole band.

#include "coordinator/rpc/band_intake.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>

#include "absl/strings/str_cat.h"
#include "coordinator/rpc/blob_intake.h"
#include "coordinator/rpc/checked_messages.h"
#include "proto/convert/render_values.h"
#include "proto/wire/limits.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

/// Three sums of a pixel: red, green, blue.
constexpr std::uint64_t kPixelBytes = 3 * sizeof(double);

/// Returns true for a value that a sum, or a time, can have.
bool is_sum(double value) { return std::isfinite(value) && value >= 0; }

}  // namespace

absl::Status BandIntake::begin(const farm::BandHeader& header) {
  ASSIGN_OR_RETURN(pixels_.band, band("header.band", header.band()));
  RETURN_IF_ERROR(digest_field("header.sha256", header.sha256()).status());
  RETURN_IF_ERROR(reason_field("header.instance", header.instance()).status());
  if (header.size() > wire::kBandBytes) {
    return absl::InvalidArgumentError(absl::StrCat(
        "header.size: a band has at most ", wire::kBandBytes, " bytes, not ", header.size()));
  }
  const std::uint64_t row_bytes = header.size() / pixels_.band.rows.count();
  if (row_bytes == 0 || row_bytes * pixels_.band.rows.count() != header.size() ||
      row_bytes % kPixelBytes != 0 || row_bytes / kPixelBytes > kMaxSide) {
    return absl::InvalidArgumentError(absl::StrCat("header.size: ", header.size(),
                                                   " bytes are not ", pixels_.band.rows.count(),
                                                   " rows of pixels of ", kPixelBytes, " bytes"));
  }
  if (!is_sum(header.counters().render_s()) || !is_sum(header.counters().cpu_s())) {
    return absl::InvalidArgumentError("header.counters: times must be finite and >= 0");
  }
  std::optional<MemoryBudget::Share> share = memory_->take(header.size());
  if (!share) {
    return no_memory_for_band();
  }
  share_ = *std::move(share);
  pixels_.width = static_cast<std::uint32_t>(row_bytes / kPixelBytes);
  // Reserves address space; pages are touched only as bytes arrive.
  pixels_.sums.reserve(header.size() / sizeof(double));
  pixels_.counters = counters_of(header.counters());
  header_ = header;
  begun_ = true;
  return absl::OkStatus();
}

absl::Status BandIntake::add(const farm::BandChunk& chunk) {
  if (!begun_) {
    if (!chunk.has_header()) {
      return absl::InvalidArgumentError("header: must be in the first chunk of a band");
    }
    RETURN_IF_ERROR(begin(chunk.header()));
  } else if (chunk.has_header()) {
    return absl::InvalidArgumentError("header: belongs in the first chunk of a band only");
  }
  return append(chunk.data());
}

absl::Status BandIntake::append(absl::string_view data) {
  RETURN_IF_ERROR(check_chunk(data, received_, header_.size()));
  const std::uint64_t bytes = received_ + data.size();
  pixels_.sums.resize((bytes + sizeof(double) - 1) / sizeof(double));
  std::memcpy(reinterpret_cast<char*>(pixels_.sums.data()) + received_, data.data(), data.size());
  received_ += data.size();
  hasher_.update(std::as_bytes(std::span(data.data(), data.size())));
  return absl::OkStatus();
}

absl::StatusOr<BandPixels> BandIntake::take() {
  if (hasher_.finish().raw() != header_.sha256()) {
    return absl::InvalidArgumentError("header.sha256: the received bytes have another digest");
  }
  if (!std::all_of(pixels_.sums.begin(), pixels_.sums.end(), is_sum)) {
    return absl::InvalidArgumentError("data: a pixel's sum is not a finite number >= 0");
  }
  return std::move(pixels_);
}

void BandIntake::put(Engine& engine, std::function<void(absl::StatusOr<BandOutcome>)> done,
                     bool browser) {
  absl::StatusOr<BandPixels> pixels = take();
  if (!pixels.ok()) {
    done(pixels.status());
    return;
  }
  engine.put_band(header_.job(), header_.work(), header_.instance(), *std::move(pixels),
                  header_.counters().render_s(), header_.counters().cpu_s(), std::move(done),
                  browser, std::move(share_));
}

farm::PutBandReply::Outcome to_message(BandOutcome outcome) {
  switch (outcome) {
    case BandOutcome::kStored:
      return farm::PutBandReply::OUTCOME_STORED;
    case BandOutcome::kDuplicate:
      return farm::PutBandReply::OUTCOME_DUPLICATE;
    case BandOutcome::kUnwanted:
      break;
  }
  return farm::PutBandReply::OUTCOME_UNWANTED;
}

}  // namespace bandsaw::coordinator
