// Compares SHA-256 with the examples of its standard, and tests the written forms of a digest.

#include "proto/wire/digest.h"

#include <gtest/gtest.h>

#include <utility>

#include "proto/wire/sha256.h"

namespace bandsaw::wire {
namespace {

absl::Span<const std::byte> bytes_of(const std::string& text) {
  return absl::MakeConstSpan(reinterpret_cast<const std::byte*>(text.data()), text.size());
}

TEST(Digest, EqualsTheExamplesOfTheStandard) {
  // FIPS 180-4, examples of NIST for SHA-256.
  EXPECT_EQ(sha256(std::string()).hex(),
            "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256(std::string("abc")).hex(),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256(std::string("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq")).hex(),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
}

TEST(Digest, DoesNotDependOnTheDivisionIntoPieces) {
  const std::string text(100'000, 'x');
  for (const std::size_t piece : {1ul, 63ul, 64ul, 65ul, 99'999ul, 100'000ul}) {
    Hasher hasher;
    for (std::size_t at = 0; at < text.size(); at += piece) {
      hasher.update(bytes_of(text.substr(at, piece)));
    }
    EXPECT_EQ(hasher.finish(), sha256(text)) << piece;
  }
}

// In browsers, SHA-256 is computed by the class Sha256 instead of OpenSSL.
TEST(Digest, TheDigestOfWebAssemblyEqualsThatOfOpenSsl) {
  std::string text;
  for (std::size_t size = 0; size < 300; ++size) {
    Sha256 whole;
    whole.update(bytes_of(text));
    EXPECT_EQ(whole.finish(), sha256(text).bytes) << size;
    Sha256 pieces;
    pieces.update(bytes_of(text.substr(0, size / 3)));
    pieces.update(bytes_of(text.substr(size / 3)));
    EXPECT_EQ(pieces.finish(), sha256(text).bytes) << size;
    text.push_back(static_cast<char>(size * 7919 % 251));
  }
}

TEST(Digest, RoundTripsInBothWrittenForms) {
  const Digest digest = sha256(std::string("bandsaw"));
  EXPECT_EQ(digest_from_raw(digest.raw()).value(), digest);
  EXPECT_EQ(digest_from_hex(digest.hex()).value(), digest);
}

TEST(Digest, RefusesOtherLengthsAndDigits) {
  const Digest digest = sha256(std::string("bandsaw"));
  EXPECT_FALSE(digest_from_raw(digest.raw().substr(1)).ok());
  EXPECT_FALSE(digest_from_raw(digest.raw() + "x").ok());
  EXPECT_FALSE(digest_from_hex("").ok());
  EXPECT_FALSE(digest_from_hex(digest.hex() + "00").ok());
  std::string hex = digest.hex();
  hex[17] = 'g';
  EXPECT_FALSE(digest_from_hex(hex).ok());
}

TEST(Hasher, CanBeMoved) {
  Hasher first;
  first.update(bytes_of("band"));
  Hasher second = std::move(first);
  second.update(bytes_of("saw"));
  EXPECT_EQ(second.finish(), sha256(std::string("bandsaw")));
}

}  // namespace
}  // namespace bandsaw::wire
