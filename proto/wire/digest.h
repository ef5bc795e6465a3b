#pragma once

// SHA-256 digests. A blob (a part of a scene package) is named by its digest. When a worker sends
// the pixels of a band (a range of rows and samples), their digest is the checksum.

#include <array>
#include <compare>
#include <cstddef>
#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "absl/types/span.h"

namespace bandsaw::wire {

struct Digest {
  std::array<unsigned char, 32> bytes{};
  friend auto operator<=>(const Digest&, const Digest&) = default;

  std::string hex() const;  ///< 64 lower-case hexadecimal digits
  std::string raw() const;  ///< 32 bytes, as in protobuf messages
};

Digest sha256(absl::Span<const std::byte> bytes);
Digest sha256(const std::string& bytes);

/// Both functions parse a digest. INVALID_ARGUMENT: `raw` does not have 32 bytes, or `hex` is not
/// 64 hexadecimal digits.
absl::StatusOr<Digest> digest_from_raw(const std::string& raw);
absl::StatusOr<Digest> digest_from_hex(const std::string& hex);

/// Computes the digest of bytes that arrive in pieces.
class Hasher {
 public:
  Hasher();
  ~Hasher();
  Hasher(Hasher&&) noexcept;
  Hasher& operator=(Hasher&&) noexcept;
  void update(absl::Span<const std::byte> bytes);
  /// Returns the digest of all bytes. MUST be called once, at the end.
  Digest finish();

 private:
  struct Context;
  std::unique_ptr<Context> context_;
};

}  // namespace bandsaw::wire
