// Evaluates the tracks of a scene file. A track changes a number of the scene over time.
// find_target() follows the path of a track from message to message by protobuf reflection. Then
// scene_at() evaluates the curve of the track at the given time and sets the field.

#include "renderlib/import/scene_file/tracks.h"

#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>

#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/strip.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/camera/camera.h"
#include "renderlib/import/animation/curve.h"
#include "renderlib/import/scene_file/numbers.h"

namespace bandsaw {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::Reflection;

/// A number or a list of numbers in a message.
struct Target {
  Message* message = nullptr;
  const FieldDescriptor* field = nullptr;
};

/// One step of a path, such as `light[0]` or `material["lamp"]`.
struct PathStep {
  std::string name;                  ///< of a field
  std::optional<std::string> entry;  ///< text in brackets: a number, or a name with its quotes
};

/// Splits a path at the dots that are outside of quotes.
std::vector<std::string> split_path(const std::string& path) {
  std::vector<std::string> steps(1);
  bool quoted = false;
  for (const char c : path) {
    quoted = c == '"' ? !quoted : quoted;
    if (c == '.' && !quoted) {
      steps.emplace_back();
    } else {
      steps.back() += c;
    }
  }
  return steps;
}

/// Parses one step of a path. A text that does not end with `]` has no entry.
PathStep step_of(absl::string_view text) {
  const std::size_t bracket = text.find('[');
  if (bracket == absl::string_view::npos || text.back() != ']') {
    return {std::string(text), std::nullopt};
  }
  return {std::string(text.substr(0, bracket)),
          std::string(text.substr(bracket + 1, text.size() - bracket - 2))};
}

/// Returns the name of an entry of a list; "" if entries of this kind have no names.
std::string name_of_entry(const Message& entry) {
  const FieldDescriptor* name = entry.GetDescriptor()->FindFieldByName("name");
  return name != nullptr && name->cpp_type() == FieldDescriptor::CPPTYPE_STRING
             ? entry.GetReflection()->GetString(entry, name)
             : "";
}

/// Returns an entry of the repeated field `list` of `in`. `entry` is the number of the entry, such
/// as `3`, or its name in quotes, such as `"lamp"`. Returns nullptr if there is no such entry.
Message* entry_of(Message& in, const FieldDescriptor& list, const std::string& entry) {
  const Reflection& reflection = *in.GetReflection();
  const int size = reflection.FieldSize(in, &list);
  int number = 0;
  if (absl::SimpleAtoi(entry, &number)) {
    return number >= 0 && number < size ? reflection.MutableRepeatedMessage(&in, &list, number)
                                        : nullptr;
  }
  absl::string_view name = entry;
  if (!absl::ConsumePrefix(&name, "\"") || !absl::ConsumeSuffix(&name, "\"")) {
    return nullptr;
  }
  for (int i = 0; i < size; ++i) {
    if (name_of_entry(reflection.GetRepeatedMessage(in, &list, i)) == name) {
      return reflection.MutableRepeatedMessage(&in, &list, i);
    }
  }
  return nullptr;
}

bool is_number(const FieldDescriptor& field) {
  return field.cpp_type() == FieldDescriptor::CPPTYPE_DOUBLE ||
         field.cpp_type() == FieldDescriptor::CPPTYPE_FLOAT;
}

/// Returns the message to which `step` leads from `in`. `field` is the field that the step names.
/// Returns nullptr if the scene has no such message.
Message* follow(Message& in, const PathStep& step, const FieldDescriptor& field) {
  if (field.cpp_type() != FieldDescriptor::CPPTYPE_MESSAGE) {
    return nullptr;
  }
  if (field.is_repeated()) {
    return step.entry ? entry_of(in, field, *step.entry) : nullptr;
  }
  const Reflection& reflection = *in.GetReflection();
  return !step.entry && reflection.HasField(in, &field) ? reflection.MutableMessage(&in, &field)
                                                        : nullptr;
}

/// Returns the field to which the path `path` of a track leads. Returns INVALID_ARGUMENT, with the
/// place of `track` in the file, if there is no such field or if the field cannot change over time.
absl::StatusOr<Target> find_target(const Field& track, const std::string& path,
                                   scene::Scene& scene) {
  Target at{&scene, nullptr};
  const std::vector<std::string> steps = split_path(path);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const PathStep step = step_of(steps[i]);
    at.field = at.message->GetDescriptor()->FindFieldByName(step.name);
    if (at.field == nullptr || step.name == "track" || step.name == "fps") {
      return track.error("field", absl::StrCat("\"", path, "\": there is no field \"", step.name,
                                               "\" that a track could change"));
    }
    if (i + 1 == steps.size()) {
      break;
    }
    Message* next = follow(*at.message, step, *at.field);
    if (next == nullptr) {
      return track.error("field", absl::StrCat("\"", path, "\": the scene has no ", steps[i],
                                               "; an entry of a list is named by its number from "
                                               "0, or by its name in quotes"));
    }
    at.message = next;
  }
  const bool is_time = at.field->name() == "shutter_open" || at.field->name() == "shutter_close";
  if (!is_number(*at.field) || step_of(steps.back()).entry || is_time) {
    return track.error("field", absl::StrCat("\"", path,
                                             "\": must be a number or a list of numbers that may "
                                             "change over time"));
  }
  return at;
}

absl::StatusOr<Interpolation> interpolation_of(const Field& in, const scene::Track& track) {
  switch (track.interpolation()) {
    case scene::Track::INTERPOLATION_LINEAR:
      return Interpolation::kLinear;
    case scene::Track::INTERPOLATION_STEP:
      return Interpolation::kStep;
    case scene::Track::INTERPOLATION_SMOOTH:
      return Interpolation::kSmooth;
    default:
      return in.error("interpolation",
                      absl::StrCat("has the unknown value ", track.interpolation()));
  }
}

/// Returns the curve through the keys of a track. Returns INVALID_ARGUMENT if there are no keys, if
/// their times do not increase, if a value is not finite, or if the keys do not all have the same
/// number of values.
absl::StatusOr<Curve> read_curve(const Field& in, const scene::Track& track) {
  ASSIGN_OR_RETURN(const Interpolation interpolation, interpolation_of(in, track));
  if (track.key_size() == 0) {
    return in.error("key", "is required: a time and a value");
  }
  std::vector<double> times;
  std::vector<double> values;
  const int width = track.key(0).value_size();  // numbers of each key
  for (int i = 0; i < track.key_size(); ++i) {
    const scene::TrackKey& key = track.key(i);
    const Field at = in.child("key", i);
    RETURN_IF_ERROR(check_range(at, "time", key.time(), -kMaxTime, kMaxTime));
    if (!times.empty() && !(key.time() > times.back())) {
      return at.error("time", absl::StrCat("must be after ", times.back(),
                                           ", the time of the key before; it is ", key.time()));
    }
    if (key.value_size() != width || width == 0) {
      return at.error(
          "value",
          absl::StrCat("must have at least one number, and as many as the first key, which has ",
                       width, "; has ", key.value_size()));
    }
    for (const double value : key.value()) {
      if (!std::isfinite(value)) {
        return at.error("value", absl::StrCat("must be finite, is ", value));
      }
      values.push_back(value);
    }
    times.push_back(key.time());
  }
  return Curve(std::move(times), std::move(values), static_cast<std::size_t>(width), interpolation);
}

/// Writes the values of a track into a field: all of them if the field is a list, otherwise the
/// only one.
void set(const Target& to, const std::vector<double>& values) {
  const Reflection& reflection = *to.message->GetReflection();
  const bool is_double = to.field->cpp_type() == FieldDescriptor::CPPTYPE_DOUBLE;
  if (!to.field->is_repeated()) {
    is_double ? reflection.SetDouble(to.message, to.field, values[0])
              : reflection.SetFloat(to.message, to.field, static_cast<float>(values[0]));
    return;
  }
  reflection.ClearField(to.message, to.field);
  for (const double value : values) {
    is_double ? reflection.AddDouble(to.message, to.field, value)
              : reflection.AddFloat(to.message, to.field, static_cast<float>(value));
  }
}

}  // namespace

absl::StatusOr<scene::Scene> scene_at(const Field& root, const scene::Scene& from, double time) {
  scene::Scene scene = from;
  for (int i = 0; i < from.track_size(); ++i) {
    const Field in = root.child("track", i);
    if (from.track(i).field().empty()) {
      return in.error("field",
                      "is required: the path of a number, for example \"camera.position\"");
    }
    ASSIGN_OR_RETURN(const Target target, find_target(in, from.track(i).field(), scene));
    ASSIGN_OR_RETURN(const Curve curve, read_curve(in, from.track(i)));
    if (!target.field->is_repeated() && curve.width() != 1) {
      return in.child("key", 0).error(
          "value", absl::StrCat("must be one number for \"", from.track(i).field(), "\", has ",
                                curve.width()));
    }
    set(target, curve.at(time));
  }
  return scene;
}

bool moves_camera(const scene::Scene& from) {
  for (const scene::Track& track : from.track()) {
    if (split_path(track.field()).front() == "camera") {
      return true;
    }
  }
  return false;
}

}  // namespace bandsaw
