#pragma once

// Splits a pbrt scene file, and the files that it includes, into words.

#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "renderlib/import/files/scene_folder.h"
#include "renderlib/import/pbrt/place.h"

namespace bandsaw::pbrt {

/// Bounds, so that a hostile scene ends with an error.
inline constexpr std::size_t kMaxIncludes = 32;  ///< files that may be open at the same time
inline constexpr std::uint64_t kMaxFileBytes = std::uint64_t{2} << 30;
/// Maximum total size of all files.
inline constexpr std::uint64_t kMaxSceneBytes = std::uint64_t{4} << 30;

/// A word, a string in quotes, or a bracket, [ or ].
struct Token {
  enum class Kind { kWord, kString, kOpen, kClose };
  Kind kind = Kind::kWord;
  std::string text;  ///< without quotes
  Place place;
};

/// Reads the words of a scene file and of the files that it includes, plain or compressed by gzip.
class Tokens {
 public:
  /// `folder` MUST outlive the object.
  explicit Tokens(const SceneFolder& folder) : folder_(folder) {}

  /// Continues with the first word of the file `name`, relative to the scene's folder. `place` is
  /// the place of the directive that includes it. The error is NOT_FOUND or PERMISSION_DENIED if
  /// the file cannot be read, INVALID_ARGUMENT if it includes itself, and RESOURCE_EXHAUSTED if
  /// files include each other too deeply or are too large together.
  absl::Status include(const std::string& name, const Place& place);

  /// Returns the next word; std::nullopt after the last one. The error is INVALID_ARGUMENT for a
  /// string without end.
  absl::StatusOr<std::optional<Token>> next();
  /// Returns the number of open files: the file of the token that next() returned last, and the
  /// files that include it, directly or not. Returns 0 after next() has returned std::nullopt.
  std::size_t depth() const { return open_.size(); }
  /// Makes next() return this token again.
  void put_back(Token token) { back_ = std::move(token); }

 private:
  struct Source {
    std::string path;
    std::string name;
    std::string text;
    std::size_t at = 0;
    int line = 1;
  };
  absl::StatusOr<Token> read_string(Source& from);
  static void skip_space(Source& from);

  const SceneFolder& folder_;
  std::vector<Source> open_;
  std::optional<Token> back_;  ///< token of put_back() that next() returns first
  std::uint64_t total_bytes_ = 0;
};

}  // namespace bandsaw::pbrt
