// A worker with defective memory: it renders correctly, and its canary is right, but it sends wrong
// pixels. The linker replaces FarmCalls::put_band by `lie` (tests/CMakeLists.txt), so that the
// worker's code contains nothing for tests.

#include "worker/session/farm_calls.h"

namespace {

using Outcome = absl::StatusOr<bandsaw::farm::PutBandReply::Outcome>;

}  // namespace

extern "C" {

// A member function takes its object as its first argument (Itanium C++ ABI, section 3.2.1).
Outcome
put_band_as_it_is(bandsaw::worker::FarmCalls* calls, const bandsaw::worker::FinishedBand& band, const std::string& instance, const bandsaw::worker::LeaseName& lease) __asm__(
    "__real__ZN7bandsaw6worker9FarmCalls8put_bandERKNS0_12FinishedBandERKNSt7__cxx1112basic_"
    "stringIcSt11char_traitsIcESaIcEEERKNS0_9LeaseNameE");

Outcome
lie(bandsaw::worker::FarmCalls* calls, const bandsaw::worker::FinishedBand& band, const std::string& instance, const bandsaw::worker::LeaseName& lease) __asm__(
    "__wrap__ZN7bandsaw6worker9FarmCalls8put_bandERKNS0_12FinishedBandERKNSt7__cxx1112basic_"
    "stringIcSt11char_traitsIcESaIcEEERKNS0_9LeaseNameE");
}

Outcome lie(bandsaw::worker::FarmCalls* calls, const bandsaw::worker::FinishedBand& band,
            const std::string& instance, const bandsaw::worker::LeaseName& lease) {
  bandsaw::worker::FinishedBand wrong = band;
  wrong.pixels.sums.front() += 1;
  return put_band_as_it_is(calls, wrong, instance, lease);
}
