#pragma once

// Converts the shapes of Mitsuba scenes, with their materials and the media inside.

#include <map>
#include <set>
#include <string>

#include "absl/status/statusor.h"
#include "proto/scene.pb.h"
#include "renderlib/import/mitsuba/bsdfs.h"
#include "renderlib/import/mitsuba/conversion.h"
#include "renderlib/import/mitsuba/media.h"
#include "renderlib/import/mitsuba/meshes.h"

namespace bandsaw::mitsuba {

class ShapeReader {
 public:
  /// Shapes, groups and materials are added to `scene`. All arguments MUST outlive this object.
  ShapeReader(scene::Scene& scene, Conversion& to)
      : scene_(scene), to_(to), materials_(scene, to), media_(scene, to), meshes_(to) {}

  /// Adds a shape of the scene. A shapegroup is added when an instance places it.
  absl::Status add(const Object& shape);

 private:
  /// The destination of shapes: the scene, or a group.
  struct Target {
    google::protobuf::RepeatedPtrField<scene::Shape>* shapes;
    google::protobuf::RepeatedPtrField<scene::Model>* models;
    google::protobuf::RepeatedPtrField<scene::Instance>* instances;
  };
  /// The properties that all kinds of shapes have.
  struct Surface {
    const Object* bsdf = nullptr;      ///< nullptr: Mitsuba's default
    const Object* emitter = nullptr;   ///< of type area; nullptr: the shape does not emit
    const Object* interior = nullptr;  ///< the medium inside; nullptr: none
    Transform to_world;
    bool flip_normals = false;
  };

  /// Adds a shape. Leaves it out with a warning if its type is not known or its file is missing.
  /// Adds nothing for a shapegroup, which group_of() adds.
  absl::Status add_to(const Object& shape, const Target& target);
  /// Adds a shape of any type except shapegroup, merge and instance.
  absl::Status add_kind(const Parameters& from, const Surface& surface, const Target& target);
  /// Reads the properties that all kinds of shapes have.
  absl::StatusOr<Surface> surface_of(const Parameters& from);
  absl::Status add_mesh(const Parameters& from, const Surface& surface, const Target& target);
  /// Makes a file of a computed mesh, such as a cylinder, and adds it as a model.
  absl::Status add_made_mesh(const Parameters& from, const Surface& surface, SourceMesh mesh,
                             const Target& target);
  absl::Status add_rectangle(const Parameters& from, const Surface& surface, const Target& target);
  absl::Status add_disk(const Parameters& from, const Surface& surface, const Target& target);
  absl::Status add_sphere(const Parameters& from, const Surface& surface, const Target& target);
  absl::Status add_cylinder(const Parameters& from, const Surface& surface, const Target& target);
  absl::Status add_instance(const Parameters& from, const Target& target);
  /// Makes a group of the sphere or disk `shape`, and adds an instance of the group with the
  /// placement `to_world`. Used if the transform changes the form of the shape, or if the uvs of a
  /// sphere are needed.
  absl::Status add_placed(const scene::Shape& shape, const Transform& to_world,
                          const Target& target);
  /// Adds the mesh file `file` as a model. Returns INVALID_ARGUMENT, with file and line, if the
  /// shape has neither a material nor a medium.
  absl::Status add_model(const Parameters& from, const Surface& surface, const std::string& file,
                         const std::string& material, const Target& target);
  /// Returns the name of the group that a shapegroup becomes. The group is made when it is first
  /// used. The name is empty if all shapes of the group are left out.
  absl::StatusOr<std::string> group_of(const Object& group);
  /// For a shape that is not closed: warns if `surface` has a medium inside.
  void warn_of_interior(const Surface& surface, const Parameters& from);

  scene::Scene& scene_;
  Conversion& to_;
  Materials materials_;
  Media media_;
  Meshes meshes_;
  std::map<const Object*, std::string> groups_;
  std::set<std::string> group_names_;
};

/// Appends the 12 numbers of a placement, rows first.
void set_matrix(const Transform& t, google::protobuf::RepeatedField<double>* to);

}  // namespace bandsaw::mitsuba
