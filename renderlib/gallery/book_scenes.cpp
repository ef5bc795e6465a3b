// Writes the scenes as text, one shape after the other, with places from a fixed sequence of random
// numbers.

#include "renderlib/gallery/book_scenes.h"

#include <cstdint>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/string_view.h"
#include "renderlib/base/split_mix.h"
#include "renderlib/math/vec.h"

namespace bandsaw::gallery {
namespace {

/// A fixed sequence of numbers by which the shapes of a generated scene are placed.
class Numbers {
 public:
  explicit Numbers(std::uint64_t seed) : state_(seed) {}

  /// Returns a number in [0, 1).
  double next() {
    state_ += kSplitMixIncrement;
    return static_cast<double>(split_mix(state_) >> 11) * 0x1p-53;
  }
  double between(double low, double high) { return low + (high - low) * next(); }
  /// Returns a vector whose coordinates lie between the two numbers.
  Vec3 vec(double low, double high) {
    const double x = between(low, high);
    const double y = between(low, high);
    return {x, y, between(low, high)};
  }

 private:
  std::uint64_t state_;
};

std::string list(const Vec3& v) { return absl::StrFormat("[%.4g, %.4g, %.4g]", v.x, v.y, v.z); }

/// Returns a sphere as text of a scene file. `more` is the text of further fields of the shape.
std::string sphere(const Vec3& center, double radius, absl::string_view material,
                   absl::string_view more = "") {
  return absl::StrFormat("shape { sphere { center: %s  radius: %g }  material: \"%s\"%s }\n",
                         list(center), radius, material, more);
}

std::string material(absl::string_view name, absl::string_view kind) {
  return absl::StrFormat("material { name: \"%s\"  %s }\n", name, kind);
}

std::string color(const Vec3& rgb) { return absl::StrCat("color { rgb: ", list(rgb), " }"); }

/// Returns one of the small spheres, and its material unless it is glass. All spheres of glass
/// share one material.
std::string small_sphere(int number, const Vec3& center, bool bouncing, Numbers& numbers) {
  constexpr double kRadius = 0.2;
  const std::string name = absl::StrCat("s", number);
  const double choice = numbers.next();
  if (choice < 0.8) {
    const Vec3 a = numbers.vec(0, 1);
    const Vec3 b = numbers.vec(0, 1);
    const Vec3 product{a.x * b.x, a.y * b.y, a.z * b.z};
    const std::string moves =
        bouncing ? absl::StrFormat("  velocity: [0, %.4g, 0]", numbers.between(0, 0.5)) : "";
    return material(name, absl::StrCat("diffuse { ", color(product), " }")) +
           sphere(center, kRadius, name, moves);
  }
  if (choice < 0.95) {
    const Vec3 tint = numbers.vec(0.5, 1);
    const std::string fuzz = absl::StrFormat("  fuzz: %.4g", numbers.between(0, 0.5));
    return material(name, absl::StrCat("metal { ", color(tint), fuzz, " }")) +
           sphere(center, kRadius, name);
  }
  return sphere(center, kRadius, "glass");
}

/// Returns 20 x 20 boxes of random heights, the ground of the last scene of the second book.
std::string ground_of_boxes() {
  constexpr int kBoxesPerSide = 20;
  constexpr double kWidth = 100;
  Numbers numbers(/*seed=*/1);
  std::string out;
  for (int i = 0; i < kBoxesPerSide; ++i) {
    for (int j = 0; j < kBoxesPerSide; ++j) {
      const double x = -1000 + i * kWidth;
      const double z = -1000 + j * kWidth;
      absl::StrAppendFormat(&out,
                            "shape { box { min: [%g, 0, %g]  max: [%g, %.4g, %g] }  "
                            "material: \"ground\" }\n",
                            x, z, x + kWidth, numbers.between(1, 101), z + kWidth);
    }
  }
  return out;
}

/// Returns a group of 1000 spheres at random places in a cube, and the instance that places it.
std::string cube_of_spheres() {
  constexpr int kSpheres = 1000;
  Numbers numbers(/*seed=*/2);
  std::string out = "group {\n  name: \"cube\"\n";
  for (int i = 0; i < kSpheres; ++i) {
    absl::StrAppend(&out, "  ", sphere(numbers.vec(0, 165), 10, "white"));
  }
  return out +
         "}\ninstance { of: \"cube\"  rotate { axis: [0, 1, 0]  degrees: 15 }  "
         "translate: [-100, 270, 395] }\n";
}

constexpr absl::string_view kNextWeek =
    R"(# The last scene of "Ray Tracing: The Next Week" (Shirley, Black and Hollasch), chapter 10.
# Made by bandsaw-gallery, as is the map of the globe.
camera { position: [478, 278, -600]  look_at: [278, 278, 0]  vertical_fov: 40  shutter_close: 1 }
image { width: 800  height: 800 }
integrator { max_depth: 40 }
background { constant { rgb: [0, 0, 0] } }

material { name: "ground"  diffuse { color { rgb: [0.48, 0.83, 0.53] } } }
material { name: "light"  emissive { radiance { rgb: [7, 7, 7] } } }
material { name: "clay"  diffuse { color { rgb: [0.7, 0.3, 0.1] } } }
material { name: "glass"  dielectric { index_of_refraction: 1.5 } }
material { name: "satin"  metal { color { rgb: [0.8, 0.8, 0.9] }  fuzz: 1 } }
material { name: "globe"  diffuse { texture { image { file: "globe_512.png"  wrap_v: WRAP_CLAMP } } } }
material { name: "noise"  diffuse { texture { noise { kind: KIND_MARBLE  scale: 0.1  strength: 10 } } } }
material { name: "white"  diffuse { color { rgb: [0.73, 0.73, 0.73] } } }
medium { name: "mist"  albedo { rgb: [1, 1, 1] }  density: 0.0001 }
medium { name: "blue"  albedo { rgb: [0.2, 0.4, 0.9] }  density: 0.2 }

shape { quad { corner: [123, 554, 147]  u: [300, 0, 0]  v: [0, 0, 265] }  material: "light" }
shape { sphere { center: [400, 400, 200]  radius: 50 }  material: "clay"  velocity: [30, 0, 0] }
shape { sphere { center: [260, 150, 45]  radius: 50 }  material: "glass" }
shape { sphere { center: [0, 150, 145]  radius: 50 }  material: "satin" }
shape { sphere { center: [360, 150, 145]  radius: 70 }  material: "glass"  interior: "blue" }
shape { sphere { center: [0, 0, 0]  radius: 5000 }  interior: "mist" }
shape { sphere { center: [400, 200, 400]  radius: 100 }  material: "globe" }
shape { sphere { center: [220, 280, 300]  radius: 80 }  material: "noise" }
)";

constexpr absl::string_view kOneWeekend =
    R"(# The last scene of "Ray Tracing in One Weekend" (Shirley, Black and Hollasch), chapter 14.
# Made by bandsaw-gallery.
)";

constexpr absl::string_view kBouncing =
    R"(# The first scene of "Ray Tracing: The Next Week" (Shirley, Black and Hollasch), section 2.6: small spheres jump while
# the shutter is open. Made by bandsaw-gallery.
)";

constexpr absl::string_view kOnTheGround =
    R"(integrator { max_depth: 50 }
background { gradient { bottom { rgb: [1, 1, 1] }  top { rgb: [0.5, 0.7, 1] } } }

material { name: "ground"  diffuse { color { rgb: [0.5, 0.5, 0.5] } } }
material { name: "glass"  dielectric { index_of_refraction: 1.5 } }
material { name: "brown"  diffuse { color { rgb: [0.4, 0.2, 0.1] } } }
material { name: "bronze"  metal { color { rgb: [0.7, 0.6, 0.5] } } }
shape { sphere { center: [0, -1000, 0]  radius: 1000 }  material: "ground" }
shape { sphere { center: [0, 1, 0]  radius: 1 }  material: "glass" }
shape { sphere { center: [-4, 1, 0]  radius: 1 }  material: "brown" }
shape { sphere { center: [4, 1, 0]  radius: 1 }  material: "bronze" }
)";

}  // namespace

std::string many_spheres(bool bouncing) {
  // A defocus angle of 0.6 degrees corresponds to a lens diameter of 2 x 10 x tan(0.3 degrees).
  std::string out = absl::StrCat(
      bouncing ? kBouncing : kOneWeekend,
      "camera { position: [13, 2, 3]  look_at: [0, 0, 0]  vertical_fov: 20  aperture: 0.10472  "
      "focus_distance: 10",
      bouncing ? "  shutter_close: 1 }\n" : " }\n",
      bouncing ? "image { width: 400  height: 225 }\n" : "image { width: 1200  height: 675 }\n",
      kOnTheGround);
  Numbers numbers(/*seed=*/bouncing ? 4 : 3);
  for (int a = -11; a < 11; ++a) {
    for (int b = -11; b < 11; ++b) {
      const double x = a + numbers.between(0, 0.9);
      const Vec3 center{x, 0.2, b + numbers.between(0, 0.9)};
      if (length(center - Vec3{4, 0.2, 0}) > 0.9) {
        absl::StrAppend(&out, small_sphere((a + 11) * 22 + b + 11, center, bouncing, numbers));
      }
    }
  }
  return out;
}

std::string next_week_final() {
  return absl::StrCat(kNextWeek, "\n# The ground.\n", ground_of_boxes(),
                      "\n# A cube of small spheres.\n", cube_of_spheres());
}

}  // namespace bandsaw::gallery
