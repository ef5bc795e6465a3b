// A package is a scene as a manifest and blobs. Packages read back bit for bit, and damaged
// packages are refused.

#include "renderlib/package/package.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <random>

#include "proto/package.pb.h"
#include "tests/unit/package/sample_scene.h"

namespace bandsaw {
namespace {

using test::sample_info;
using test::sample_scene;
using ::testing::HasSubstr;

/// Counts the blobs that are read.
class CountingBlobs : public BlobSource {
 public:
  absl::StatusOr<std::unique_ptr<BlobBytes>> get(const wire::Digest& digest) override {
    ++reads;
    return blobs.get(digest);
  }
  BlobMap blobs;
  int reads = 0;
};

// DecodedParts remembers the meshes and blobs of decoded packages as long as they are in use. The
// second package has another camera and another mesh 1, so decoding it reads only its new parts.
TEST(Package, SharesThePartsThatAreInUse) {
  CountingBlobs source;
  SceneDescription scene = sample_scene();
  const std::string first = encode_package(scene, sample_info(), source.blobs);
  std::get<PerspectiveCamera>(scene.camera).position.x += 1;
  scene.geometry.meshes.change(1).positions[0][0] += 1;
  const std::string second = encode_package(scene, sample_info(), source.blobs);
  ASSERT_NE(first, second);

  DecodedParts parts;
  auto kept = decode_package(first, source, &parts);
  ASSERT_TRUE(kept.ok()) << kept.status();
  const int all = source.reads;
  const auto other = decode_package(second, source, &parts);
  ASSERT_TRUE(other.ok()) << other.status();
  EXPECT_LT(source.reads, 2 * all - 3);  // more than three blobs are not read a second time
  EXPECT_EQ(other->geometry.meshes.shared(0), kept->geometry.meshes.shared(0));
  EXPECT_EQ(other->geometry.meshes[1].positions, scene.geometry.meshes[1].positions);
  EXPECT_EQ(std::get<ImageTexture>(other->textures[2]).texels.data(),
            std::get<ImageTexture>(kept->textures[2]).texels.data());
  // Everything that is decoded has the same values as without sharing.
  BlobMap again;
  EXPECT_EQ(encode_package(*other, sample_info(), again), second);

  kept = absl::CancelledError("not in use any more");
  const std::size_t in_use = parts.size();
  parts.forget_unused();
  EXPECT_LT(parts.size(), in_use);
  EXPECT_NE(parts.size(), 0u);
}

TEST(Package, ChecksAMeshThatAPackageHasTwice) {
  BlobMap blobs;
  SceneDescription scene = sample_scene();
  scene.geometry.meshes.change(0).positions[2][1] = std::numeric_limits<float>::infinity();
  scene.geometry.meshes.share(scene.geometry.meshes.shared(0));
  const std::string manifest = encode_package(scene, sample_info(), blobs);
  DecodedParts parts;
  EXPECT_THAT(decode_package(manifest, blobs, &parts).status().message(),
              HasSubstr("meshes[0].positions[2]: must be finite"));
}

TEST(Package, RoundTripsBitForBit) {
  BlobMap blobs;
  const SceneDescription scene = sample_scene();
  const std::string manifest = encode_package(scene, sample_info(), blobs);
  const auto decoded = decode_package(manifest, blobs);
  ASSERT_TRUE(decoded.ok()) << decoded.status();

  const auto& camera = std::get<PerspectiveCamera>(decoded->camera);
  const auto& was = std::get<PerspectiveCamera>(scene.camera);
  EXPECT_EQ(camera.position, was.position);
  EXPECT_EQ(camera.look_at, was.look_at);
  EXPECT_EQ(camera.vertical_fov, was.vertical_fov);
  EXPECT_EQ(decoded->background.top, scene.background.top);
  ASSERT_EQ(decoded->geometry.instances.size(), 3u);
  EXPECT_EQ(decoded->geometry.instances[1].to_world, scene.geometry.instances[1].to_world);
  EXPECT_EQ(decoded->geometry.meshes[0].positions, scene.geometry.meshes[0].positions);
  EXPECT_EQ(decoded->geometry.meshes[0].normals, scene.geometry.meshes[0].normals);
  EXPECT_EQ(decoded->geometry.meshes[0].uvs, scene.geometry.meshes[0].uvs);
  EXPECT_EQ(decoded->geometry.meshes[0].uvs2, scene.geometry.meshes[0].uvs2);
  EXPECT_EQ(decoded->geometry.meshes[0].positions_at_close,
            scene.geometry.meshes[0].positions_at_close);
  EXPECT_EQ(decoded->geometry.meshes[0].normals_at_close,
            scene.geometry.meshes[0].normals_at_close);
  EXPECT_TRUE(decoded->geometry.meshes[1].positions_at_close.empty());
  EXPECT_TRUE(decoded->geometry.meshes[1].uvs.empty());
  EXPECT_EQ(decoded->geometry.spheres[1].radius, 1e-5);
  EXPECT_EQ(decoded->geometry.quads[0].v, scene.geometry.quads[0].v);
  EXPECT_EQ(decoded->geometry.triangles[0].b, scene.geometry.triangles[0].b);
  const auto& image = std::get<ImageTexture>(decoded->textures[2]);
  EXPECT_EQ(image.texels, std::get<ImageTexture>(scene.textures[2]).texels);
  EXPECT_EQ(image.wrap, ImageTexture::Wrap::kMirror);
  EXPECT_EQ(image.filter, ImageTexture::Filter::kNearest);
  EXPECT_TRUE(std::get<Emissive>(decoded->materials[3].kind).one_sided);
  EXPECT_EQ(std::get<Metal>(decoded->materials[4].kind).fuzz_map, TextureId{4});
  EXPECT_EQ(std::get<Dielectric>(decoded->materials[5].kind).index_map, TextureId{3});
  EXPECT_EQ(std::get<MetallicRoughness>(decoded->materials[6].kind).coat_normal_scale, -0.5);
  EXPECT_EQ(std::get<Conductor>(decoded->materials[8].kind).surface.alpha_v_map, TextureId{4});
  EXPECT_EQ(std::get<Principled>(decoded->materials[11].kind).flatness.value, 0.75);
  EXPECT_EQ(std::get<Mix>(decoded->materials[13].kind).b, MaterialId{8});
  EXPECT_EQ(decoded->materials[14].alpha.cutoff, 0.125);
  EXPECT_EQ(decoded->materials[15].relief.height, TextureId{4});
  EXPECT_TRUE(decoded->materials[15].one_sided);
  EXPECT_EQ(std::get<CheckerTexture>(decoded->textures[5]).space, Space::kObject);
  EXPECT_EQ(std::get<NoiseTexture>(decoded->textures[6]).turbulence_scale, 1.5);
  EXPECT_EQ(std::get<RampTexture>(decoded->textures[7]).stops[1].at, 0.3);

  EXPECT_EQ(decoded->media.media, scene.media.media);
  EXPECT_EQ(decoded->media.fog, scene.media.fog);
  EXPECT_EQ(decoded->media.grids, scene.media.grids);
  EXPECT_EQ(decoded->media.boundaries.instances[0].to_world,
            scene.media.boundaries.instances[0].to_world);

  // Covers fields not compared above: the same scene gives the same blobs and the same bytes.
  BlobMap again;
  EXPECT_EQ(encode_package(*decoded, sample_info(), again), manifest);
  EXPECT_EQ(again.all(), blobs.all());
}

TEST(Package, RoundTripsImageSettings) {
  SceneDescription scene = sample_scene();
  scene.local_shading = {{0.1f, 0.2f, 0.3f}, 4.5};
  PackageInfo info = sample_info();
  info.integrator = Integrator::kDirect;
  info.display = {.exposure = -2.5, .tone = Tone::kFilmic};
  BlobMap blobs;
  const std::string manifest = encode_package(scene, info, blobs);
  const auto back = package_info(manifest);
  ASSERT_TRUE(back.ok()) << back.status();
  EXPECT_EQ(back->integrator, Integrator::kDirect);
  EXPECT_EQ(back->display, info.display);
  const auto decoded = decode_package(manifest, blobs);
  ASSERT_TRUE(decoded.ok()) << decoded.status();
  EXPECT_EQ(decoded->local_shading.ambient, scene.local_shading.ambient);
  EXPECT_EQ(decoded->local_shading.occlusion_distance, 4.5);
  info.display.exposure = 31;
  EXPECT_THAT(std::string(package_info(encode_package(scene, info, blobs)).status().message()),
              HasSubstr("scene package: exposure: must lie in"));
  info.display = {};
  info.integrator = static_cast<Integrator>(kLastIntegrator + 1);
  EXPECT_THAT(std::string(package_info(encode_package(scene, info, blobs)).status().message()),
              HasSubstr("scene package: integrator: must lie in"));
}

TEST(Package, RoundTripsEveryCameraAndFilter) {
  const auto carried = [](const Camera& camera, const PixelFilter& filter) {
    SceneDescription scene = sample_scene();
    scene.camera = camera;
    scene.filter = filter;
    BlobMap blobs;
    return decode_package(encode_package(scene, sample_info(), blobs), blobs);
  };
  const auto lens =
      carried(PerspectiveCamera{.vertical_fov = 20, .aperture = 0.1, .focus_distance = 7.5},
              {PixelFilter::Kind::kTent, 2});
  ASSERT_TRUE(lens.ok()) << lens.status();
  EXPECT_EQ(std::get<PerspectiveCamera>(lens->camera).aperture, 0.1);
  EXPECT_EQ(std::get<PerspectiveCamera>(lens->camera).focus_distance, 7.5);
  EXPECT_EQ(lens->filter, (PixelFilter{PixelFilter::Kind::kTent, 2}));
  const auto flat = carried(OrthographicCamera{.height = 500, .mirrored = true}, {});
  ASSERT_TRUE(flat.ok()) << flat.status();
  EXPECT_EQ(std::get<OrthographicCamera>(flat->camera).height, 500);
  EXPECT_TRUE(std::get<OrthographicCamera>(flat->camera).mirrored);
  EXPECT_EQ(flat->filter, PixelFilter{});
  EXPECT_THAT(std::string(carried(PerspectiveCamera{.aperture = -1}, {}).status().message()),
              HasSubstr("scene package: camera.aperture"));
  EXPECT_THAT(
      std::string(carried(PerspectiveCamera{}, {PixelFilter::Kind::kBox, 17}).status().message()),
      HasSubstr("scene package: filter.radius"));
}

TEST(Package, CarriesACameraThatMoves) {
  SceneDescription scene = sample_scene();
  PerspectiveCamera first;
  first.shutter = {1, 2};
  PerspectiveCamera last = first;
  last.position = {3, 2, 1};
  scene.camera = first;
  scene.camera_at_close = last;
  BlobMap blobs;
  const auto decoded = decode_package(encode_package(scene, {}, blobs), blobs);
  ASSERT_TRUE(decoded.ok()) << decoded.status();
  ASSERT_TRUE(decoded->camera_at_close.has_value());
  EXPECT_EQ(view_of(*decoded->camera_at_close).position, last.position);
  EXPECT_EQ(shutter_of(*decoded->camera_at_close), last.shutter);
  scene.camera_at_close = OrthographicCamera{.shutter = {1, 2}};
  EXPECT_FALSE(decode_package(encode_package(scene, {}, blobs), blobs).ok());
}

TEST(Package, RoundTripsItsInfo) {
  BlobMap blobs;
  const auto info = package_info(encode_package(sample_scene(), sample_info(), blobs));
  ASSERT_TRUE(info.ok()) << info.status();
  EXPECT_EQ(info->name, "sample");
  EXPECT_EQ(info->width, 320u);
  EXPECT_EQ(info->height, 200u);
  EXPECT_EQ(info->max_depth, 8u);
  EXPECT_EQ(info->warnings, std::vector<std::string>{"a warning"});
}

TEST(Package, LimitsNamesAndWarningsOfForeignFiles) {
  PackageInfo info = sample_info();
  info.name = std::string(1000, 'n') + "\xff";
  info.warnings.assign(5000, "\x1b[2J a mesh's name \xc3");
  BlobMap blobs;
  const auto kept = package_info(encode_package(sample_scene(), info, blobs));
  ASSERT_TRUE(kept.ok()) << kept.status();
  EXPECT_EQ(kept->name.size(), 200u);
  EXPECT_EQ(kept->warnings.size(), 100u);
  EXPECT_EQ(kept->warnings[0], "?[2J a mesh's name ?");
  EXPECT_EQ(kept->warnings[99], "and 4901 more warnings");
}

TEST(Package, LimitsTheNamesOfCameras) {
  PackageInfo info = sample_info();
  info.model_cameras.assign(500, "\x1b" + std::string(300, 'c'));
  BlobMap blobs;
  const std::string bytes = encode_package(sample_scene(), info, blobs);
  const auto kept = package_info(bytes);
  ASSERT_TRUE(kept.ok()) << kept.status();
  EXPECT_EQ(kept->model_cameras.size(), 100u);
  EXPECT_EQ(kept->model_cameras[0].substr(0, 2), "?c");
  // Returns the error for a manifest in which the last of the 100 names is `name` and one name is
  // added. If `name` is not empty, the first name is removed, so that there are 100 again.
  const auto error_with = [&](const std::string& name) {
    package::Manifest manifest;
    EXPECT_TRUE(manifest.ParseFromString(bytes));
    manifest.mutable_model_camera()->RemoveLast();
    manifest.add_model_camera(name);
    manifest.add_model_camera("one more");
    manifest.mutable_model_camera()->DeleteSubrange(0, name.empty() ? 0 : 1);
    return std::string(package_info(manifest.SerializeAsString()).status().message());
  };
  EXPECT_THAT(error_with(""), HasSubstr("model_camera: has 101 entries, at most 100"));
  EXPECT_THAT(error_with(std::string(201, 'c')), HasSubstr("model_camera: has 201 bytes"));
}

TEST(Package, NamesEachBlobOnce) {
  BlobMap blobs;
  const auto refs = package_blobs(encode_package(sample_scene(), sample_info(), blobs));
  ASSERT_TRUE(refs.ok()) << refs.status();
  // Two meshes share positions and indices; two 8-bit images have the same texels.
  EXPECT_EQ(refs->size(), blobs.all().size());
  for (const BlobRef& ref : *refs) {
    EXPECT_EQ(blobs.get(ref.digest).value()->bytes().size(), ref.size);
  }
}

TEST(Package, ReportsAMissingBlob) {
  BlobMap blobs;
  const std::string manifest = encode_package(sample_scene(), sample_info(), blobs);
  BlobMap none;
  const auto decoded = decode_package(manifest, none);
  EXPECT_EQ(decoded.status().code(), absl::StatusCode::kNotFound) << decoded.status();
}

TEST(Package, RoundTripsGroupsAndFrames) {
  const SceneDescription scene = sample_scene();
  BlobMap blobs;
  const auto decoded = decode_package(encode_package(scene, sample_info(), blobs), blobs);
  ASSERT_TRUE(decoded.ok()) << decoded.status();
  EXPECT_EQ(shutter_of(decoded->camera), (Shutter{-0.5, 1.0 / 3}));
  const Geometry& g = decoded->geometry;
  ASSERT_EQ(g.disks.size(), 1u);
  EXPECT_EQ(g.disks[0].normal, (Vec3{0, 0.6, 0.8}));
  ASSERT_EQ(g.groups.size(), 2u);
  EXPECT_EQ(g.groups[0].spheres[0].radius, 2);
  EXPECT_EQ(g.groups[0].disks[0].center.y, 1.0 / 7);
  EXPECT_EQ(g.groups[0].disks[0].material, MaterialId{2});
  ASSERT_EQ(g.frames.size(), 2u);
  EXPECT_EQ(g.frames[0].parent, kNoFrame);
  EXPECT_EQ(g.frames[1].parent, FrameId{0});
  EXPECT_EQ(g.frames[0].placement, scene.geometry.frames[0].placement);
  EXPECT_EQ(g.frames[0].keys[1].time, 2);
  EXPECT_EQ(g.frames[0].keys[1].at, scene.geometry.frames[0].keys[1].at);
  EXPECT_EQ(g.instances[2].group, GroupId{0});
  EXPECT_EQ(g.instances[2].material, kOwnMaterial);
  EXPECT_EQ(g.instances[2].frame, FrameId{1});
  EXPECT_EQ(g.instances[0].frame, kNoFrame);
}

/// A change to a valid manifest, and the part of the error message that names the field.
struct Wrong {
  std::string name;
  std::function<void(package::Manifest&)> spoil;
  std::string message;
  friend void PrintTo(const Wrong& wrong, std::ostream* out) { *out << wrong.name; }
};

class SpoiltManifest : public ::testing::TestWithParam<Wrong> {};

TEST_P(SpoiltManifest, IsRefusedNamingTheField) {
  BlobMap blobs;
  package::Manifest manifest;
  ASSERT_TRUE(manifest.ParseFromString(encode_package(sample_scene(), sample_info(), blobs)));
  blobs.put(std::vector<std::byte>(7));
  GetParam().spoil(manifest);
  const auto decoded = decode_package(manifest.SerializeAsString(), blobs);
  ASSERT_EQ(decoded.status().code(), absl::StatusCode::kInvalidArgument) << decoded.status();
  EXPECT_THAT(std::string(decoded.status().message()), HasSubstr(GetParam().message));
}

const std::vector<Wrong> kWrong = {
    {"format", [](auto& m) { m.set_format(3); }, "format: is 3"},
    {"width", [](auto& m) { m.set_width(0); }, "width: must lie in [1, 65536], is 0"},
    {"pixels", [](auto& m) { m.set_width(65536), m.set_height(65536); }, "width x height"},
    {"depth", [](auto& m) { m.set_max_depth(5000); }, "max_depth: must lie in [1, 1024]"},
    {"no_camera", [](auto& m) { m.clear_camera(); }, "camera: is missing"},
    {"camera", [](auto& m) { m.mutable_camera()->set_vertical_fov(180); },
     "camera.vertical_fov: must be in (0, 180)"},
    {"short_list", [](auto& m) { m.mutable_camera()->mutable_up()->RemoveLast(); },
     "camera.up: must have 3 numbers, has 2"},
    {"no_background", [](auto& m) { m.clear_background(); }, "background: is missing"},
    {"dark", [](auto& m) { m.mutable_background()->set_top(1, -1); }, "background.top: must be"},
    {"environment", [](auto& m) { m.mutable_background()->mutable_environment()->set_image(0, 0); },
     "background.environment: images[0]: must be an image"},
    {"environment_index",
     [](auto& m) { m.mutable_background()->mutable_environment()->set_image(0, 77); },
     "images[0]: must be below 10, is 77"},
    {"environment_kind",
     [](auto& m) { m.mutable_background()->mutable_environment()->clear_kind(); },
     "background.environment.kind: must lie in [1, 2], is 0"},
    {"environment_axes",
     [](auto& m) { m.mutable_background()->mutable_environment()->set_axes(0, 0.5); },
     "axes: must be three unit vectors at right angles"},
    {"grid_cells", [](auto& m) { m.mutable_grid(0)->mutable_cells()->RemoveLast(); },
     "grid[0].cells: must have 3 numbers, has 2"},
    {"grid_side", [](auto& m) { m.mutable_grid(0)->set_cells(0, 0); },
     "grids[0].cells: must be in [1, 1048576], is 0"},
    {"grid_size",
     [](auto& m) {
       for (int k = 0; k < 3; ++k) {
         m.mutable_grid(1)->set_cells(k, 1 << 20);
       }
     },
     "grids[1].cells: must be at most 67108864 bricks"},
    {"grid_channels", [](auto& m) { m.mutable_grid(0)->set_channels(2); },
     "grids[0].channels: must be 1 or 3, is 2"},
    {"grid_format", [](auto& m) { m.mutable_grid(0)->clear_format(); },
     "grid[0].format: must lie in [1, 2], is 0"},
    {"grid_filter",
     [](auto& m) { m.mutable_grid(0)->set_filter(static_cast<package::VolumeGrid::Filter>(9)); },
     "grid[0].filter: must lie in [1, 2], is 9"},
    {"grid_border", [](auto& m) { m.mutable_grid(0)->clear_border(); },
     "grid[0].border: must lie in [1, 2], is 0"},
    {"grid_place", [](auto& m) { m.mutable_grid(0)->mutable_to_medium()->RemoveLast(); },
     "grid[0].to_medium: must have 12 numbers, has 11"},
    {"grid_flat",
     [](auto& m) {
       for (int k = 0; k < 12; ++k) {
         m.mutable_grid(0)->set_to_medium(k, 0);
       }
     },
     "grids[0].to_medium: must not be singular"},
    {"grid_index", [](auto& m) { *m.mutable_grid(0)->mutable_index() = m.grid(0).values(); },
     "grids[0].index: must have 8 bytes for 2 bricks"},
    {"grid_places",
     // The blob of the values is also used as the index. So an entry of the index is out of range.
     [](auto& m) {
       m.mutable_grid(1)->set_cells(0, 8 * 32);
       m.mutable_grid(1)->set_cells(1, 8 * 4);
       m.mutable_grid(1)->set_cells(2, 8 * 6);
       *m.mutable_grid(1)->mutable_index() = m.grid(1).values();
     },
     "grids[1].index["},
    {"grid_values", [](auto& m) { *m.mutable_grid(0)->mutable_values() = m.grid(0).index(); },
     "grids[0].values: must be bricks of 2048 bytes, has 8 bytes"},
    {"grid_blob", [](auto& m) { m.mutable_grid(0)->mutable_values()->set_size(5); },
     "grid[0].values.size: is 5"},
    {"grid_use", [](auto& m) { m.mutable_medium(2)->mutable_density_grid()->set_grid(2); },
     "media[2].density_grid.grid: must be below 2, is 2"},
    {"grid_scale", [](auto& m) { m.mutable_medium(2)->mutable_albedo_grid()->set_scale(-1); },
     "media[2].albedo_grid.scale: must be finite and >= 0, is -1"},
    {"grid_dense", [](auto& m) { m.mutable_medium(2)->mutable_density_grid()->set_scale(1e12f); },
     "media[2].density_grid: must be at most 1e+12 per scene unit"},
    {"grid_offset",
     [](auto& m) {
       m.mutable_medium(3)->set_temperature_offset(std::numeric_limits<double>::infinity());
     },
     "media[3].temperature_offset: must be finite"},
    {"grid_blackbody",
     [](auto& m) {
       m.mutable_medium(3)->set_blackbody(static_cast<package::Medium::BlackbodyScale>(2));
     },
     "medium[3].blackbody: must lie in [0, 1], is 2"},
    {"grid_fog", [](auto& m) { m.set_fog(2); }, "fog: must not have grids"},
    {"light_kind", [](auto& m) { m.mutable_light(1)->clear_kind(); }, "light[1]: is of no kind"},
    {"light_direction",
     [](auto& m) { m.mutable_light(0)->mutable_directional()->set_direction(0, 3); },
     "light[0]: directional.direction: must be a unit vector"},
    {"light_intensity",
     [](auto& m) { m.mutable_light(1)->mutable_point()->mutable_intensity()->set_rgb(0, -1); },
     "light[1]: point.intensity: must be finite and >= 0"},
    {"light_cone", [](auto& m) { m.mutable_light(2)->mutable_spot()->set_cos_inner(0.1); },
     "light[2]: spot.cos_outer: must be in [0, cos_inner]"},
    {"suns",
     [](auto& m) {
       for (int i = 0; i < 8; ++i) {
         *m.add_light() = m.light(0);
       }
     },
     "at most 8 may be directional, there are 9"},
    {"texture_kind", [](auto& m) { m.mutable_texture(0)->clear_kind(); }, "texture[0]: is of no"},
    {"texture_nan",
     [](auto& m) { m.mutable_texture(0)->mutable_constant()->set_rgb(0, std::nanf("")); },
     "textures[0]: must be finite"},
    {"texels", [](auto& m) { m.mutable_texture(1)->mutable_image()->set_width(4); },
     "textures[1].texels: must have 24 bytes"},
    {"no_texels", [](auto& m) { m.mutable_texture(1)->mutable_image()->set_height(0); },
     "textures[1].height: must be in [1, 65536]"},
    {"texel_format", [](auto& m) { m.mutable_texture(1)->mutable_image()->clear_format(); },
     "texture[1].image.format: must lie in [1, 3], is 0"},
    {"reflectance", [](auto& m) { m.mutable_texture(0)->mutable_constant()->set_rgb(0, 1.5f); },
     "materials[0].reflectance: must be in [0, 1], texture 0 reaches 1.5"},
    {"texture_index",
     [](auto& m) { m.mutable_material(0)->mutable_diffuse()->set_reflectance(99); },
     "materials[0].reflectance: must be below 10, is 99"},
    {"fuzz", [](auto& m) { m.mutable_material(1)->mutable_metal()->set_fuzz(std::nan("")); },
     "materials[1].fuzz: must be in [0, 1]"},
    {"glass",
     [](auto& m) { m.mutable_material(2)->mutable_dielectric()->set_index_of_refraction(0.5); },
     "materials[2].index_of_refraction: must be in [1, 5], is 0.5"},
    {"fuzz_texture", [](auto& m) { m.mutable_material(4)->mutable_metal()->set_fuzz_texture(99); },
     "materials[4].fuzz_map: must be below 10, is 99"},
    {"two_indices", [](auto& m) { m.mutable_material(5)->mutable_dielectric()->set_priority(1); },
     "materials[5].index_map: a glass with a priority has one index of refraction"},
    {"coat_normal", [](auto& m) { m.mutable_material(6)->mutable_gltf()->set_coat_normal(99); },
     "materials[6].coat_normal: must be below 10, is 99"},
    {"material_kind", [](auto& m) { m.mutable_material(2)->clear_kind(); }, "material[2]: is of"},
    {"few_materials",
     [](auto& m) { m.mutable_material()->DeleteSubrange(3, m.material_size() - 3); },
     "quads[0].material: must be below 3, is 3"},
    {"counts", [](auto& m) { *m.mutable_spheres()->mutable_radii() = m.quads().corners(); },
     "spheres.radii: has 3 entries for 2 shapes"},
    {"mesh_counts", [](auto& m) { *m.mutable_mesh(0)->mutable_normals() = m.quads().corners(); },
     "meshes[0].normals: must have one entry for each of the 4 positions, or none; has 2"},
    {"at_close",
     [](auto& m) { *m.mutable_mesh(0)->mutable_positions_at_close() = m.quads().corners(); },
     "meshes[0].positions_at_close: must have one entry for each of the 4 positions, or none; has "
     "2"},
    {"index", [](auto& m) { *m.mutable_mesh(0)->mutable_indices() = m.mesh(0).positions(); },
     "meshes[0].triangles[1]: must be indices below 4, one is 1065353216"},
    {"odd_size",
     [](auto& m) {
       m.mutable_mesh(0)->mutable_positions()->set_size(7);
       m.mutable_mesh(0)->mutable_positions()->set_sha256(
           wire::sha256(absl::MakeConstSpan(std::vector<std::byte>(7))).raw());
     },
     "mesh[0].positions.size: must be a multiple of 12"},
    {"size", [](auto& m) { m.mutable_triangles()->mutable_vertices()->set_size(144); },
     "triangles.vertices.size: is 144, the blob has 72"},
    {"digest", [](auto& m) { m.mutable_mesh(0)->mutable_uvs()->set_sha256("short"); },
     "mesh[0].uvs.sha256: a SHA-256 digest must have 32 bytes"},
    {"too_large", [](auto& m) { m.mutable_mesh(0)->mutable_uvs()->set_size(1ull << 40); },
     "mesh[0].uvs.size"},
    {"mesh_index", [](auto& m) { m.mutable_instance(1)->set_mesh(2); },
     "instances[1].mesh: must be below 2, is 2"},
    {"instance_material", [](auto& m) { m.mutable_instance(0)->set_material(99); },
     "instances[0].material: must be below"},
    {"transform", [](auto& m) { m.mutable_instance(0)->mutable_transform()->RemoveLast(); },
     "instance[0].transform: must have 12 numbers, has 11"},
    {"flat", [](auto& m) { m.mutable_instance(0)->set_transform(0, 0); },
     "instances[0].to_world: must have an inverse"},
    {"shutter", [](auto& m) { m.mutable_camera()->set_shutter_close(-3); }, "shutter_close"},
    {"disk_normal", [](auto& m) { *m.mutable_disks()->mutable_normals() = m.disks().centers(); },
     "disks[0].normal: must have length 1"},
    {"group_shape",
     [](auto& m) {
       *m.mutable_group(0)->mutable_disks()->mutable_radii() = m.group(0).disks().centers();
     },
     "group[0].disks.radii: has 3 entries for 1 shapes"},
    {"group_index", [](auto& m) { m.mutable_instance(2)->set_group(2); },
     "instances[2].group: must be below 2, is 2"},
    {"frame_index", [](auto& m) { m.mutable_instance(2)->set_frame(2); },
     "instances[2].frame: must be below 2, is 2"},
    {"frame_parent", [](auto& m) { m.mutable_frame(1)->set_parent(1); },
     "frames[1].parent: must be below 1, is 1"},
    {"key_times", [](auto& m) { m.mutable_frame(0)->set_times(1, -1); },
     "frames[0].keys[1].time: must be within +-1e9 and after the key before"},
    {"key_count", [](auto& m) { m.mutable_frame(0)->add_times(9); },
     "frame[0].at: must have 12 numbers for each of 3 times, has 24"},
    {"no_keys", [](auto& m) { m.mutable_frame(1)->clear_times(), m.mutable_frame(1)->clear_at(); },
     "frames[1].keys: must have at least one key"},
    {"shear", [](auto& m) { m.mutable_frame(1)->set_at(1, 0.5); },
     "frames[1].keys[0].at: must be a scale"},
    {"medium", [](auto& m) { m.mutable_medium(0)->set_g(1); },
     "media[0].g: must be in [-0.999, 0.999], is 1"},
    {"medium_list",
     [](auto& m) { m.mutable_medium(1)->mutable_scattering()->mutable_rgb()->RemoveLast(); },
     "medium[1].scattering.rgb: must have 3 numbers, has 2"},
    {"medium_rate", [](auto& m) { m.mutable_medium(1)->mutable_absorption()->set_rgb(2, -1); },
     "media[1].absorption: must be in [0, 1e+12], is -1"},
    {"fog", [](auto& m) { m.set_fog(4); }, "fog: must be below 4, is 4"},
    {"glow", [](auto& m) { m.mutable_medium(1)->mutable_emission()->set_rgb(0, 1); },
     "fog: must absorb or scatter where it emits"},
    {"filling", [](auto& m) { m.mutable_boundaries()->mutable_instance(0)->set_material(4); },
     "boundaries.instances[0].material: must be below 4, is 4"},
    {"boundary_mesh", [](auto& m) { m.mutable_boundaries()->mutable_instance(0)->set_mesh(1); },
     "boundaries.instances[0].mesh: must be below 1, is 1"},
    {"open_boundary",
     [](auto& m) {
       *m.mutable_boundaries()->mutable_mesh(0)->mutable_positions() = m.mesh(0).positions();
       *m.mutable_boundaries()->mutable_mesh(0)->mutable_indices() = m.mesh(0).indices();
     },
     "boundaries.meshes[0]: must be closed, has 5 open edges"},
    {"boundary_blob",
     [](auto& m) { m.mutable_boundaries()->mutable_spheres()->mutable_radii()->set_size(7); },
     "boundaries.spheres.radii.size: must be a multiple of 8"},
    {"boundary_group", [](auto& m) { m.mutable_boundaries()->mutable_instance(1)->set_group(1); },
     "boundaries.instances[1].group: must be below 1, is 1"},
    {"boundary_frame", [](auto& m) { m.mutable_boundaries()->mutable_instance(1)->set_frame(1); },
     "boundaries.instances[1].frame: must be below 1, is 1"},
    {"boundary_keys", [](auto& m) { m.mutable_boundaries()->mutable_frame(0)->set_at(3, NAN); },
     "boundaries.frames[0].keys[0].at: entries must be within"},
    {"boundary_transform",
     [](auto& m) { m.mutable_boundaries()->mutable_instance(1)->add_transform(1); },
     "boundaries.instance[1].transform: must have 12 numbers, has 13"},
    {"empty_boundary_group", [](auto& m) { m.mutable_boundaries()->mutable_group(0)->Clear(); },
     "boundaries.groups[0]: must be one sphere"},
    {"boundary_group_blob",
     [](auto& m) {
       m.mutable_boundaries()->mutable_group(0)->mutable_spheres()->mutable_radii()->set_size(7);
     },
     "boundaries.group[0].spheres.radii.size: must be a multiple of 8"},
};

INSTANTIATE_TEST_SUITE_P(All, SpoiltManifest, ::testing::ValuesIn(kWrong),
                         [](const auto& wrong) { return wrong.param.name; });

TEST(Package, RefusesArraysWithNumbersOutOfRange) {
  const float nan = std::nanf("");
  const auto error_of = [](const SceneDescription& scene) {
    BlobMap blobs;
    const std::string manifest = encode_package(scene, sample_info(), blobs);
    return std::string(decode_package(manifest, blobs).status().message());
  };
  SceneDescription scene = sample_scene();
  scene.geometry.meshes.change(0).positions[2][1] = nan;
  EXPECT_THAT(error_of(scene), HasSubstr("meshes[0].positions[2]: must be finite"));
  scene = sample_scene();
  scene.geometry.spheres[1].radius = -1;
  EXPECT_THAT(error_of(scene), HasSubstr("spheres[1].radius: must be > 0, is -1"));
  scene = sample_scene();
  scene.geometry.quads[0].u.z = 1.0 / 0.0;
  EXPECT_THAT(error_of(scene), HasSubstr("quads[0].u: must be within"));
  scene = sample_scene();
  auto& image = std::get<ImageTexture>(scene.textures[2]);
  std::vector<std::byte> texels(image.texels.begin(), image.texels.end());
  std::memcpy(texels.data() + 16, &nan, sizeof(nan));
  image.texels = std::move(texels);
  EXPECT_THAT(error_of(scene), HasSubstr("textures[2].texels: texel (1, 0) must be finite"));
}

// A manifest may be crafted by an attacker. It must be either decoded or refused.
TEST(Package, SurvivesAnyByteThatIsChanged) {
  BlobMap blobs;
  const std::string manifest = encode_package(sample_scene(), sample_info(), blobs);
  std::mt19937_64 random(7);
  std::size_t refused = 0;
  for (std::size_t at = 0; at < manifest.size(); ++at) {
    for (int round = 0; round < 8; ++round) {
      std::string changed = manifest;
      changed[at] = static_cast<char>(random());
      refused += decode_package(changed, blobs).ok() ? 0u : 1u;
    }
    // A manifest that is truncated between two fields may be the manifest of a smaller scene. Only
    // the manifest's digest can detect the truncation.
    (void)decode_package(manifest.substr(0, at), blobs);
  }
  EXPECT_GT(refused, manifest.size());
}

TEST(Package, SurvivesManyChangesAtOnce) {
  BlobMap blobs;
  const std::string manifest = encode_package(sample_scene(), sample_info(), blobs);
  std::mt19937_64 random(11);
  for (int round = 0; round < 20'000; ++round) {
    std::string changed = manifest;
    for (int i = 0; i < 4; ++i) {
      const std::size_t at = random() % changed.size();
      const std::size_t from = random() % manifest.size();
      const std::size_t count = random() % 9;
      random() % 2 == 0 ? changed.replace(at, count, manifest.substr(from, count))
                        : changed.insert(at, manifest.substr(from, count));
    }
    const auto decoded = decode_package(changed, blobs);
    if (decoded.ok()) {
      BlobMap again;
      encode_package(*decoded, sample_info(), again);
    }
  }
}

}  // namespace
}  // namespace bandsaw
