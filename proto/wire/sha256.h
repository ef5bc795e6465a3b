#pragma once

// SHA-256 (FIPS 180-4) without a library, for WebAssembly. Other programs use OpenSSL, whose
// SHA-256 is faster.

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "absl/types/span.h"

namespace bandsaw::wire {

/// Computes the digest of bytes that arrive in pieces.
class Sha256 {
 public:
  void update(absl::Span<const std::byte> bytes) {
    size_ += bytes.size();
    while (!bytes.empty()) {
      const std::size_t taken = std::min(bytes.size(), kBlock - filled_);
      std::copy_n(bytes.begin(), taken, block_.begin() + static_cast<std::ptrdiff_t>(filled_));
      bytes.remove_prefix(taken);
      filled_ += taken;
      if (filled_ == kBlock) {
        compress();
        filled_ = 0;
      }
    }
  }

  /// Returns the digest of all bytes. MUST be called once, at the end.
  std::array<unsigned char, 32> finish() {
    // Appends the padding of the standard: a 1 bit, zeros, and the number of bits.
    const std::uint64_t bits = size_ * 8;
    constexpr std::byte kEnd{0x80};
    update({&kEnd, 1});
    constexpr std::byte kZero{0};
    while (filled_ != kBlock - sizeof(bits)) {
      update({&kZero, 1});
    }
    for (int shift = 56; shift >= 0; shift -= 8) {
      const auto part = static_cast<std::byte>(bits >> shift & 0xff);
      update({&part, 1});
    }
    std::array<unsigned char, 32> digest;
    for (std::size_t i = 0; i < digest.size(); ++i) {
      digest[i] = static_cast<unsigned char>(state_[i / 4] >> (24 - 8 * (i % 4)) & 0xff);
    }
    return digest;
  }

 private:
  static constexpr std::size_t kBlock = 64;
  using Words = std::array<std::uint32_t, 64>;

  /// The first 32 bits of the fractional parts of the cube roots of the first 64 primes.
  static constexpr Words kRounds = {
      0x428a2f98, 0x71374491, 0xb5c0fbcf, 0xe9b5dba5, 0x3956c25b, 0x59f111f1, 0x923f82a4,
      0xab1c5ed5, 0xd807aa98, 0x12835b01, 0x243185be, 0x550c7dc3, 0x72be5d74, 0x80deb1fe,
      0x9bdc06a7, 0xc19bf174, 0xe49b69c1, 0xefbe4786, 0x0fc19dc6, 0x240ca1cc, 0x2de92c6f,
      0x4a7484aa, 0x5cb0a9dc, 0x76f988da, 0x983e5152, 0xa831c66d, 0xb00327c8, 0xbf597fc7,
      0xc6e00bf3, 0xd5a79147, 0x06ca6351, 0x14292967, 0x27b70a85, 0x2e1b2138, 0x4d2c6dfc,
      0x53380d13, 0x650a7354, 0x766a0abb, 0x81c2c92e, 0x92722c85, 0xa2bfe8a1, 0xa81a664b,
      0xc24b8b70, 0xc76c51a3, 0xd192e819, 0xd6990624, 0xf40e3585, 0x106aa070, 0x19a4c116,
      0x1e376c08, 0x2748774c, 0x34b0bcb5, 0x391c0cb3, 0x4ed8aa4a, 0x5b9cca4f, 0x682e6ff3,
      0x748f82ee, 0x78a5636f, 0x84c87814, 0x8cc70208, 0x90befffa, 0xa4506ceb, 0xbef9a3f7,
      0xc67178f2};

  /// Returns the message schedule: the 16 words of the block, extended to 64.
  Words schedule() const {
    Words w;
    for (std::size_t i = 0; i < 16; ++i) {
      w[i] = 0;
      for (std::size_t k = 0; k < 4; ++k) {
        w[i] = w[i] << 8 | std::to_integer<std::uint32_t>(block_[4 * i + k]);
      }
    }
    for (std::size_t i = 16; i < w.size(); ++i) {
      const std::uint32_t a = w[i - 15];
      const std::uint32_t b = w[i - 2];
      w[i] = w[i - 16] + (std::rotr(a, 7) ^ std::rotr(a, 18) ^ a >> 3) + w[i - 7] +
             (std::rotr(b, 17) ^ std::rotr(b, 19) ^ b >> 10);
    }
    return w;
  }

  /// Adds the block to the state: 64 rounds with the working variables a to h. `first` and `second`
  /// are T1 and T2 of the standard.
  void compress() {
    const Words w = schedule();
    auto [a, b, c, d, e, f, g, h] = state_;
    for (std::size_t i = 0; i < w.size(); ++i) {
      const std::uint32_t first = h + (std::rotr(e, 6) ^ std::rotr(e, 11) ^ std::rotr(e, 25)) +
                                  ((e & f) ^ (~e & g)) + kRounds[i] + w[i];
      const std::uint32_t second =
          (std::rotr(a, 2) ^ std::rotr(a, 13) ^ std::rotr(a, 22)) + ((a & b) ^ (a & c) ^ (b & c));
      h = g;
      g = f;
      f = e;
      e = d + first;
      d = c;
      c = b;
      b = a;
      a = first + second;
    }
    const std::array<std::uint32_t, 8> change = {a, b, c, d, e, f, g, h};
    for (std::size_t i = 0; i < state_.size(); ++i) {
      state_[i] += change[i];
    }
  }

  /// The first 32 bits of the fractional parts of the square roots of the first eight primes.
  std::array<std::uint32_t, 8> state_ = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                         0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<std::byte, kBlock> block_;
  std::size_t filled_ = 0;
  std::uint64_t size_ = 0;  ///< bytes
};

}  // namespace bandsaw::wire
