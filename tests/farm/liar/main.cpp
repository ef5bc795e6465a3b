// A worker for the tests of audits. It behaves as if its memory were defective: it renders
// correctly, but it sends wrong pixels. The coordinator lets it join, because its canary (the hash
// of a small test image) is right.

#include "worker/command.h"

namespace {

using bandsaw::worker::CoordinatorApi;

/// Adds 1 to one number of every band that is sent. The numbers of a band are the sums of its
/// pixels' samples.
class WrongPixels final : public CoordinatorApi {
 public:
  explicit WrongPixels(CoordinatorApi& calls) : calls_(calls) {}

  absl::Status get_blob(const bandsaw::wire::Digest& digest, std::uint64_t offset,
                        const bandsaw::worker::TakeBytes& take) override {
    return calls_.get_blob(digest, offset, take);
  }
  absl::StatusOr<bandsaw::farm::PutBandReply::Outcome> put_band(
      const bandsaw::worker::FinishedBand& band, const bandsaw::worker::LeaseName& lease) override {
    bandsaw::worker::FinishedBand wrong = band;
    wrong.pixels.sums.front() += 1;
    return calls_.put_band(wrong, lease);
  }

 private:
  CoordinatorApi& calls_;
};

}  // namespace

int main(int argc, char** argv) {
  return bandsaw::worker::run_command(
      argc, argv, [](CoordinatorApi& calls) { return std::make_unique<WrongPixels>(calls); });
}
