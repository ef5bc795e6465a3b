#pragma once

// Parses the text of a scene file to the message Scene of proto/scene.proto, without interpreting
// it.

#include <google/protobuf/text_format.h>

#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "proto/scene.pb.h"

namespace bandsaw {

struct ParsedScene {
  scene::Scene scene;
  /// Positions of the fields; nullptr for JSON.
  std::unique_ptr<google::protobuf::TextFormat::ParseInfoTree> locations;
};

/// Parses a scene in protobuf's text format. `file` is the file's name in errors. Returns
/// INVALID_ARGUMENT for the first error: "cornell.textproto:12:3: <cause>". If a field is unknown,
/// the message also names the known fields.
absl::StatusOr<ParsedScene> parse_textproto(const std::string& text, const std::string& file);
/// Parses a scene in JSON. Returns INVALID_ARGUMENT with the field's path, or with line and column
/// if the JSON itself is broken.
absl::StatusOr<ParsedScene> parse_json(const std::string& text, const std::string& file);

}  // namespace bandsaw
