#pragma once

// A place in a scene file: the message that was read there, its path, and its line and column, for
// errors that say where.

#include <google/protobuf/message.h>
#include <google/protobuf/text_format.h>

#include <optional>
#include <string>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"

namespace bandsaw {

class Field {
 public:
  /// The whole file. `locations` is null where the format has none (JSON). All MUST outlive this
  /// and its children.
  Field(const std::string& file, const google::protobuf::Message& root,
        const google::protobuf::TextFormat::ParseInfoTree* locations)
      : file_(&file), message_(&root), tree_(locations) {}

  /// A message field of this one; `index` is -1 where it is not repeated.
  Field child(const std::string& name, int index = -1) const;
  /// Whether a singular field was written.
  bool has(const std::string& name) const;

  /// "cornell.textproto:12:3: shape[4].sphere.radius: <what>", at the field where it was written,
  /// else at its message.
  absl::Status error(const std::string& name, absl::string_view what, int index = -1) const;
  /// The same about this message itself.
  absl::Status error(absl::string_view what) const;

  /// "shape[4].sphere.radius"
  std::string path(const std::string& name, int index = -1) const;

 private:
  struct At {
    int line = -1;  ///< from 0, as protobuf counts
    int column = -1;
  };
  At at(const std::string& name, int index) const;
  absl::Status failure(const At& at, const std::string& path, absl::string_view what) const;

  const std::string* file_;
  const google::protobuf::Message* message_;
  const google::protobuf::TextFormat::ParseInfoTree* tree_;
  std::string path_;
  At at_;
};

}  // namespace bandsaw
