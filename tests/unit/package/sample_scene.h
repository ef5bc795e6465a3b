#pragma once

// A scene for the tests of packages. A package is a scene in the form of a manifest and blobs (byte
// arrays). The scene has every kind of object that a package can hold, with every property.

#include <cstring>

#include "renderlib/medium/brick_builder.h"
#include "renderlib/package/package.h"

namespace bandsaw::test {

/// An image of 3 x 2 pixels with three channels.
inline ImageTexture sample_image(ImageTexture::Format format) {
  ImageTexture image;
  image.width = 3;
  image.height = 2;
  image.format = format;
  image.wrap = ImageTexture::Wrap::kMirror;
  image.filter = ImageTexture::Filter::kNearest;
  if (format == ImageTexture::Format::kFloat32) {
    const std::vector<float> texels(18, 0.25f);
    const auto* bytes = reinterpret_cast<const std::byte*>(texels.data());
    image.texels = std::vector<std::byte>(bytes, bytes + texels.size() * sizeof(float));
  } else {
    image.texels = std::vector<std::byte>(18, std::byte{200});
  }
  return image;
}

/// Adds a shutter, a disk, groups of shapes, frames (coordinate systems that may move), and an
/// instance. The instance places a group in a frame.
inline void add_motion(SceneDescription& scene) {
  std::get<PerspectiveCamera>(scene.camera).shutter = {-0.5, 1.0 / 3};
  Geometry& geometry = scene.geometry;
  geometry.disks = {{{1, 2, 3}, {0, 0.6, 0.8}, 0.1, MaterialId{0}}};
  Shapes group;
  group.spheres = {{{0, 0, 1}, 2, MaterialId{1}}};
  group.disks = {{{0, 1.0 / 7, 0}, {1, 0, 0}, 4, MaterialId{2}}};
  geometry.groups = {group, Shapes{}};
  geometry.frames = {
      {kNoFrame, translation({1.0 / 3, 0, 0}), {Key(-1, {}), Key(2, rotation({1, 1, 0}, 40))}},
      {FrameId{0}, {}, {Key(0.1, scaling({-1, 2, 3}))}}};
  Instance moving;
  moving.group = GroupId{0};
  moving.material = kOwnMaterial;
  moving.frame = FrameId{1};
  geometry.instances.push_back(moving);
}

/// Adds media that vary in space and use every kind of grid.
inline void add_grids(Media& media) {
  media.grids = {
      dense_grid({9, 3, 2}, 1, [](std::size_t i) { return static_cast<float>(i) * 0.1f; }),
      dense_grid({2, 2, 2}, 3, [](std::size_t i) { return static_cast<float>(i % 2); })};
  media.grids[0].to_medium = translation({1.0 / 3, 0, 0}) * rotation({1, 2, 3}, 40);
  media.grids[1].filter = VolumeGrid::Filter::kNearest;
  media.grids[1].border = VolumeGrid::Border::kClamp;
  Medium smoke{.absorption = {1, 2, 3}};
  smoke.grids.density = GridUse{GridId{0}, 0.5f};
  smoke.grids.albedo = GridUse{GridId{1}, 1};
  Medium fire{.emission = {1, 2, 3}};
  fire.grids.emission = GridUse{GridId{1}, 2};
  fire.grids.temperature = GridUse{GridId{0}, 100};
  fire.grids.temperature_offset = 1.0 / 7;
  fire.grids.blackbody = BlackbodyScale::kPeak;
  media.media.push_back(smoke);
  media.media.push_back(fire);
}

/// Adds materials 7 to 15: every kind that is not among the materials 0 to 6, and every property of
/// a surface.
inline void add_surfaces(SceneDescription& scene) {
  const Microfacets brushed{Microfacets::Distribution::kBeckmann,
                            Microfacets::Masking::kCorrelated,
                            0.25,
                            0.5,
                            TextureId{3},
                            TextureId{4}};
  const Number mapped{0.75, TextureId{4}};
  scene.materials.emplace_back(Plastic{TextureId{0}, 1.9, {}, {1, 0.5f, 0}, true});
  scene.materials.emplace_back(Conductor{ConductorIndex{{1, 2, 0.5f}, {3, 0, 1}}, brushed});
  scene.materials.emplace_back(ThinDielectric{1.25, {1, 0.5f, 0}, {0, 1, 0.25f}, true});
  scene.materials.emplace_back(DiffuseTransmission{TextureId{0}, TextureId{1}});
  scene.materials.emplace_back(Principled{
      TextureId{1}, 1.25, {0.1}, {0.2}, mapped, {0.3}, {0.4}, {0.5}, {0.6}, mapped, {0.7}, {0.8}});
  scene.materials.emplace_back(
      ThinPrincipled{TextureId{1}, 1.25, {0.1}, {0.2}, mapped, {0.3}, {0.4}, {0.5}, mapped, {0.6}});
  scene.materials.emplace_back(Mix{MaterialId{0}, MaterialId{8}, TextureId{4}});
  Material glowing = Dielectric{.index_of_refraction = 1.5, .surface = brushed};
  glowing.relief = {TextureId{3}, 0.5, std::nullopt, 2};
  glowing.alpha = {AlphaMode::kMask, {TextureId{4}, 0.25}, true, 0.125};
  glowing.emission = {{TextureId{1}, {1, 2, 3}}, true};
  scene.materials.push_back(glowing);
  Material bumped = Diffuse{TextureId{0}};
  bumped.relief = {std::nullopt, 1, TextureId{4}, -0.5};
  bumped.one_sided = true;
  scene.materials.push_back(bumped);
}

/// Returns the scene. Its numbers are arbitrary. Many of them need all bits of a double (1.0 / 3),
/// so that any rounding is detected.
inline SceneDescription sample_scene() {
  SceneDescription scene;
  PerspectiveCamera camera;
  camera.position = {1.0 / 3, 2, 7};
  camera.look_at = {0, 0.1, -1e-300};
  camera.vertical_fov = 33.3;
  scene.camera = camera;
  scene.background = {{0.1f, 0.2f, 0.3f}, {1, 2, 3}};
  Environment environment;
  environment.images = {TextureId{2}};
  environment.strength = 0.75f;
  environment.axes = {{0, 0, -1}, {0, 1, 0}, {-1, 0, 0}};
  scene.background.environment = environment;
  scene.lights = {DirectionalLight{{0, 0.6, -0.8}, {1, 2, 3}}, PointLight{{1, 2, 3}, {4, 5, 6}},
                  SpotLight{{7, 8, 9}, {1, 0, 0}, {0, 1, 0.5f}, 0.9, 0.25},
                  SpotLight{.position = {1, 1, 1},
                            .falloff = SpotLight::Falloff::kLinearAngle,
                            .image = ProjectedImage{TextureId{1}, {0, 1, 0}, {1, 0, 0}, 1, 1}},
                  ProjectorLight{.position = {3, 2, 1},
                                 .direction = {0, 1, 0},
                                 .intensity = {1, 0, 2},
                                 .image = {TextureId{2}, {0, 0, 1}, {1, 0, 0}, 0.5, 1.0 / 3}}};
  scene.textures.emplace_back(ConstantTexture{{0.1f, 0.5f, 1}});
  scene.textures.emplace_back(sample_image(ImageTexture::Format::kSrgb8));
  scene.textures.emplace_back(sample_image(ImageTexture::Format::kFloat32));
  scene.textures.emplace_back(sample_image(ImageTexture::Format::kLinear8));
  auto& mapped = std::get<ImageTexture>(scene.textures[3]);
  mapped.uv_set = UvSet::kSecond;
  mapped.uv_transform = {{1, 2, 3, 4, 5, 1.0 / 7}};
  mapped.wrap_v = ImageTexture::Wrap::kClamp;
  ImageTexture grey = sample_image(ImageTexture::Format::kLinear8);
  grey.channels = 1;
  grey.texels = std::vector<std::byte>(6, std::byte{9});
  scene.textures.emplace_back(grey);
  scene.textures.emplace_back(CheckerTexture{TextureId{0},
                                             TextureId{3},
                                             CheckerTexture::Mapping::kPosition,
                                             {0.1, 2, 3},
                                             UvSet::kSecond,
                                             Space::kObject});
  scene.textures.emplace_back(NoiseTexture{NoiseTexture::Kind::kMarble,
                                           Space::kObject,
                                           3,
                                           0.1,
                                           -2,
                                           1.5,
                                           {1, 0, 0.1},
                                           {0.1f, 0, 0},
                                           {1, 0.5f, 0.3f}});
  scene.textures.emplace_back(RampTexture{RampTexture::Over::kTexture,
                                          TextureId{6},
                                          UvSet::kSecond,
                                          Space::kObject,
                                          true,
                                          {{-0.1, {1, 0, 0}}, {0.3, {0, 0.1f, 0}}}});
  scene.textures.emplace_back(MixTexture{TextureId{0}, TextureId{7}, TextureId{4}});
  scene.textures.emplace_back(ProductTexture{TextureId{8}, TextureId{0}});
  scene.materials = {Diffuse{TextureId{0}}, Metal{TextureId{1}, 0.125}, Dielectric{1.3},
                     Emissive{TextureId{2}, true}};
  scene.materials.emplace_back(Metal{TextureId{1}, 0.5, TextureId{4}});
  scene.materials.emplace_back(Dielectric{1.7, 0.25, 0, TextureId{4}, TextureId{3}});
  MetallicRoughness layered;
  layered.coat = {TextureId{4}, 0.5};
  layered.coat_normal = TextureId{3};
  layered.coat_normal_scale = -0.5;
  layered.index_map = TextureId{4};
  scene.materials.emplace_back(layered);
  add_surfaces(scene);
  scene.geometry.spheres = {{{1, 2, 3}, 0.1, MaterialId{0}}, {{4, 5, 6}, 1e-5, MaterialId{1}}};
  scene.geometry.quads = {{{0, 0, 0}, {1, 0, 0}, {0, 1.0 / 7, 0}, MaterialId{3}}};
  scene.geometry.triangles = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, MaterialId{2}}};
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1.1f}};
  mesh.triangles = {{0, 1, 2}, {1, 2, 3}};
  mesh.normals.assign(4, {0, 0, 1});
  mesh.uvs = {{0, 0}, {1, 0}, {0, 1}, {-3.5f, 7}};
  mesh.uvs2 = {{5, 0}, {1, 6}, {0, 0.1f}, {2, 2}};
  mesh.positions_at_close = {{0, 0, 0.1f}, {1, 2, 0}, {0, 1, 0}, {0, 0, 1.0f / 3}};
  mesh.normals_at_close.assign(4, {0, 1, 0});
  scene.geometry.meshes = {mesh, Mesh{mesh.positions, mesh.triangles, {}, {}}};
  scene.geometry.instances = {
      {MeshId{0}, MaterialId{0}, translation({1e9, 0, 1.0 / 3})},
      {MeshId{1}, MaterialId{1}, rotation({1, 2, 3}, 40) * scaling({1, -2, 3})}};
  add_motion(scene);
  scene.media.media = {
      {.absorption = {0.1f, 0, 3}, .scattering = {1, 2, 0}, .emission = {0, 0, 0.5f}, .g = -0.25},
      {}};
  scene.media.boundaries.spheres = {{{1, 1, 1.0 / 7}, 0.5, MaterialId{1}}};
  scene.media.boundaries.groups = {unit_ball()};
  scene.media.boundaries.frames = {{kNoFrame, {}, {Key(1.0 / 3, rotation({1, 0, 0}, 7))}}};
  scene.media.boundaries.meshes = {unit_cube()};
  scene.media.boundaries.instances = {{MeshId{0}, MaterialId{0}, translation({1.0 / 3, 0, 0})},
                                      {{}, MaterialId{1}, {}, GroupId{0}, FrameId{0}}};
  scene.media.fog = MediumId{1};
  add_grids(scene.media);
  return scene;
}

inline PackageInfo sample_info() {
  return {.name = "sample", .width = 320, .height = 200, .max_depth = 8, .warnings = {"a warning"}};
}

}  // namespace bandsaw::test
