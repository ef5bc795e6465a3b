#pragma once

// A 64-bit hash of bytes that detects damage and differences; not cryptographic. Each word is
// folded in by a multiplication and a rotation; the end uses the finaliser of SplitMix64. The hash
// values are part of the band file format and of the canary (a small test render by which machines
// are compared, canary.h), so they MUST NOT change.

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "absl/types/span.h"
#include "renderlib/base/split_mix.h"

namespace bandsaw {

/// Hashes the words that are added, in the order in which they are added.
class Hash64 {
 public:
  void add(std::uint64_t word) {
    // The second factor is one of the constants of SplitMix64.
    state_ = std::rotl(state_ ^ (word * kSplitMixIncrement), 29) * 0xbf58476d1ce4e5b9u + 1;
  }
  void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
  /// Adds the bytes as little-endian words, of which the last is padded with zeros. Then adds the
  /// number of bytes.
  void add(absl::Span<const std::byte> bytes) {
    std::size_t done = 0;
    for (; done + 8 <= bytes.size(); done += 8) {
      std::uint64_t word;
      std::memcpy(&word, bytes.data() + done, 8);
      add(word);
    }
    std::uint64_t rest = 0;
    if (done < bytes.size()) {
      std::memcpy(&rest, bytes.data() + done, bytes.size() - done);
      add(rest);
    }
    add(static_cast<std::uint64_t>(bytes.size()));
  }

  std::uint64_t value() const { return split_mix(state_); }

 private:
  std::uint64_t state_ = 0x2545f4914f6cdd1du;
};

static_assert(std::endian::native == std::endian::little, "words are read as they lie in memory");

}  // namespace bandsaw
