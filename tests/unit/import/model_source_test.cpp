// Renders the albedo and the normals of the spider, a textured model of Assimp's test suite.
// Compares them with values that the test itself computes from the OBJ and MTL files. The albedo
// must be Kd times the texel at the hit point's uv. The normals must be those of the OBJ file.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <sstream>

#include "renderlib/base/file.h"
#include "renderlib/image/srgb.h"
#include "renderlib/import/image/decode_image.h"
#include "tests/unit/import/files.h"
#include "tests/unit/import/layer.h"

namespace bandsaw {
namespace {

using test::test_model;

/// A material of the MTL file.
struct Look {
  Vec3 tint;  ///< Kd
  ImageTexture image;
};

/// Returns the bilinear interpolation of the four texels around (u, v). The image repeats. Its
/// bottom is at v = 0.
Vec3 looked_up(const ImageTexture& image, double u, double v) {
  const double x = (u - std::floor(u)) * image.width - 0.5;
  const double y = (1 - (v - std::floor(v))) * image.height - 0.5;
  const auto texel = [&](double column, double row) {
    const auto wrapped = [](double at, std::uint32_t count) {
      return static_cast<std::size_t>(at + count) % count;
    };
    const std::size_t first =
        3 * (wrapped(row, image.height) * image.width + wrapped(column, image.width));
    const auto value = [&](std::size_t c) {
      return double{srgb_table()[static_cast<std::size_t>(image.texels.data()[first + c])]};
    };
    return Vec3{value(0), value(1), value(2)};
  };
  const double left = std::floor(x);
  const double top = std::floor(y);
  const double fx = x - left;
  const double fy = y - top;
  return (texel(left, top) * (1 - fx) + texel(left + 1, top) * fx) * (1 - fy) +
         (texel(left, top + 1) * (1 - fx) + texel(left + 1, top + 1) * fx) * fy;
}

Vec3 tinted(const Vec3& a, const Vec3& by) { return {a.x * by.x, a.y * by.y, a.z * by.z}; }

struct Corner {
  Vec3 position;
  Vec3 uv;
  Vec3 normal;
};

/// An OBJ of triangles whose corners have uvs and normals, with its MTL.
struct Obj {
  std::vector<std::pair<std::array<Corner, 3>, std::string>>
      triangles;  ///< triangles and their materials
  std::map<std::string, Look> looks;
};

/// Reads Kd and map_Kd of each material. `folder` ends with a slash.
std::map<std::string, Look> read_mtl(const std::string& folder, const std::string& name) {
  std::map<std::string, Look> looks;
  std::istringstream lines(read_whole_file(folder + name, 1 << 20).value());
  Look* look = nullptr;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream in(line);
    std::string word;
    in >> word;
    if (word == "newmtl") {
      in >> word;
      look = &looks[word];
    } else if (word == "Kd") {
      in >> look->tint.x >> look->tint.y >> look->tint.z;
    } else if (word == "map_Kd") {
      in >> word;  // as in ".\skin.jpg"
      std::vector<std::string> warnings;
      const std::string file = folder + word.substr(word.rfind('\\') + 1);
      look->image = decode_image(read_whole_file(file, 1 << 24).value(), warnings).value();
    }
  }
  return looks;
}

/// Reads an OBJ file whose faces are triangles with corners of the form v/vt/vn. `folder` ends with
/// a slash.
Obj read_obj(const std::string& folder, const std::string& name) {
  Obj obj;
  std::vector<Vec3> v;
  std::vector<Vec3> vt;
  std::vector<Vec3> vn;
  std::istringstream lines(read_whole_file(folder + name, 1 << 24).value());
  std::string material;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream in(line);
    std::string word;
    in >> word;
    Vec3 p;
    if (word == "v" || word == "vt" || word == "vn") {
      in >> p.x >> p.y >> p.z;
      (word == "v" ? v : word == "vt" ? vt : vn).push_back(p);
    } else if (word == "usemtl") {
      in >> material;
    } else if (word == "mtllib") {
      in >> word;
      obj.looks = read_mtl(folder, word);
    } else if (word == "f") {
      std::array<Corner, 3> corners;
      for (Corner& corner : corners) {
        std::size_t at[3] = {};
        char slash = 0;
        in >> at[0] >> slash >> at[1] >> slash >> at[2];
        corner = {v.at(at[0] - 1), vt.at(at[1] - 1), vn.at(at[2] - 1)};
      }
      obj.triangles.emplace_back(corners, material);
    }
  }
  return obj;
}

struct Hit {
  double z = 0;
  Vec3 albedo;
  Vec3 normal;
};

/// Returns the nearest hit at (x, y) for a viewer who looks along -z, or std::nullopt if there is
/// none. `doubtful` is set to true if the hit is at an edge, or if two surfaces are equally near.
std::optional<Hit> hit_at(const Obj& obj, double x, double y, bool& doubtful) {
  std::optional<Hit> nearest;
  doubtful = false;
  for (const auto& [corners, material] : obj.triangles) {
    // No structured binding, because clang 14 does not capture one in a lambda.
    const Corner& a = corners[0];
    const Corner& b = corners[1];
    const Corner& c = corners[2];
    // Returns twice the signed area of the triangle of `from`, `to` and (x, y).
    const auto side = [&](const Vec3& from, const Vec3& to) {
      return (to.x - from.x) * (y - from.y) - (to.y - from.y) * (x - from.x);
    };
    const double area =
        side(a.position, b.position) + side(b.position, c.position) + side(c.position, a.position);
    if (!(std::abs(area) > 1e-9)) {
      continue;  // seen edge-on
    }
    const double wa = side(b.position, c.position) / area;
    const double wb = side(c.position, a.position) / area;
    const double wc = 1 - wa - wb;
    const double least = std::min({wa, wb, wc});
    if (!(least > -1e-4)) {
      continue;
    }
    // Interpolates an attribute of the corners at (x, y).
    const auto at = [&](const auto& of) { return of(a) * wa + of(b) * wb + of(c) * wc; };
    const double z = at([](const Corner& k) { return k.position; }).z;
    if (nearest && z < nearest->z - 1e-3) {
      continue;
    }
    doubtful = least < 1e-4 || (nearest && z < nearest->z + 1e-3);
    const Look& look = obj.looks.at(material);
    const Vec3 uv = at([](const Corner& k) { return k.uv; });
    nearest = Hit{z, tinted(looked_up(look.image, uv.x, uv.y), look.tint),
                  normalize(at([](const Corner& k) { return k.normal; }))};
  }
  return nearest;
}

TEST(ModelSource, TheSpidersAlbedoAndNormalsAreThoseOfItsFiles) {
  if (!test::have_test_models()) {
    GTEST_SKIP() << "the package assimp-testmodels is not installed";
  }
  const Obj spider = read_obj(test_model("OBJ/"), "spider.obj");
  ASSERT_EQ(spider.triangles.size(), 1368u);
  auto imported = import_scene(test_model("OBJ/spider.obj"));
  ASSERT_TRUE(imported.ok()) << imported.status();
  constexpr std::uint32_t kWidth = 120;
  constexpr std::uint32_t kHeight = 80;
  constexpr double kPixel = 1.4;  // width of a pixel; the middle of the image is at (-17, -2)
  imported->scene.filter = {PixelFilter::Kind::kBox, 0};
  imported->scene.camera = OrthographicCamera{
      .position = {-17, -2, 500}, .look_at = {-17, -2, 0}, .height = kPixel * kHeight};
  const Image albedo = test::layer(*imported, kWidth, kHeight, Integrator::kAlbedo);
  const Image normals = test::layer(*imported, kWidth, kHeight, Integrator::kNormals);
  int compared = 0;
  int doubtful = 0;
  for (std::uint32_t row = 0; row < kHeight; ++row) {
    for (std::uint32_t column = 0; column < kWidth; ++column) {
      bool is_doubtful = false;
      const auto hit = hit_at(spider, -17 + (column + 0.5 - kWidth / 2.0) * kPixel,
                              -2 - (row + 0.5 - kHeight / 2.0) * kPixel, is_doubtful);
      doubtful += is_doubtful ? 1 : 0;
      if (!hit || is_doubtful) {
        continue;
      }
      ++compared;
      const std::size_t i = row * kWidth + column;
      // A texel times Kd is rounded to an 8-bit code again. The error of half a code is at most
      // 0.0045 in linear light.
      const Rgb& seen = albedo.pixels[i];
      EXPECT_LE(max_abs(Vec3{seen.r, seen.g, seen.b} - hit->albedo), 0.0046)
          << "at " << column << ", " << row;
      const Rgb& n = normals.pixels[i];
      // Normals are shown on the side that faces the viewer, so their sign is not compared.
      EXPECT_GE(std::abs(dot(Vec3{2.0 * n.r - 1, 2.0 * n.g - 1, 2.0 * n.b - 1}, hit->normal)),
                1 - 1e-4)
          << "at " << column << ", " << row;
    }
  }
  EXPECT_GE(compared, 1000);
  EXPECT_LE(doubtful, compared / 10);
}

}  // namespace
}  // namespace bandsaw
