// The generated files in the repository are equal to the output of bandsaw-gallery. The file also
// tests the lathe, which rotates a profile around the y axis and so makes the meshes of turned
// objects.

#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>

#include "renderlib/gallery/book_scenes.h"
#include "renderlib/gallery/hard_light.h"
#include "renderlib/gallery/lathe.h"
#include "renderlib/gallery/pergola.h"
#include "renderlib/gallery/sky.h"
#include "renderlib/gallery/turned.h"
#include "renderlib/gallery/volumes.h"
#include "renderlib/image/hdr.h"
#include "renderlib/math/vec.h"

namespace bandsaw::gallery {
namespace {

/// Returns the bytes of a file of the gallery in the repository.
std::string kept(const std::string& name) {
  std::ifstream file(std::string(BANDSAW_GALLERY) + "/" + name, std::ios::binary);
  EXPECT_TRUE(file.good()) << name;
  std::ostringstream bytes;
  bytes << file.rdbuf();
  return bytes.str();
}

/// Returns the bytes as a string, to compare them with kept().
std::string text(const std::vector<std::byte>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

TEST(MadeFiles, EqualTheFilesOfTheRepository) {
  EXPECT_TRUE(kept("vase.obj") == vase());
  EXPECT_TRUE(kept("pawn.obj") == pawn());
  EXPECT_TRUE(kept("lamp_foot.obj") == lamp_foot());
  EXPECT_TRUE(kept("lamp_shade.obj") == lamp_shade());
  EXPECT_TRUE(kept("hard_light/ring.obj") == ring());
  EXPECT_TRUE(kept("hard_light/waves.obj") == waves());
  EXPECT_TRUE(kept("pergola.gltf") == pergola());
  EXPECT_TRUE(kept("campfire_smoke.vol") == smoke_volume());
  EXPECT_TRUE(kept("campfire_flames.vol") == flame_volume());
  EXPECT_TRUE(kept("evening.hdr") == text(encode_hdr(evening_sky_map(64))));
  EXPECT_TRUE(kept("dusk.hdr") == text(encode_hdr(dusk_sky_map(128))));
  constexpr const char* kSides[] = {"px", "nx", "py", "ny", "pz", "nz"};
  for (std::uint32_t i = 0; i < 6; ++i) {
    EXPECT_TRUE(kept(std::string("evening_") + kSides[i] + ".hdr") ==
                text(encode_hdr(evening_sky_side(i, 48))));
  }
  EXPECT_TRUE(kept("books/one_weekend.textproto") == many_spheres(/*bouncing=*/false));
  EXPECT_TRUE(kept("books/bouncing_spheres.textproto") == many_spheres(/*bouncing=*/true));
  EXPECT_TRUE(kept("books/next_week.textproto") == next_week_final());
}

struct Obj {
  std::vector<Vec3> points, normals;
  std::vector<std::vector<std::size_t>> faces;
};

/// Reads the points, normals and faces of a Wavefront OBJ file. The number of a corner's point is
/// also the number of its normal.
Obj parse(const std::string& text) {
  Obj obj;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream in(line);
    std::string kind;
    in >> kind;
    Vec3 v;
    if (kind == "v" || kind == "vn") {
      in >> v.x >> v.y >> v.z;
      (kind == "v" ? obj.points : obj.normals).push_back(v);
    } else if (kind == "f") {
      obj.faces.emplace_back();
      for (std::string corner; in >> corner;) {
        obj.faces.back().push_back(std::stoul(corner) - 1);
      }
    }
  }
  return obj;
}

// Expects that the corners' normals of each face are unit vectors on the face's outer side.
void expect_normals_out(const Obj& obj) {
  for (const auto& face : obj.faces) {
    const Vec3& a = obj.points[face[0]];
    const Vec3 outside = cross(obj.points[face[1]] - a, obj.points[face[2]] - a);
    for (const std::size_t corner : face) {
      EXPECT_NEAR(length(obj.normals[corner]), 1, 2e-3);
      EXPECT_GT(dot(obj.normals[corner], outside), 0) << "a face at height " << a.y;
    }
  }
}

using Place = std::array<double, 3>;

// Expects that every edge occurs once in each direction. Two edges are the same if the positions of
// their ends are equal.
void expect_closed(const Obj& obj) {
  std::map<std::pair<Place, Place>, int> edges;
  const auto place = [&](std::size_t i) {
    return Place{obj.points[i].x + 0.0, obj.points[i].y + 0.0, obj.points[i].z + 0.0};
  };
  for (const auto& face : obj.faces) {
    for (std::size_t i = 0; i < face.size(); ++i) {
      ++edges[{place(face[i]), place(face[(i + 1) % face.size()])}];
    }
  }
  for (const auto& [edge, times] : edges) {
    EXPECT_EQ(times, 1);
    EXPECT_TRUE(edges.contains({edge.second, edge.first}));
  }
}

TEST(Lathe, TurnsClosedMeshesWithNormalsOutwards) {
  for (const std::string& text : {vase(), pawn(), lamp_foot(), lamp_shade()}) {
    const Obj obj = parse(text);
    EXPECT_GT(obj.faces.size(), 100u);
    expect_normals_out(obj);
    expect_closed(obj);
  }
}

// A cone that is turned in n steps has n faces at its foot and n faces at its side. The edge of the
// foot is sharp, so the foot's normals point down, and foot and side have separate points. The foot
// has two rings of n + 1 points, and the side has two more. Here n is 8, so the first point of the
// side has the index 18.
TEST(Lathe, KeepsSharpEdges) {
  const Obj cone = parse(lathe_obj(std::array<Vec2, 3>{{{0, 0}, {1, 0}, {0, 1}}}, 8));
  EXPECT_EQ(cone.faces.size(), 16u);
  EXPECT_EQ(cone.points.size(), 4u * 9);
  EXPECT_EQ(cone.normals[0], (Vec3{0, -1, 0}));
  EXPECT_NEAR(cone.normals[18].y, std::sqrt(0.5), 1e-3);
}

// Four steps lead from each corner to the next, so the profile has 3 * 4 + 1 points.
TEST(Lathe, ASmoothProfilePassesThroughItsCorners) {
  const std::vector<Vec2> corners = {{1, 0}, {2, 1}, {0.5, 3}, {0, 4}};
  const std::vector<Vec2> points = smooth_profile(corners, 4);
  ASSERT_EQ(points.size(), 13u);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    EXPECT_EQ(points[4 * i], corners[i]);
  }
}

}  // namespace
}  // namespace bandsaw::gallery
