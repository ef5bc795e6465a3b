// Counts the wrong secrets of each address. A count is for one minute, which begins with the first
// wrong secret of the address.

#include "coordinator/rpc/failures.h"

namespace bandsaw::coordinator {
namespace {

constexpr double kMinute_s = 60;
/// Bounds the memory.
constexpr std::size_t kMaxAddresses = 10'000;

}  // namespace

Failures::Verdict Failures::add(const std::string& address, double now) {
  if (counts_.size() >= kMaxAddresses && !counts_.contains(address)) {
    forget_old(now);
  }
  Count& count = counts_[address];
  if (count.failures == 0 || now - count.since >= kMinute_s) {
    count = {.since = now, .failures = 0};
  }
  ++count.failures;
  return count.failures == 1      ? Verdict::kFirst
         : count.failures > most_ ? Verdict::kTooMany
                                  : Verdict::kMore;
}

/// Removes addresses whose minute is over. If all addresses are still within their minute, they are
/// assumed to belong to one attacker, and all counts are cleared.
void Failures::forget_old(double now) {
  std::erase_if(counts_, [&](const auto& one) { return now - one.second.since >= kMinute_s; });
  if (counts_.size() >= kMaxAddresses) {
    counts_.clear();
  }
}

}  // namespace bandsaw::coordinator
