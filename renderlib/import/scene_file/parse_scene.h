#pragma once

// The text of a scene file as proto/scene.proto, before it means anything.

#include <google/protobuf/text_format.h>

#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "proto/scene.pb.h"

namespace bandsaw {

struct ParsedScene {
  scene::Scene scene;
  /// Where each field was written; null for JSON.
  std::unique_ptr<google::protobuf::TextFormat::ParseInfoTree> locations;
};

/// `file` is what errors call it. INVALID_ARGUMENT: "cornell.textproto:12:3: <cause>; <cure>", the
/// first that is wrong.
absl::StatusOr<ParsedScene> parse_textproto(const std::string& text, const std::string& file);
/// INVALID_ARGUMENT with the field's path, or the line and column where the JSON itself is broken.
absl::StatusOr<ParsedScene> parse_json(const std::string& text, const std::string& file);

}  // namespace bandsaw
