// Fuzz target (fuzz.h): messages that the coordinator checks before it uses them. The first byte of
// the input selects the kind of message: a submission, a band, a quarantine, or digests. The rest
// of the input is the message. The samples of a valid band are a node of the summation tree: one
// block of 8 samples, or an aligned power-of-two number of blocks (glossary: proto/README.md).

#include "coordinator/rpc/checked_messages.h"
#include "renderlib/base/check.h"
#include "renderlib/render/settings.h"
#include "tests/fuzz/fuzz.h"

namespace {

using namespace bandsaw;

template <class Message>
Message parsed(absl::Span<const std::uint8_t> bytes) {
  Message message;
  message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()));
  return message;
}

}  // namespace

void bandsaw::fuzz::run(absl::Span<const std::uint8_t> in) {
  if (in.empty()) {
    return;
  }
  const auto rest = in.subspan(1);
  switch (in[0] % 4) {
    case 0:
      if (const auto spec = coordinator::job_spec(parsed<farm::SubmitRequest>(rest)); spec.ok()) {
        BANDSAW_CHECK(validate(spec->settings).ok(), "accepted settings are in range");
      }
      break;
    case 1:
      if (const auto band = coordinator::band("band", parsed<farm::Band>(rest)); band.ok()) {
        BANDSAW_CHECK(is_node(band->samples) && band->rows.first < band->rows.last,
                      "an accepted band is a node and has rows");
      }
      break;
    case 2:
      coordinator::reason_field("worker", parsed<farm::QuarantineRequest>(rest).worker())
          .IgnoreError();
      break;
    default: {
      const auto request = parsed<farm::MissingBlobsRequest>(rest);
      for (const std::string& raw : request.sha256()) {
        coordinator::digest_field("sha256", raw).IgnoreError();
      }
    }
  }
}
