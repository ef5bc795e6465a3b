// Encodes and decodes instances and the frames in which they are placed. A frame is a coordinate
// system that may move: each of its keys is a time and the transform at this time. Transforms are
// encoded as lists of 12 numbers.

#include "renderlib/package/placements.h"

#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/package/manifest.h"

namespace bandsaw {
namespace {

using Doubles = google::protobuf::RepeatedField<double>;

constexpr int kNumbers = 12;  // numbers of a transform

void add(const Transform& transform, Doubles& to) {
  for (const auto& row : transform.m) {
    to.Add(row.begin(), row.end());
  }
}

Transform transform_at(const Doubles& list, int first) {
  Transform transform;
  for (int i = 0; i < kNumbers; ++i) {
    transform.m[i / 4][i % 4] = list[first + i];
  }
  return transform;
}

absl::StatusOr<Transform> decode_transform(const Doubles& list, const std::string& field) {
  if (list.size() != kNumbers) {
    return manifest_error(field, absl::StrCat("must have 12 numbers, has ", list.size()));
  }
  return transform_at(list, 0);
}

absl::StatusOr<Frame> decode_frame(const package::Frame& from, const std::string& field) {
  Frame frame;
  frame.parent = from.has_parent() ? FrameId{from.parent()} : kNoFrame;
  ASSIGN_OR_RETURN(frame.placement, decode_transform(from.placement(), field + ".placement"));
  if (from.at_size() != from.times_size() * kNumbers) {
    return manifest_error(field + ".at",
                          absl::StrCat("must have 12 numbers for each of ", from.times_size(),
                                       " times, has ", from.at_size()));
  }
  for (int i = 0; i < from.times_size(); ++i) {
    frame.keys.emplace_back(from.times(i), transform_at(from.at(), i * kNumbers));
  }
  return frame;
}

}  // namespace

void encode_placements(const Geometry& geometry, Frames& frames, Instances& instances) {
  for (const Frame& frame : geometry.frames) {
    package::Frame& to = *frames.Add();
    if (frame.parent != kNoFrame) {
      to.set_parent(static_cast<std::uint32_t>(frame.parent));
    }
    add(frame.placement, *to.mutable_placement());
    for (const Key& key : frame.keys) {
      to.add_times(key.time);
      add(key.at, *to.mutable_at());
    }
  }
  for (const Instance& instance : geometry.instances) {
    package::Instance& to = *instances.Add();
    to.set_mesh(static_cast<std::uint32_t>(instance.mesh));
    to.set_material(static_cast<std::uint32_t>(instance.material));
    add(instance.to_world, *to.mutable_transform());
    if (instance.group != kNoGroup) {
      to.set_group(static_cast<std::uint32_t>(instance.group));
    }
    if (instance.frame != kNoFrame) {
      to.set_frame(static_cast<std::uint32_t>(instance.frame));
    }
  }
}

absl::Status decode_placements(const Frames& frames, const Instances& instances,
                               const std::string& prefix, Geometry& geometry) {
  for (int i = 0; i < frames.size(); ++i) {
    ASSIGN_OR_RETURN(Frame frame, decode_frame(frames[i], absl::StrCat(prefix, "frame[", i, "]")));
    geometry.frames.push_back(std::move(frame));
  }
  for (int i = 0; i < instances.size(); ++i) {
    const package::Instance& from = instances[i];
    ASSIGN_OR_RETURN(
        const Transform to_world,
        decode_transform(from.transform(), absl::StrCat(prefix, "instance[", i, "].transform")));
    geometry.instances.push_back({MeshId{from.mesh()}, MaterialId{from.material()}, to_world,
                                  from.has_group() ? GroupId{from.group()} : kNoGroup,
                                  from.has_frame() ? FrameId{from.frame()} : kNoFrame});
  }
  return absl::OkStatus();
}

}  // namespace bandsaw
