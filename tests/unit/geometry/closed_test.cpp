// The check whether a mesh is closed. A mesh that bounds a medium must be closed.

#include "renderlib/geometry/closed.h"

#include <gtest/gtest.h>

#include "renderlib/scene/media.h"
#include "tests/support/scenes.h"

namespace bandsaw {
namespace {

TEST(Closed, ACubeIsClosedAlsoWithSplitCorners) {
  Mesh cube = unit_cube();
  EXPECT_EQ(open_edges(cube), 0u);
  // Every triangle has its own corners, as in files. Some zeros are -0, which equals 0.
  Mesh split;
  for (auto& triangle : cube.triangles) {
    for (std::uint32_t& corner : triangle) {
      auto position = cube.positions[corner];
      position[0] = position[0] == 0 && corner % 3 == 0 ? -0.0f : position[0];
      split.positions.push_back(position);
      corner = static_cast<std::uint32_t>(split.positions.size() - 1);
    }
  }
  split.triangles = cube.triangles;
  EXPECT_EQ(open_edges(split), 0u);
}

// If corners at the same place move apart before the shutter closes, they leave a hole. Here the
// first triangle gets a corner of its own (number 8), which moves away. Then two edges of the
// triangle and two edges of its neighbours are open.
TEST(Closed, ADeformingMeshIsClosedIfItIsClosedAtShutterOpenAndClose) {
  Mesh cube = unit_cube();
  cube.positions_at_close = cube.positions;
  cube.positions_at_close[3] = {2, 3, 0.5f};
  EXPECT_EQ(open_edges(cube), 0u);
  const std::uint32_t split = cube.triangles[0][0];
  cube.positions.push_back(cube.positions[split]);
  cube.positions_at_close.push_back(cube.positions_at_close[split]);
  cube.triangles[0][0] = 8;
  EXPECT_EQ(open_edges(cube), 0u);
  cube.positions_at_close[8][0] += 0.25f;
  EXPECT_EQ(open_edges(cube), 4u);
}

TEST(Closed, CountsTheEdgesOfAHole) {
  Mesh cube = unit_cube();
  cube.triangles.pop_back();
  EXPECT_EQ(open_edges(cube), 3u);
  cube.triangles.pop_back();
  EXPECT_EQ(open_edges(cube), 4u);
  EXPECT_EQ(open_edges(test::grid(3)), 12u);  // the rim of a flat grid of 3 x 3 squares
}

TEST(Closed, AMeshWithAFlippedTriangleIsNotClosed) {
  Mesh cube = unit_cube();
  std::swap(cube.triangles[4][0], cube.triangles[4][1]);
  EXPECT_EQ(open_edges(cube), 3u);
}

TEST(Closed, TrianglesWithoutAreaChangeNothing) {
  Mesh cube = unit_cube();
  cube.triangles.push_back({1, 1, 1});
  cube.triangles.push_back({1, 2, 1});
  EXPECT_EQ(open_edges(cube), 0u);
}

}  // namespace
}  // namespace bandsaw
