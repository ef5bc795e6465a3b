// The meshes of kernel_bench, selected by name, or read from a file with Assimp.

#include "tests/bench/kernel_meshes.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/Importer.hpp>

#include "tests/support/meshes.h"

namespace bandsaw::bench {
namespace {

/// Returns all triangles of a file that Assimp reads; empty if Assimp cannot read the file.
Mesh from_file(const std::string& path) {
  Assimp::Importer importer;
  const aiScene* scene =
      importer.ReadFile(path, aiProcess_Triangulate | aiProcess_JoinIdenticalVertices |
                                  aiProcess_PreTransformVertices);
  Mesh mesh;
  for (unsigned m = 0; scene != nullptr && m < scene->mNumMeshes; ++m) {
    const aiMesh& part = *scene->mMeshes[m];
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (unsigned i = 0; i < part.mNumVertices; ++i) {
      mesh.positions.push_back({part.mVertices[i].x, part.mVertices[i].y, part.mVertices[i].z});
    }
    for (unsigned i = 0; i < part.mNumFaces; ++i) {
      const aiFace& face = part.mFaces[i];
      if (face.mNumIndices == 3) {
        mesh.triangles.push_back(
            {first + face.mIndices[0], first + face.mIndices[1], first + face.mIndices[2]});
      }
    }
  }
  return mesh;
}

/// Returns the mesh with a box of twelve triangles around it.
Mesh in_a_room(Mesh mesh) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (std::uint32_t i = 0; i < 8; ++i) {
    mesh.positions.push_back({i & 1u ? 3.0f : -3.0f, i & 2u ? 3.0f : -3.0f, i & 4u ? 3.0f : -3.0f});
  }
  const std::uint32_t sides[6][4] = {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                     {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}};
  for (const auto& s : sides) {
    mesh.triangles.push_back({first + s[0], first + s[1], first + s[2]});
    mesh.triangles.push_back({first + s[0], first + s[2], first + s[3]});
  }
  return mesh;
}

}  // namespace

Mesh bench_mesh(const std::string& name) {
  if (name == "icosphere") {
    return test::icosphere(/*levels=*/7);
  }
  if (name == "needles") {
    return test::rough_sphere(/*slices=*/20'000, /*stacks=*/12, /*spread=*/6, /*seed=*/1);
  }
  if (name == "soup") {
    return test::triangle_soup(/*count=*/200'000, /*size=*/0.03, /*seed=*/3);
  }
  if (name == "room") {
    return in_a_room(
        test::rough_sphere(/*slices=*/500, /*stacks=*/250, /*spread=*/1.05, /*seed=*/2));
  }
  return from_file(name);
}

}  // namespace bandsaw::bench
