// Packages with more primitives than BVHs can hold are refused as soon as the manifest is read,
// before any blob is read.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "proto/package.pb.h"
#include "renderlib/accel/capacity.h"
#include "tests/unit/package/sample_scene.h"

namespace bandsaw {
namespace {

using test::sample_info;
using test::sample_scene;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// A source that has no blobs and counts the requests for blobs.
class NoBlobs : public BlobSource {
 public:
  absl::StatusOr<std::unique_ptr<BlobBytes>> get(const wire::Digest&) override {
    ++asked;
    return absl::NotFoundError("no blob");
  }
  int asked = 0;
};

package::Manifest sample_manifest() {
  BlobMap blobs;
  package::Manifest manifest;
  EXPECT_TRUE(manifest.ParseFromString(encode_package(sample_scene(), sample_info(), blobs)));
  return manifest;
}

/// Returns the error of a package whose manifest was changed by `change`. Expects that no blob is
/// requested.
std::string error_after(const std::function<void(package::Manifest&)>& change) {
  package::Manifest manifest = sample_manifest();
  change(manifest);
  const std::string bytes = manifest.SerializeAsString();
  NoBlobs blobs;
  const absl::Status status = decode_package(bytes, blobs).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument) << status;
  EXPECT_EQ(blobs.asked, 0) << "no blob may be read before the counts are checked";
  EXPECT_EQ(package_info(bytes).status(), status)
      << "the error must be the same when only the manifest is read";
  return std::string(status.message());
}

// The blob `indices` has 12 bytes for each triangle.
TEST(Counts, MeshesLargerThanABvhHoldsAreRefusedUnread) {
  EXPECT_EQ(error_after([](package::Manifest& m) {
              m.mutable_mesh(1)->mutable_indices()->set_size(12 * (kMaxTreeItems + 1));
            }),
            "scene package: mesh[1]: has 536870912 triangles, a mesh holds at most 536870911: "
            "split it into several meshes");
  EXPECT_THAT(error_after([](package::Manifest& m) {
                m.mutable_boundaries()->mutable_mesh(0)->mutable_indices()->set_size(
                    12 * (kMaxTreeItems + 1));
              }),
              StartsWith("scene package: boundaries.mesh[0]: has 536870912 triangles"));
}

// Loose shapes are those that are not part of a mesh. In a BVH, a quad takes two items, and any
// other shape takes one. A blob has 24 bytes for each corner or centre.
TEST(Counts, MoreLooseShapesThanABvhHoldsAreRefusedUnread) {
  constexpr std::uint64_t kQuads = std::uint64_t{1} << 28;
  EXPECT_THAT(error_after([](package::Manifest& m) {
                m.mutable_quads()->mutable_corners()->set_size(24 * kQuads);
              }),
              HasSubstr("268435456 quads"));
  EXPECT_THAT(error_after([](package::Manifest& m) {
                m.mutable_group(0)->mutable_quads()->mutable_corners()->set_size(24 * kQuads);
              }),
              StartsWith("scene package: group[0]: has "));
  EXPECT_THAT(error_after([](package::Manifest& m) {
                m.mutable_spheres()->mutable_centers()->set_size(24 * kQuads);
                m.mutable_disks()->mutable_centers()->set_size(24 * kQuads);
              }),
              StartsWith("scene package: shapes: has 268435456 spheres"));
}

TEST(Counts, TheMaximumThatABvhHoldsIsRead) {
  package::Manifest manifest = sample_manifest();
  package::Blob& indices = *manifest.mutable_mesh(1)->mutable_indices();
  indices.set_size(12 * kMaxTreeItems);
  indices.set_sha256(std::string(32, 'x'));  // no blob has this digest
  NoBlobs blobs;
  EXPECT_EQ(decode_package(manifest.SerializeAsString(), blobs).status().code(),
            absl::StatusCode::kNotFound);
  EXPECT_EQ(blobs.asked, 1);
}

}  // namespace
}  // namespace bandsaw
