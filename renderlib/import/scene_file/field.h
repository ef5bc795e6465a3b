#pragma once

// A Field is a message in a scene file, with its path, and with its line and column for errors.

#include <google/protobuf/message.h>
#include <google/protobuf/text_format.h>

#include <optional>
#include <string>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"

namespace bandsaw {

class Field {
 public:
  /// Creates the Field of a whole file, whose name is `file`. `locations` is nullptr if the format
  /// has none (JSON). All arguments MUST outlive this object and its children.
  Field(const std::string& file, const google::protobuf::Message& root,
        const google::protobuf::TextFormat::ParseInfoTree* locations)
      : file_(&file), message_(&root), tree_(locations) {}

  /// Returns the child message in the field `name` of this message. `index` is -1 if the field is
  /// not repeated.
  Field child(const std::string& name, int index = -1) const;
  /// Returns true if a singular field is present.
  bool has(const std::string& name) const;

  /// Returns INVALID_ARGUMENT: "cornell.textproto:12:3: shape[4].sphere.radius: <what>", with the
  /// position of the field or, if it is absent, of its message. `index` is -1 if the field is not
  /// repeated, or if the error is about the whole list.
  absl::Status error(const std::string& name, absl::string_view what, int index = -1) const;
  /// Returns INVALID_ARGUMENT with the position and the path of this message itself.
  absl::Status error(absl::string_view what) const;

  /// Returns the path of the field `name` in the file: "shape[4].sphere.radius".
  std::string path(const std::string& name, int index = -1) const;

 private:
  struct At {
    int line = -1;  ///< counted from 0, as in protobuf
    int column = -1;
  };
  /// Returns the position of the field `name`. If the field is absent or its position is unknown,
  /// returns that of this message.
  At at(const std::string& name, int index) const;
  absl::Status failure(const At& at, const std::string& path, absl::string_view what) const;

  const std::string* file_;
  const google::protobuf::Message* message_;
  const google::protobuf::TextFormat::ParseInfoTree* tree_;
  std::string path_;
  At at_;
};

}  // namespace bandsaw
