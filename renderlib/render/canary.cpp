// The canary is a small render whose hash tells whether two machines render the same pixels. Each
// function that returns a SceneDescription makes one scene. canary() renders a few pixels of all
// scenes and hashes the sums.

#include "renderlib/render/canary.h"

#include <atomic>
#include <cstring>

#include "renderlib/base/check.h"
#include "renderlib/base/pool.h"
#include "renderlib/medium/brick_builder.h"
#include "renderlib/render/hash64.h"
#include "renderlib/render/kernel.h"
#include "renderlib/render/pixel_version.h"
#include "renderlib/render/render_band.h"
#include "renderlib/scene/scene.h"

namespace bandsaw {
namespace {

// The numbers in the scenes are arbitrary.

Texture checked_image() {
  ImageTexture image;
  image.width = 4;
  image.height = 3;
  std::vector<std::byte> texels;
  for (int i = 0; i < 4 * 3 * 3; ++i) {
    texels.push_back(static_cast<std::byte>(40 + 37 * i % 211));
  }
  image.texels = std::move(texels);
  return image;
}

Mesh pyramid() {
  return {.positions = {{-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}, {0, 1.5f, 0}},
          .triangles = {{0, 4, 1}, {1, 4, 2}, {2, 4, 3}, {3, 4, 0}},
          .normals = {{-1, .5f, -1}, {1, .5f, -1}, {1, .5f, 1}, {-1, .5f, 1}, {0, 1, 0}},
          .uvs = {{0, 0}, {2, 0}, {2, 2}, {0, 2}, {1, 1}}};
}

/// Adds a group that rotates and moves, within a moving frame, and a static instance of the same
/// group.
void add_moving_group(SceneDescription& scene) {
  std::get<PerspectiveCamera>(scene.camera).shutter = {0.5, 1.5};
  Geometry& g = scene.geometry;
  Shapes group;
  group.spheres = {{{0, 0, 0}, 0.3, MaterialId{3}}};
  group.disks = {{{0, 0.4, 0}, {0, 1, 0}, 0.2, MaterialId{6}}};
  g.groups = {group};
  g.frames = {
      {kNoFrame, translation({0.9, 1.4, 0.2}), {Key(0, {}), Key(2, translation({1, 0, 0}))}},
      {FrameId{0}, {}, {Key(0, {}), Key(1, rotation({1, 0, 1}, 50) * scaling({1, 2, 1}))}}};
  Instance placed;
  placed.group = GroupId{0};
  placed.material = kOwnMaterial;
  placed.to_world = translation({-1, 2, -0.5}) * scaling({1, -0.4, 0.6});
  g.instances.push_back(placed);
  placed.to_world = {};
  placed.frame = FrameId{1};
  g.instances.push_back(placed);
}

/// Returns a scene with every kind of shape, several kinds of material and texture, and surfaces
/// that emit light. It is so small that most paths hit several shapes. Other scenes are made from
/// it.
SceneDescription every_feature() {
  SceneDescription scene;
  scene.camera = PerspectiveCamera{.position = {0.3, 1.7, 5.1}, .look_at = {0, 1, 0}};
  scene.background = {{0.1f, 0.08f, 0.05f}, {0.4f, 0.5f, 0.7f}};
  scene.textures = {
      ConstantTexture{{0.7f, 0.6f, 0.5f}},
      checked_image(),
      ConstantTexture{{9, 8, 7}},
      ConstantTexture{{0.9f, 0.9f, 0.8f}},
      NoiseTexture{.kind = NoiseTexture::Kind::kMarble, .scale = 3, .high = {0.8f, 0.7f, 0.9f}},
      NoiseTexture{.space = Space::kObject, .scale = 5},
      RampTexture{.texture = TextureId{5}, .stops = {{0.3, {}}, {0.7, {0.9f, 0.5f, 0}}}},
      CheckerTexture{
          .even = TextureId{6}, .odd = TextureId{4}, .mapping = CheckerTexture::Mapping::kPosition},
      MixTexture{TextureId{7}, TextureId{1}, TextureId{5}}};
  const auto texture = [](std::uint32_t i) { return TextureId{i}; };
  scene.materials = {Diffuse{texture(0)},         Diffuse{texture(1)}, Metal{texture(3), 0},
                     Metal{texture(3), 0.3},      Dielectric{1.5},     Emissive{texture(2), true},
                     Emissive{texture(1), false}, Diffuse{texture(8)}};
  Geometry& g = scene.geometry;
  g.spheres = {{{-1.2, 0.6, 1.0}, 0.6, MaterialId{4}},
               {{1.4, 0.5, 1.2}, 0.5, MaterialId{2}},
               {{0.2, 0.35, 1.9}, 0.35, MaterialId{3}},
               {{-0.4, 2.4, 0.4}, 0.15, MaterialId{5}}};
  g.quads = {{{-3, 0, -2}, {0, 0, 5}, {6, 0, 0}, MaterialId{1}},
             {{-3, 0, -2}, {6, 0, 0}, {0, 4, 0}, MaterialId{7}},
             {{0.5, 3, 0}, {1, 0, 0}, {0.1, 0, 0.8}, MaterialId{5}}};
  g.triangles = {{{2, 0.1, -1}, {2.8, 0.1, -0.6}, {2.2, 1, -1}, MaterialId{6}}};
  g.meshes = {pyramid()};
  g.instances = {
      {MeshId{0}, MaterialId{7}, translation({0.2, 0, -0.6}) * rotation({0, 1, 0.1}, 25)},
      {MeshId{0}, MaterialId{6}, translation({-1.9, 0, -0.8}) * scaling({-0.3, 0.5, 0.3})}};
  g.disks = {{{-2.2, 1.6, 0.3}, normalize(Vec3{1, 0.3, 0.8}), 0.4, MaterialId{5}}};
  add_moving_group(scene);
  return scene;
}

/// Returns the scene of every_feature(), through a lens and with a wide pixel filter.
SceneDescription through_a_lens() {
  SceneDescription scene = every_feature();
  auto& camera = std::get<PerspectiveCamera>(scene.camera);
  camera.aperture = 0.2;
  camera.focus_distance = 4.5;
  scene.filter = {PixelFilter::Kind::kGaussian, 1.5};
  return scene;
}

/// Returns the scene of every_feature() with an orthographic camera.
SceneDescription flat_view() {
  SceneDescription scene = every_feature();
  scene.camera =
      OrthographicCamera{.position = {1.3, 2.2, 5.1}, .look_at = {0, 1, 0}, .height = 4.1};
  scene.filter = {PixelFilter::Kind::kTent, 1};
  scene.local_shading = {{0.1f, 0.2f, 0.3f}, 1.5};
  return scene;
}

/// Returns the scene of every_feature(), lit by an environment and by so many delta lights that a
/// light tree selects among them.
SceneDescription lit_from_outside() {
  SceneDescription scene = every_feature();
  Environment environment;
  environment.images = {TextureId{1}};
  environment.strength = 3;
  scene.background.environment = environment;
  scene.lights = {
      DirectionalLight{normalize(Vec3{1, -2, -1}), {0.5f, 0.6f, 0.7f}},
      SpotLight{{0, 3.5, 2}, {0, -1, 0}, {4, 3, 2}, 0.9, 0.6},
      SpotLight{.position = {-2, 3, 1},
                .direction = {0, -1, 0},
                .intensity = {2, 3, 4},
                .cos_inner = 0.9,
                .cos_outer = 0.5,
                .falloff = SpotLight::Falloff::kLinearAngle,
                .image = ProjectedImage{TextureId{8}, {1, 0, 0}, {0, 0, 1}, 2, 2}},
      SpotLight{
          .position = {2, 3, 1}, .direction = {0, -1, 0}, .falloff = SpotLight::Falloff::kSmooth},
      ProjectorLight{.position = {0.5, 3.5, 1},
                     .direction = {0, -1, 0},
                     .intensity = {3, 2, 1},
                     .image = {TextureId{1}, {0, 0, 1}, {1, 0, 0}, 0.7, 0.4}}};
  for (int i = 0; i < 20; ++i) {
    scene.lights.push_back(PointLight{{0.3 * i - 3, 2.5, 0.1 * i}, gray(0.02f * (i + 1))});
  }
  return scene;
}

/// Returns the scene of every_feature() with media in a ball, in a cube and everywhere else.
SceneDescription in_smoke() {
  SceneDescription scene = every_feature();
  Media& media = scene.media;
  media.media = {{.absorption = {0.01f, 0.02f, 0}, .scattering = {0.05f, 0.02f, 0.1f}},
                 {.scattering = {1, 2, 3}, .emission = {0.1f, 0, 0}, .g = 0.6},
                 {.absorption = {3, 1, 0}, .scattering = {0, 1, 3}, .g = -0.3}};
  media.fog = MediumId{0};
  media.boundaries.spheres = {{{-1.2, 0.6, 1.0}, 0.6, filled_with(MediumId{1})}};
  media.boundaries.meshes = {unit_cube()};
  media.boundaries.instances = {
      {MeshId{0}, filled_with(MediumId{2}), translation({-0.5, 0, -1}) * rotation({1, 1, 0}, 25)}};
  return scene;
}

/// Returns the scene of every_feature() with a glowing cloud that varies in space and moves with a
/// turned frame.
SceneDescription in_a_cloud() {
  SceneDescription scene = every_feature();
  Media& media = scene.media;
  media.grids = {
      dense_grid({11, 6, 9}, 1, [](std::size_t i) { return static_cast<float>(i * 7 % 23) / 8; }),
      dense_grid({3, 2, 4}, 3, [](std::size_t i) { return static_cast<float>(i % 5) * 0.2f; })};
  media.grids[0].to_medium = scaling({0.2, 0.4, 0.3});
  media.grids[1].to_medium = rotation({1, 0, 1}, 30) * scaling({0.8, 1, 0.7});
  media.grids[1].border = VolumeGrid::Border::kClamp;
  Medium cloud{.scattering = gray(0.7f), .emission = {1, 2, 3}, .g = 0.4};
  cloud.grids.density = GridUse{GridId{0}, 0.6f};
  cloud.grids.albedo = GridUse{GridId{1}, 1.2f};
  cloud.grids.temperature = GridUse{GridId{1}, 2500};
  media.media = {cloud};
  media.boundaries.meshes = {unit_cube()};
  media.boundaries.frames = {{kNoFrame,
                              translation({-1, 0.2, -0.8}) * rotation({0, 1, 0.2}, 25),
                              {Key(0, {}), Key(2, translation({0.3, 0, 0}))}}};
  media.boundaries.instances = {
      {MeshId{0}, filled_with(MediumId{0}), scaling({2.2, 2.4, 2.7}), kNoGroup, FrameId{0}}};
  return scene;
}

/// Returns a scene of an area light, a ball and a wall on a floor, with a black background. In such
/// a scene, neighbouring pixels reuse each other's paths.
SceneDescription room() {
  SceneDescription scene;
  scene.textures = {ConstantTexture{{0.7f, 0.5f, 0.3f}}, ConstantTexture{gray(5)}};
  scene.materials = {Diffuse{TextureId{0}}, Emissive{TextureId{1}}};
  Geometry& g = scene.geometry;
  g.spheres = {{{0.3, 0.5, 0.2}, 0.5, MaterialId{0}}};
  g.quads = {{{-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, MaterialId{0}},
             {{-2, 0, -1}, {4, 0, 0.5}, {0, 3, 0}, MaterialId{0}},
             {{-0.5, 2.5, 0.5}, {0, 0, -1}, {1, 0, 0}, MaterialId{1}}};
  scene.camera = PerspectiveCamera{.position = {0.2, 1.1, 4}, .look_at = {0, 1, 0}};
  return scene;
}

/// Returns a scene of a ball and a pyramid on a floor under a sky, without lights. In such a scene,
/// paths are split into several directions.
SceneDescription outdoors() {
  SceneDescription scene;
  scene.background = {{0.9f, 0.8f, 0.7f}, {0.4f, 0.5f, 0.7f}};
  scene.textures = {ConstantTexture{{0.7f, 0.5f, 0.3f}}};
  scene.materials = {Diffuse{TextureId{0}}, Metal{TextureId{0}, 0.2}};
  Geometry& g = scene.geometry;
  g.spheres = {{{0.3, 0.5, 0.2}, 0.5, MaterialId{1}}};
  g.quads = {{{-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, MaterialId{0}}};
  g.meshes = {pyramid()};
  g.instances = {{MeshId{0}, MaterialId{0}, {}}};
  scene.camera = PerspectiveCamera{.position = {0.2, 1.1, 4}, .look_at = {0, 0.5, 0}};
  return scene;
}

/// Returns the scene of every_feature() with further kinds of material, and with a height map,
/// transparency by alpha and emission.
SceneDescription with_other_materials() {
  SceneDescription scene = every_feature();
  const auto texture = [](std::uint32_t i) { return TextureId{i}; };
  const Microfacets brushed{
      .distribution = Microfacets::Distribution::kBeckmann, .alpha_u = 0.3, .alpha_v = 0.1};
  const Microfacets rough{.alpha_u = 0.6, .alpha_v = 0.6};
  const ConductorIndex gold{{0.143f, 0.375f, 1.44f}, {3.98f, 2.39f, 1.6f}};
  Principled layered{.base_color = texture(0), .spec_trans = {0.3}, .sheen = {0.5}};
  layered.anisotropic = {0.8, texture(5)};
  layered.clearcoat = {1};
  layered.flatness = {0.5};
  ThinPrincipled thin{.base_color = texture(0), .spec_trans = {0.5}, .diff_trans = {0.5}};
  scene.materials[0] = Plastic{.reflectance = texture(0), .surface = rough};
  scene.materials[1] = Plastic{.reflectance = texture(1), .nonlinear = true};
  scene.materials[1].relief.height = texture(1);
  scene.materials[2] = Conductor{gold, brushed, texture(3)};
  scene.materials[3] = layered;
  scene.materials[4] = Dielectric{.surface = brushed};
  scene.materials[6] = thin;
  scene.materials[6].emission.radiance = {texture(1), gray(0.5f)};
  scene.materials[7] = DiffuseTransmission{texture(0), texture(8)};
  scene.materials[7].alpha = {AlphaMode::kBlend, {texture(1), 0.8}, true};
  scene.materials.push_back(ThinDielectric{});
  scene.materials.push_back(Mix{MaterialId{2}, MaterialId{8}, texture(5)});
  scene.geometry.spheres[2].material = MaterialId{9};
  return scene;
}

/// Renders two blocks of samples of the scene. Adds the sums of its pixels and the number of rays
/// to the hash.
void add_render(Hash64& hash, const SceneDescription& description, const RenderSettings& settings,
                const Kernel& kernel) {
  Pool pool(1);
  const auto scene = Scene::build(description, pool, {}, Traversal::kBvh, &kernel);
  BANDSAW_CHECK(scene.ok(), "the built-in scene is valid");
  const std::atomic<bool> stop = false;
  const auto pixels = render_band(**scene, settings, {{0, 2 * kBlockSamples}, {0, settings.height}},
                                  pool, stop, {});
  BANDSAW_CHECK(pixels.ok(), "the built-in band is valid");
  for (const double sum : pixels->sums) {
    hash.add(sum);
  }
  hash.add(pixels->counters.rays);
}

/// Returns settings of path tracing without guiding and photon maps. Guiding and photon maps need a
/// pilot, a trial that decides whether they are worthwhile. The pilot would take longer than the
/// renders of the canary.
RenderSettings path_settings(std::uint32_t width, std::uint32_t height, std::uint32_t max_depth,
                             std::uint64_t seed) {
  return {.width = width,
          .height = height,
          .max_depth = max_depth,
          .seed = seed,
          .integrator = Integrator::kPathPlain};
}

}  // namespace

std::uint64_t canary(const Kernel* kernel) {
  const Kernel& chosen = kernel != nullptr ? *kernel : *kernels().front();
  Hash64 hash;
  hash.add(std::uint64_t{kPixelVersion});
  chosen.add_elementary_functions(hash);
  add_render(hash, every_feature(), path_settings(12, 9, 8, 20260), chosen);
  add_render(hash, through_a_lens(), path_settings(4, 3, 3, 1), chosen);
  add_render(hash, flat_view(), path_settings(4, 3, 3, 2), chosen);
  add_render(hash, lit_from_outside(), path_settings(6, 4, 4, 4), chosen);
  add_render(hash, in_smoke(), path_settings(6, 4, 5, 4), chosen);
  add_render(hash, in_a_cloud(), path_settings(6, 4, 5, 4), chosen);
  add_render(hash, with_other_materials(), path_settings(12, 9, 6, 9), chosen);
  add_render(hash, room(), path_settings(20, 4, 5, 5), chosen);
  add_render(hash, outdoors(), path_settings(8, 6, 5, 6), chosen);
  for (const Integrator integrator : {Integrator::kDirect, Integrator::kNormals, Integrator::kDepth,
                                      Integrator::kAlbedo, Integrator::kAmbientOcclusion}) {
    add_render(hash, flat_view(),
               {.width = 4, .height = 3, .max_depth = 3, .seed = 3, .integrator = integrator},
               chosen);
  }
  return hash.value();
}

}  // namespace bandsaw
