// Makes the summary of `bandsaw info` (scene_summary.h): counts the parts of a scene by kind, and
// computes its bounds and its size in memory.

#include "coordinator/cli/scene/scene_summary.h"

#include <algorithm>
#include <vector>

#include "absl/strings/str_cat.h"
#include "renderlib/base/overloaded.h"
#include "renderlib/geometry/box.h"
#include "renderlib/geometry/disk.h"
#include "renderlib/geometry/placement.h"
#include "renderlib/light/emission.h"
#include "renderlib/scene/description.h"

namespace bandsaw::coordinator {
namespace {

/// Extends `bounds` by the eight corners of `box`, transformed.
void add_box(Box& bounds, const Box& box, const Transform& to_world) {
  if (box.empty()) {
    return;
  }
  for (int corner = 0; corner < 8; ++corner) {
    bounds.add(to_world.point({(corner & 1) != 0 ? box.hi.x : box.lo.x,
                               (corner & 2) != 0 ? box.hi.y : box.lo.y,
                               (corner & 4) != 0 ? box.hi.z : box.lo.z}));
  }
}

Box box_of(const Shapes& shapes) {
  Box box;
  for (const Sphere& s : shapes.spheres) {
    const Vec3 r{s.radius, s.radius, s.radius};
    box.add(s.center - r);
    box.add(s.center + r);
  }
  const auto add_all = [&box](const auto& list) {
    for (const auto& shape : list) {
      add_box(box, bounds(shape), /*to_world=*/{});
    }
  };
  add_all(shapes.quads);
  add_all(shapes.triangles);
  add_all(shapes.disks);
  return box;
}

Box box_of(const Mesh& mesh) {
  Box box;
  for (const auto* positions : {&mesh.positions, &mesh.positions_at_close}) {
    for (const auto& p : *positions) {
      box.add({p[0], p[1], p[2]});
    }
  }
  return box;
}

template <class List>
std::vector<Box> boxes_of(const List& list) {
  std::vector<Box> boxes;
  for (const auto& entry : list) {
    boxes.push_back(box_of(entry));
  }
  return boxes;
}

/// Returns a bounding box of all geometry in world space. Moving objects are bounded only at the
/// times when the shutter opens and closes. Instances are bounded by the transformed boxes of their
/// meshes or groups.
Box bounds_of(const SceneDescription& scene) {
  const Geometry& geometry = scene.geometry;
  const Shutter& shutter = shutter_of(scene.camera);
  const std::vector<Box> meshes = boxes_of(geometry.meshes);
  const std::vector<Box> groups = boxes_of(geometry.groups);
  Box all = box_of(static_cast<const Shapes&>(geometry));
  for (const Instance& instance : geometry.instances) {
    const Box& box = instance.group == kNoGroup ? meshes[index_of(instance.mesh)]
                                                : groups[index_of(instance.group)];
    add_box(all, box, to_world_at(geometry, instance, shutter.open));
    add_box(all, box, to_world_at(geometry, instance, shutter.close));
  }
  return all;
}

/// Counts by name, in the order of first occurrence.
class Tally {
 public:
  void add(const std::string& what, std::uint64_t count = 1) {
    const auto same = [&](const Count& c) { return c.what == what; };
    const auto found = std::find_if(counts_.begin(), counts_.end(), same);
    if (found != counts_.end()) {
      found->count += count;
    } else if (count > 0) {
      counts_.push_back({what, count});
    }
  }
  std::vector<Count> take() { return std::move(counts_); }

 private:
  std::vector<Count> counts_;
};

std::string text(const Vec3& v) { return absl::StrCat("[", v.x, ", ", v.y, ", ", v.z, "]"); }

/// Returns, for example, "perspective, 40° high, at [0, 0, 5], looking at [0, 0, 0]".
std::string camera_text(const Camera& camera) {
  const View view = view_of(camera);
  const std::string place =
      absl::StrCat(" at ", text(view.position), ", looking at ", text(view.look_at));
  if (const auto* flat = std::get_if<OrthographicCamera>(&camera)) {
    return absl::StrCat("orthographic, ", flat->height, " high,", place);
  }
  const auto& perspective = std::get<PerspectiveCamera>(camera);
  const std::string lens = perspective.aperture > 0
                               ? absl::StrCat(", lens of diameter ", perspective.aperture,
                                              ", sharp at distance ", perspective.focus_distance)
                               : "";
  return absl::StrCat("perspective, ", perspective.vertical_fov, "° high", lens, ",", place);
}

std::string filter_text(const PixelFilter& filter) {
  constexpr const char* kNames[] = {"box", "tent", "Gaussian"};
  return absl::StrCat(kNames[static_cast<int>(filter.kind)], " of radius ", filter.radius);
}

std::string kind_of(const Material& material) {
  return std::visit(
      Overloaded{[](const Diffuse&) { return "diffuse"; }, [](const Metal&) { return "metal"; },
                 [](const Dielectric&) { return "dielectric"; },
                 [](const Emissive&) { return "emissive"; },
                 [](const MetallicRoughness&) { return "glTF"; },
                 [](const Plastic&) { return "plastic"; },
                 [](const Conductor&) { return "conductor"; },
                 [](const ThinDielectric&) { return "thin dielectric"; },
                 [](const DiffuseTransmission&) { return "diffuse transmission"; },
                 [](const Principled&) { return "principled"; },
                 [](const ThinPrincipled&) { return "thin principled"; },
                 [](const Mix&) { return "mixture"; }},
      material.kind);
}

std::string kind_of(const Texture& texture) {
  const auto* image = std::get_if<ImageTexture>(&texture);
  if (std::holds_alternative<ConstantTexture>(texture)) {
    return "colour";
  }
  if (image == nullptr) {
    return "computed texture";
  }
  const bool floats = image->format == ImageTexture::Format::kFloat32;
  return absl::StrCat(floats ? "float" : "8-bit", " image of ", image->width, "×", image->height);
}

std::string kind_of(const DeltaLight& light) {
  constexpr const char* kNames[] = {"directional", "point", "spot", "projector"};
  return kNames[light.index()];
}

std::string kind_of(const Medium& medium) {
  return is_clear(medium)              ? "clear medium"
         : medium.grids.any()          ? "medium that varies in space"
         : !is_black(medium.emission)  ? "glowing medium"
         : is_black(medium.scattering) ? "absorbing medium"
         : medium.g == 0               ? "scattering medium"
                                       : "medium that scatters by Henyey and Greenstein";
}

std::string background_text(const SceneDescription& scene) {
  const Background& sky = scene.background;
  if (!sky.environment) {
    return !(sky.bottom == sky.top) ? "gradient" : is_black(sky.top) ? "black" : "constant";
  }
  const Texture& first = scene.textures[index_of(sky.environment->images.front())];
  const auto& image = std::get<ImageTexture>(first);
  return absl::StrCat(sky.environment->images.size() == 1 ? "equirectangular image" : "cube map",
                      " of ", image.width, "×", image.height);
}

std::vector<Count> media_of(const Media& media) {
  Tally tally;
  for (const Medium& medium : media.media) {
    tally.add(kind_of(medium));
  }
  tally.add("grid", media.grids.size());
  tally.add("boundary", media.boundaries.spheres.size() + media.boundaries.instances.size());
  tally.add("fog around everything", media.fog ? 1 : 0);
  return tally.take();
}

std::uint64_t bytes_of(const Texture& texture) {
  const auto* image = std::get_if<ImageTexture>(&texture);
  return image == nullptr ? 0 : image->texels.size();
}

template <class T>
std::uint64_t bytes_in(const std::vector<T>& list) {
  return std::uint64_t{list.size()} * sizeof(T);
}

std::uint64_t bytes_of(const Shapes& shapes) {
  return bytes_in(shapes.spheres) + bytes_in(shapes.quads) + bytes_in(shapes.triangles) +
         bytes_in(shapes.disks);
}

std::uint64_t bytes_in(const Geometry& geometry) {
  std::uint64_t sum = bytes_of(static_cast<const Shapes&>(geometry)) + bytes_in(geometry.instances);
  for (const Shapes& group : geometry.groups) {
    sum += bytes_of(group);
  }
  for (const Mesh& mesh : geometry.meshes) {
    sum += bytes_in(mesh.positions) + bytes_in(mesh.triangles) + bytes_in(mesh.normals) +
           bytes_in(mesh.uvs) + bytes_in(mesh.uvs2) + bytes_in(mesh.colors) +
           bytes_in(mesh.positions_at_close) + bytes_in(mesh.normals_at_close);
  }
  return sum;
}

/// Counts emissive primitives of meshes and groups once per placement.
std::uint64_t lights_in(const SceneDescription& scene) {
  const auto emits = [&](MaterialId id) { return bandsaw::emits(scene.materials, id); };
  const Geometry& g = scene.geometry;
  std::uint64_t lights = 0;
  for (std::size_t i = 0; i < g.size(); ++i) {
    lights += emits(material_of(static_cast<const Shapes&>(g), i)) ? 1 : 0;
  }
  for (const Instance& instance : g.instances) {
    for (std::size_t i = 0; i < primitives_of(g, instance); ++i) {
      lights += emits(material_of(g, instance, i)) ? 1 : 0;
    }
  }
  return lights;
}

/// Counts triangles of meshes and groups once per placement.
std::uint64_t triangles_in(const Geometry& g) {
  std::uint64_t triangles = g.triangles.size();
  for (const Instance& instance : g.instances) {
    const Shapes* group = group_of(g, instance);
    triangles += group != nullptr ? group->triangles.size() : primitives_of(g, instance);
  }
  return triangles;
}

}  // namespace

SceneSummary summary_of(const SceneDescription& scene, const PackageInfo& info,
                        std::uint64_t package_bytes) {
  const Geometry& g = scene.geometry;
  SceneSummary summary;
  summary.info = info;
  summary.camera = camera_text(scene.camera);
  summary.filter = filter_text(scene.filter);
  Tally shapes;
  shapes.add("sphere", g.spheres.size());
  shapes.add("quad", g.quads.size());
  shapes.add("triangle", g.triangles.size());
  shapes.add("disk", g.disks.size());
  shapes.add("mesh", g.meshes.size());
  shapes.add("group", g.groups.size());
  shapes.add("instance", g.instances.size());
  summary.shapes = shapes.take();
  summary.triangles = triangles_in(g);
  Tally materials;
  for (const Material& material : scene.materials) {
    materials.add(kind_of(material));
  }
  summary.materials = materials.take();
  Tally textures;
  for (const Texture& texture : scene.textures) {
    textures.add(kind_of(texture));
    summary.texture_bytes += bytes_of(texture);
  }
  summary.textures = textures.take();
  summary.lights = lights_in(scene);
  Tally lights;
  for (const DeltaLight& light : scene.lights) {
    lights.add(kind_of(light));
  }
  summary.lights_without_size = lights.take();
  summary.background = background_text(scene);
  summary.media = media_of(scene.media);
  summary.geometry_bytes = bytes_in(g);
  summary.bounds = bounds_of(scene);
  summary.package_bytes = package_bytes;
  return summary;
}

}  // namespace bandsaw::coordinator
