#include "renderlib/package/placements.h"

#include <cmath>
#include <optional>

#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/camera/camera.h"
#include "renderlib/package/manifest.h"

namespace bandsaw {
namespace {

using Doubles = google::protobuf::RepeatedField<double>;

constexpr int kNumbers = 12;  // of a transform

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

absl::Status check_regular(const Transform& transform, const std::string& field) {
  return inverse(transform)
             ? absl::OkStatus()
             : manifest_error(field,
                              "must be finite and regular: it flattens what it places or is not a "
                              "number");
}

absl::Status check_below(std::uint32_t index, std::size_t count, const std::string& field,
                         const char* what) {
  return index < count
             ? absl::OkStatus()
             : manifest_error(field, absl::StrCat("is ", index, ", there are ", count, " ", what));
}

absl::Status check_keys(const Frame& frame, const std::string& field) {
  if (frame.keys.empty()) {
    return manifest_error(field + ".times", "must be one at least");
  }
  for (std::size_t i = 0; i < frame.keys.size(); ++i) {
    const Key& key = frame.keys[i];
    if (!(std::abs(key.time) <= kMaxTime) || (i > 0 && !(key.time > frame.keys[i - 1].time))) {
      return manifest_error(absl::StrCat(field, ".times[", i, "]"),
                            absl::StrCat("must rise and lie in [-1e9, 1e9], is ", key.time));
    }
    RETURN_IF_ERROR(check_regular(key.at, absl::StrCat(field, ".at[", i, "]")));
    if (!decompose(key.at)) {
      return manifest_error(absl::StrCat(field, ".at[", i, "]"),
                            "must be a scale, then a rotation, then a translation: it shears");
    }
  }
  return absl::OkStatus();
}

absl::Status check_instance(const Instance& instance, const Geometry& geometry,
                            std::size_t materials, const std::string& field) {
  const bool places_group = instance.group != kNoGroup;
  RETURN_IF_ERROR(places_group ? check_below(static_cast<std::uint32_t>(instance.group),
                                             geometry.groups.size(), field + ".group", "groups")
                               : check_below(static_cast<std::uint32_t>(instance.mesh),
                                             geometry.meshes.size(), field + ".mesh", "meshes"));
  if (!places_group || instance.material != kOwnMaterial) {
    RETURN_IF_ERROR(check_below(static_cast<std::uint32_t>(instance.material), materials,
                                field + ".material", "materials"));
  }
  if (instance.frame != kNoFrame) {
    RETURN_IF_ERROR(check_below(static_cast<std::uint32_t>(instance.frame), geometry.frames.size(),
                                field + ".frame", "frames"));
  }
  return check_regular(instance.to_world, field + ".transform");
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

absl::Status check_placements(const Geometry& geometry, std::size_t materials) {
  for (std::size_t i = 0; i < geometry.frames.size(); ++i) {
    const Frame& frame = geometry.frames[i];
    const std::string field = absl::StrCat("frame[", i, "]");
    if (frame.parent != kNoFrame && index_of(frame.parent) >= i) {
      return manifest_error(field + ".parent",
                            absl::StrCat("must be below ", i, ", is ", index_of(frame.parent)));
    }
    RETURN_IF_ERROR(check_regular(frame.placement, field + ".placement"));
    RETURN_IF_ERROR(check_keys(frame, field));
  }
  for (std::size_t i = 0; i < geometry.instances.size(); ++i) {
    RETURN_IF_ERROR(check_instance(geometry.instances[i], geometry, materials,
                                   absl::StrCat("instance[", i, "]")));
  }
  return absl::OkStatus();
}

}  // namespace bandsaw
