// Encodes a scene. The class Encoder stores each list of numbers as a blob (bytes that are named by
// their digest), and writes the blob's size and digest into the manifest.

#include "renderlib/package/package.h"

#include <algorithm>
#include <functional>
#include <utility>

#include "proto/package.pb.h"
#include "proto/wire/limits.h"
#include "proto/wire/versions.h"
#include "renderlib/base/clean_text.h"
#include "renderlib/package/arrays.h"
#include "renderlib/package/blob_source.h"
#include "renderlib/package/lights.h"
#include "renderlib/package/limits.h"
#include "renderlib/package/material_parts.h"
#include "renderlib/package/materials.h"
#include "renderlib/package/media.h"
#include "renderlib/package/placements.h"
#include "renderlib/texture/texture.h"

namespace bandsaw {
namespace {

std::uint32_t number(TextureId id) { return static_cast<std::uint32_t>(id); }

/// Converts an enum to one of the protocol. Both are declared in the same order; `first` is 1 if
/// the protocol's enum has an additional 0 for "unspecified".
template <class Theirs, class Ours>
Theirs as(Ours ours, int first = 0) {
  return static_cast<Theirs>(static_cast<int>(ours) + first);
}

/// Sets `ref` to the size and digest of the bytes, and adds the bytes to `blobs`. `parts` remembers
/// the last package (encoded_parts.h). Bytes that were in it are not added. `parts` may be nullptr.
void put_shared(const SharedBytes& bytes, BlobMap& blobs, EncodedParts* parts, package::Blob& ref) {
  ref.set_size(bytes.size());
  if (const wire::Digest* known = parts != nullptr ? parts->digest_of(bytes) : nullptr) {
    ref.set_sha256(known->raw());
    return;
  }
  const wire::Digest digest = blobs.put(bytes);
  ref.set_sha256(digest.raw());
  if (parts != nullptr && !bytes.empty()) {
    parts->add(bytes, digest);
  }
}

/// Encodes a texture into `to`; called by std::visit.
struct EncodeTexture {
  BlobMap& blobs;
  EncodedParts* parts;
  package::Texture& to;

  void operator()(const ConstantTexture& t) const { encode(t.value, *to.mutable_constant()); }

  void operator()(const ImageTexture& t) const {
    using Proto = package::ImageTexture;
    auto& image = *to.mutable_image();
    image.set_width(t.width);
    image.set_height(t.height);
    image.set_format(as<Proto::Format>(t.format, 1));
    image.set_wrap(as<Proto::Wrap>(t.wrap, 1));
    if (t.wrap_v) {
      image.set_wrap_v(as<Proto::Wrap>(*t.wrap_v, 1));
    }
    image.set_filter(as<Proto::Filter>(t.filter, 1));
    image.set_channels(t.channels);
    image.set_uv_set(as<package::UvSet>(t.uv_set));
    if (!(t.uv_transform == UvTransform{})) {
      image.mutable_uv_transform()->Add(t.uv_transform.m.begin(), t.uv_transform.m.end());
    }
    put_shared(t.texels, blobs, parts, *image.mutable_texels());
  }

  void operator()(const CheckerTexture& t) const {
    auto& checker = *to.mutable_checker();
    checker.set_even(number(t.even));
    checker.set_odd(number(t.odd));
    checker.set_mapping(as<package::CheckerTexture::Mapping>(t.mapping));
    for (const double size : {t.size.x, t.size.y, t.size.z}) {
      checker.add_size(size);
    }
    checker.set_uv_set(as<package::UvSet>(t.uv_set));
    checker.set_space(as<package::Space>(t.space));
  }

  void operator()(const NoiseTexture& t) const {
    auto& noise = *to.mutable_noise();
    noise.set_kind(as<package::NoiseTexture::Kind>(t.kind));
    noise.set_space(as<package::Space>(t.space));
    noise.set_octaves(t.octaves);
    noise.set_scale(t.scale);
    noise.set_strength(t.strength);
    noise.set_turbulence_scale(t.turbulence_scale);
    for (const double entry : {t.axis.x, t.axis.y, t.axis.z}) {
      noise.add_axis(entry);
    }
    encode(t.low, *noise.mutable_low());
    encode(t.high, *noise.mutable_high());
  }

  void operator()(const RampTexture& t) const {
    auto& ramp = *to.mutable_ramp();
    ramp.set_over(as<package::RampTexture::Over>(t.over));
    ramp.set_texture(number(t.texture));
    ramp.set_uv_set(as<package::UvSet>(t.uv_set));
    ramp.set_space(as<package::Space>(t.space));
    ramp.set_steps(t.steps);
    for (const RampTexture::Stop& stop : t.stops) {
      ramp.add_at(stop.at);
      for (const float channel : {stop.color.r, stop.color.g, stop.color.b}) {
        ramp.add_color(channel);
      }
    }
  }

  void operator()(const MixTexture& t) const {
    to.mutable_mix()->set_a(number(t.a));
    to.mutable_mix()->set_b(number(t.b));
    to.mutable_mix()->set_amount(number(t.amount));
  }

  void operator()(const ProductTexture& t) const {
    to.mutable_product()->set_a(number(t.a));
    to.mutable_product()->set_b(number(t.b));
  }
};

/// Encodes a texture. Its texels are added to `blobs` without being copied.
void encode_texture(const Texture& texture, BlobMap& blobs, EncodedParts* parts,
                    package::Texture& to) {
  std::visit(EncodeTexture{blobs, parts, to}, texture);
}

/// Adds arrays to the blobs and refers to them in messages of the manifest.
class Encoder {
 public:
  Encoder(BlobMap& blobs, EncodedParts* parts) : blobs_(blobs), parts_(parts) {}

  // Adds the bytes as a blob, and sets `ref` to their size and digest.
  void put(SharedBytes bytes, package::Blob& ref) {
    ref.set_size(bytes.size());
    ref.set_sha256(blobs_.put(std::move(bytes)).raw());
  }

  void put_shared(const SharedBytes& bytes, package::Blob& ref) {
    bandsaw::put_shared(bytes, blobs_, parts_, ref);
  }

  // Adds a blob with one entry of type `Value` for each shape. The entry is `of(shape)`, or the
  // member of the shape to which `of` points.
  template <class Value, class Shape, class Of>
  void put_each(const std::vector<Shape>& shapes, package::Blob& ref, Of of) {
    std::vector<Value> values(shapes.size());
    std::transform(shapes.begin(), shapes.end(), values.begin(),
                   [&](const Shape& shape) { return std::invoke(of, shape); });
    put(to_bytes(values), ref);
  }

  void put_spheres(const std::vector<Sphere>& spheres, package::Spheres& to) {
    put_each<Vec3>(spheres, *to.mutable_centers(), &Sphere::center);
    put_each<double>(spheres, *to.mutable_radii(), &Sphere::radius);
    put_each<MaterialId>(spheres, *to.mutable_material(), &Sphere::material);
  }

  // Encodes shapes into the manifest or into a group.
  template <class Message>
  void put_shapes(const Shapes& geometry, Message& manifest) {
    if (!geometry.spheres.empty()) {
      put_spheres(geometry.spheres, *manifest.mutable_spheres());
    }
    if (!geometry.quads.empty()) {
      auto& to = *manifest.mutable_quads();
      put_each<Vec3>(geometry.quads, *to.mutable_corners(), &Quad::corner);
      put_each<Vec3>(geometry.quads, *to.mutable_u(), &Quad::u);
      put_each<Vec3>(geometry.quads, *to.mutable_v(), &Quad::v);
      put_each<MaterialId>(geometry.quads, *to.mutable_material(), &Quad::material);
    }
    if (!geometry.triangles.empty()) {
      auto& to = *manifest.mutable_triangles();
      put_each<std::array<Vec3, 3>>(geometry.triangles, *to.mutable_vertices(),
                                    [](const Triangle& t) {
                                      return std::array<Vec3, 3>{t.a, t.b, t.c};
                                    });
      put_each<MaterialId>(geometry.triangles, *to.mutable_material(), &Triangle::material);
    }
    if (!geometry.disks.empty()) {
      auto& to = *manifest.mutable_disks();
      put_each<Vec3>(geometry.disks, *to.mutable_centers(), &Disk::center);
      put_each<Vec3>(geometry.disks, *to.mutable_normals(), &Disk::normal);
      put_each<double>(geometry.disks, *to.mutable_radii(), &Disk::radius);
      put_each<MaterialId>(geometry.disks, *to.mutable_material(), &Disk::material);
    }
  }

  // Encodes a mesh. If `parts_` knows the mesh, its message is copied and no blobs are added.
  void put_mesh(const std::shared_ptr<const Mesh>& mesh, package::Mesh& to) {
    if (const std::string* known = parts_ != nullptr ? parts_->message_of(*mesh) : nullptr) {
      to.ParseFromString(*known);
      return;
    }
    put_arrays(*mesh, to);
    if (parts_ != nullptr) {
      parts_->add(mesh, to.SerializeAsString());
    }
  }

 private:
  void put_arrays(const Mesh& mesh, package::Mesh& to) {
    put(to_bytes(mesh.positions), *to.mutable_positions());
    put(to_bytes(mesh.triangles), *to.mutable_indices());
    if (!mesh.normals.empty()) {
      put(to_bytes(mesh.normals), *to.mutable_normals());
    }
    if (!mesh.uvs.empty()) {
      put(to_bytes(mesh.uvs), *to.mutable_uvs());
    }
    if (!mesh.uvs2.empty()) {
      put(to_bytes(mesh.uvs2), *to.mutable_uvs2());
    }
    if (!mesh.colors.empty()) {
      put(to_bytes(mesh.colors), *to.mutable_colors());
    }
    if (!mesh.positions_at_close.empty()) {
      put(to_bytes(mesh.positions_at_close), *to.mutable_positions_at_close());
    }
    if (!mesh.normals_at_close.empty()) {
      put(to_bytes(mesh.normals_at_close), *to.mutable_normals_at_close());
    }
  }

  BlobMap& blobs_;
  EncodedParts* const parts_;  ///< nullptr: none
};

template <class Field>
void add_vector(const Vec3& v, Field& field) {
  field.Add(v.x);
  field.Add(v.y);
  field.Add(v.z);
}

void encode(const Camera& camera, package::Camera& to) {
  const View view = view_of(camera);
  to.set_shutter_open(shutter_of(camera).open);
  to.set_shutter_close(shutter_of(camera).close);
  add_vector(view.position, *to.mutable_position());
  add_vector(view.look_at, *to.mutable_look_at());
  add_vector(view.up, *to.mutable_up());
  to.set_mirrored(is_mirrored(camera));
  if (const auto& window = window_of(camera)) {
    for (const double side : {window->left, window->right, window->bottom, window->top}) {
      to.add_window(side);
    }
  }
  if (const auto* perspective = std::get_if<PerspectiveCamera>(&camera)) {
    to.set_vertical_fov(perspective->vertical_fov);
    to.set_aperture(perspective->aperture);
    to.set_focus_distance(perspective->focus_distance);
  } else {
    const auto& orthographic = std::get<OrthographicCamera>(camera);
    to.set_orthographic_height(orthographic.height);
  }
}

void encode(const PixelFilter& filter, package::Manifest& manifest) {
  if (filter != PixelFilter{}) {
    // The enums are declared in the same order; the protocol's enum has an additional 0.
    const int kind = static_cast<int>(filter.kind) + 1;
    manifest.mutable_filter()->set_kind(static_cast<package::PixelFilter::Kind>(kind));
    manifest.mutable_filter()->set_radius(filter.radius);
  }
}

void encode(const Background& background, package::Background& to) {
  for (const auto& [colour, field] : {std::pair(background.bottom, to.mutable_bottom()),
                                      std::pair(background.top, to.mutable_top())}) {
    field->Add(colour.r);
    field->Add(colour.g);
    field->Add(colour.b);
  }
  if (background.environment) {
    encode_environment(*background.environment, *to.mutable_environment());
  }
}

void encode(const LocalShading& local, package::Manifest& manifest) {
  if (!is_black(local.ambient)) {
    for (const float channel : {local.ambient.r, local.ambient.g, local.ambient.b}) {
      manifest.mutable_ambient()->add_rgb(channel);
    }
  }
  if (local.occlusion_distance < kInfinity) {
    manifest.set_occlusion_distance(local.occlusion_distance);
  }
}

void encode(const Media& media, Encoder& encoder, package::Manifest& manifest) {
  encode_media(media, manifest);
  for (std::size_t i = 0; i < media.grids.size(); ++i) {
    package::VolumeGrid& to = *manifest.mutable_grid(static_cast<int>(i));
    encoder.put_shared(media.grids[i].index, *to.mutable_index());
    encoder.put_shared(media.grids[i].values, *to.mutable_values());
  }
  if (!media.boundaries.spheres.empty()) {
    encoder.put_spheres(media.boundaries.spheres,
                        *manifest.mutable_boundaries()->mutable_spheres());
  }
  for (std::size_t i = 0; i < media.boundaries.meshes.size(); ++i) {
    encoder.put_mesh(media.boundaries.meshes.shared(i), *manifest.mutable_boundaries()->add_mesh());
  }
  for (const Shapes& group : media.boundaries.groups) {
    encoder.put_shapes(group, *manifest.mutable_boundaries()->add_group());
  }
}

void encode(const PackageInfo& info, package::Manifest& manifest) {
  manifest.set_format(wire::kPackageFormat);
  manifest.set_name(clean_text(info.name, wire::kJobNameBytes));
  manifest.set_width(info.width);
  manifest.set_height(info.height);
  manifest.set_max_depth(info.max_depth);
  manifest.set_integrator(static_cast<std::uint32_t>(info.integrator));
  manifest.set_exposure(info.display.exposure);
  manifest.set_tone(static_cast<std::uint32_t>(info.display.tone));
  const std::size_t shown = std::min(info.warnings.size(), kMaxWarnings - 1);
  for (std::size_t i = 0; i < shown; ++i) {
    manifest.add_warning(clean_text(info.warnings[i], kMaxWarningBytes));
  }
  if (info.warnings.size() > shown) {
    manifest.add_warning("and " + std::to_string(info.warnings.size() - shown) + " more warnings");
  }
  for (std::size_t i = 0; i < std::min(info.model_cameras.size(), kMaxCameraNames); ++i) {
    manifest.add_model_camera(clean_text(info.model_cameras[i], kMaxCameraNameBytes));
  }
}

}  // namespace

std::string encode_package(const SceneDescription& scene, const PackageInfo& info, BlobMap& blobs,
                           EncodedParts* parts) {
  package::Manifest manifest;
  Encoder encoder(blobs, parts);
  encode(info, manifest);
  encode(scene.camera, *manifest.mutable_camera());
  if (scene.camera_at_close) {
    encode(*scene.camera_at_close, *manifest.mutable_camera_at_close());
  }
  encode(scene.filter, manifest);
  encode(scene.local_shading, manifest);
  encode(scene.background, *manifest.mutable_background());
  for (const DeltaLight& light : scene.lights) {
    encode_light(light, *manifest.add_light());
  }
  for (const Texture& texture : scene.textures) {
    encode_texture(texture, blobs, parts, *manifest.add_texture());
  }
  for (const Material& material : scene.materials) {
    encode_material(material, *manifest.add_material());
  }
  encoder.put_shapes(scene.geometry, manifest);
  for (std::size_t i = 0; i < scene.geometry.meshes.size(); ++i) {
    encoder.put_mesh(scene.geometry.meshes.shared(i), *manifest.add_mesh());
  }
  for (const Shapes& group : scene.geometry.groups) {
    encoder.put_shapes(group, *manifest.add_group());
  }
  encode_placements(scene.geometry, *manifest.mutable_frame(), *manifest.mutable_instance());
  encode(scene.media, encoder, manifest);
  if (parts != nullptr) {
    parts->end_package();
  }
  return manifest.SerializeAsString();
}

}  // namespace bandsaw
