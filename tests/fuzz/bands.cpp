// Fuzz target (fuzz.h): the chunks in which a worker sends the pixels of a band, a range of rows
// and samples. First the whole input is parsed as one chunk. Then each three bytes of the input
// select what a sender does: it begins a band, continues it, or sends wrong or too many bytes. An
// accepted band must have the bytes that were sent, the announced digest, and valid sums.

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include "coordinator/rpc/band_intake.h"
#include "proto/wire/limits.h"
#include "renderlib/base/check.h"
#include "tests/fuzz/fuzz.h"

namespace {

using namespace bandsaw;
using namespace bandsaw::coordinator;

bool is_sum(double value) { return std::isfinite(value) && value >= 0; }

/// Sends the chunks of bands to a BandIntake, the class with which the coordinator receives them.
class Sender {
 public:
  /// Sends the next message. `number` selects lengths and places. The bits of `what` select the
  /// contents of the message. Their values mean:
  /// - 1: The message has a header, which begins a band.
  /// - 2: A byte of the data is wrong.
  /// - 4: The data has additional bytes at its end.
  ///
  /// The following bits have an effect only if the message has a header:
  /// - 8: The band has a negative sum.
  /// - 16: The header has wrong rows.
  /// - 32: The header has a wrong size.
  /// - 64: The header has a wrong digest.
  void step(std::uint8_t what, std::uint32_t number) {
    farm::BandChunk chunk;
    if ((what & 1) != 0) {
      announce(what, number, *chunk.mutable_header());
    }
    const std::size_t left = band_.size() - std::min(band_.size(), came_.size());
    std::string data = band_.substr(band_.size() - left, number % 512);
    if ((what & 2) != 0 && !data.empty()) {
      data[number % data.size()] ^= static_cast<char>(what);
    }
    if ((what & 4) != 0) {
      data.append(number % 64, 'x');
    }
    chunk.set_data(data);
    if (!intake_.add(chunk).ok()) {
      return leave();
    }
    came_ += data;
    BANDSAW_CHECK(intake_.received() == came_.size() && came_.size() <= intake_.header().size(),
                  "the accepted bytes are within the announced size");
    if (intake_.whole()) {
      take();
    }
  }

 private:
  /// Makes a new band and its header.
  void announce(std::uint8_t what, std::uint32_t number, farm::BandHeader& header) {
    const std::uint32_t width = 1 + number % 7;
    const std::uint32_t rows = 1 + number / 8 % 5;
    std::vector<double> sums(std::size_t{3} * width * rows);
    for (std::size_t i = 0; i < sums.size(); ++i) {
      sums[i] = 0.25 * static_cast<double>(i);
    }
    if ((what & 8) != 0) {
      sums[number % sums.size()] = -1;
    }
    band_.assign(reinterpret_cast<const char*>(sums.data()), sums.size() * sizeof(double));
    header.mutable_band()->set_last_sample(16);
    header.mutable_band()->set_last_row(rows + ((what & 16) != 0 ? number : 0));
    header.set_size(band_.size() + ((what & 32) != 0 ? number : 0));
    header.set_sha256((what & 64) != 0 ? wire::Digest().raw() : wire::sha256(band_).raw());
  }

  /// Checks the received band, which is complete, and forgets it.
  void take() {
    const farm::BandHeader header = intake_.header();
    const auto pixels = intake_.take();
    if (pixels.ok()) {
      const std::size_t bytes = pixels->sums.size() * sizeof(double);
      BANDSAW_CHECK(
          bytes == came_.size() && std::memcmp(pixels->sums.data(), came_.data(), bytes) == 0,
          "the accepted pixels are the received bytes");
      BANDSAW_CHECK(wire::sha256(came_).raw() == header.sha256(),
                    "the received bytes have the announced digest");
      BANDSAW_CHECK(
          pixels->sums.size() == std::size_t{3} * pixels->width * pixels->band.rows.count(),
          "each pixel has three sums");
      BANDSAW_CHECK(std::all_of(pixels->sums.begin(), pixels->sums.end(), is_sum),
                    "each sum is finite and >= 0");
    }
    leave();
  }

  /// Forgets the band. The next message may begin another band.
  void leave() {
    intake_ = BandIntake(memory_);
    came_.clear();
  }

  MemoryBudget memory_{wire::kBandBytes};
  BandIntake intake_{memory_};
  std::string band_;  ///< the bytes that a correct worker would send
  std::string came_;  ///< the bytes of this band that were accepted so far
};

}  // namespace

void bandsaw::fuzz::run(absl::Span<const std::uint8_t> in) {
  farm::BandChunk message;
  if (message.ParseFromArray(in.data(), static_cast<int>(in.size()))) {
    MemoryBudget memory(wire::kBandBytes);
    BandIntake intake(memory);
    if (intake.add(message).ok()) {
      BANDSAW_CHECK(
          intake.received() <= intake.header().size() && intake.header().size() <= wire::kBandBytes,
          "the accepted bytes are within the announced size");
    }
  }
  Sender sender;
  constexpr std::size_t kSteps = 4096;
  each_step(in, kSteps, [&](auto what, auto number) { sender.step(what, number); });
}
