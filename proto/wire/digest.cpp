// SHA-256 by OpenSSL, or by sha256.h in WebAssembly; conversion of digests to and from text.

#include "proto/wire/digest.h"

#if !defined(__wasm__)
#include <openssl/evp.h>
#endif

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <span>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#if defined(__wasm__)
#include "proto/wire/sha256.h"
#endif

namespace bandsaw::wire {
#if defined(__wasm__)
struct Hasher::Context {
  Sha256 hash;
  void update(absl::Span<const std::byte> bytes) { hash.update(bytes); }
  void finish(Digest& digest) { digest.bytes = hash.finish(); }
};
#else
namespace {

// Aborts after an error of OpenSSL. Every OpenSSL has SHA-256, so hashing bytes in memory fails
// only if the installation of OpenSSL is broken.
void require(int openssl_result) {
  if (openssl_result != 1) {
    std::abort();
  }
}

}  // namespace

struct Hasher::Context {
  EVP_MD_CTX* md = EVP_MD_CTX_new();
  Context() { require(EVP_DigestInit_ex(md, EVP_sha256(), nullptr)); }
  ~Context() { EVP_MD_CTX_free(md); }
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;
  void update(absl::Span<const std::byte> bytes) {
    require(EVP_DigestUpdate(md, bytes.data(), bytes.size()));
  }
  void finish(Digest& digest) { require(EVP_DigestFinal_ex(md, digest.bytes.data(), nullptr)); }
};
#endif

Hasher::Hasher() : context_(std::make_unique<Context>()) {}
Hasher::~Hasher() = default;
Hasher::Hasher(Hasher&&) noexcept = default;
Hasher& Hasher::operator=(Hasher&&) noexcept = default;

void Hasher::update(absl::Span<const std::byte> bytes) { context_->update(bytes); }

Digest Hasher::finish() {
  Digest digest;
  context_->finish(digest);
  return digest;
}

Digest sha256(absl::Span<const std::byte> bytes) {
  Hasher hasher;
  hasher.update(bytes);
  return hasher.finish();
}

Digest sha256(const std::string& bytes) { return sha256(std::as_bytes(std::span(bytes))); }

std::string Digest::raw() const {
  return std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

std::string Digest::hex() const { return absl::BytesToHexString(raw()); }

absl::StatusOr<Digest> digest_from_raw(const std::string& raw) {
  Digest digest;
  if (raw.size() != digest.bytes.size()) {
    return absl::InvalidArgumentError(
        absl::StrCat("a SHA-256 digest must have 32 bytes, has ", raw.size()));
  }
  std::copy(raw.begin(), raw.end(), digest.bytes.begin());
  return digest;
}

absl::StatusOr<Digest> digest_from_hex(const std::string& hex) {
  Digest digest;
  bool valid = hex.size() == 2 * digest.bytes.size();
  for (std::size_t i = 0; valid && i < digest.bytes.size(); ++i) {
    const char* const digits = &hex[2 * i];
    valid = std::from_chars(digits, digits + 2, digest.bytes[i], 16).ptr == digits + 2;
  }
  if (!valid) {
    return absl::InvalidArgumentError("a SHA-256 digest must be written as 64 hexadecimal digits");
  }
  return digest;
}

}  // namespace bandsaw::wire
