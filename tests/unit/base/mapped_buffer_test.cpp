// Tests large buffers. MappedBuffer::create() takes the size in bytes and a folder. The buffer is a
// file without a name in this folder, mapped into memory; without a folder it is plain memory.

#include "renderlib/base/mapped_buffer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "tests/support/temp_dir.h"

namespace bandsaw {
namespace {

/// Expects that the buffer has `size` bytes of zeros, can be written, and keeps its content when it
/// is moved.
void expect_usable(MappedBuffer& buffer, std::size_t size) {
  ASSERT_EQ(buffer.size(), size);
  const absl::Span<double> numbers = buffer.as<double>();
  EXPECT_TRUE(std::all_of(numbers.begin(), numbers.end(), [](double x) { return x == 0; }));
  numbers.back() = 2.5;
  MappedBuffer moved = std::move(buffer);
  EXPECT_EQ(moved.as<double>().back(), 2.5);
  buffer = std::move(moved);
  EXPECT_EQ(buffer.as<double>().back(), 2.5);
}

TEST(MappedBuffer, IsFilledWithZeros) {
  absl::StatusOr<MappedBuffer> buffer = MappedBuffer::create(80000, "");
  ASSERT_TRUE(buffer.ok()) << buffer.status();
  expect_usable(*buffer, 80000);
}

TEST(MappedBuffer, IsBackedByAFileWithoutAName) {
  const test::TempDir dir;
  absl::StatusOr<MappedBuffer> buffer = MappedBuffer::create(80000, dir.path());
  ASSERT_TRUE(buffer.ok()) << buffer.status();
  EXPECT_TRUE(std::filesystem::is_empty(dir.path()));
  expect_usable(*buffer, 80000);
}

TEST(MappedBuffer, MayBeEmpty) {
  absl::StatusOr<MappedBuffer> buffer = MappedBuffer::create(0, "");
  ASSERT_TRUE(buffer.ok());
  EXPECT_EQ(buffer->size(), 0u);
}

TEST(MappedBuffer, ReportsTheSystemsError) {
  EXPECT_EQ(MappedBuffer::create(std::size_t{1} << 62, "").status().code(),
            absl::StatusCode::kResourceExhausted);
  EXPECT_EQ(MappedBuffer::create(8, "/no/such/folder").status().code(),
            absl::StatusCode::kNotFound);
}

TEST(MappedBuffer, AFullDiskIsDetectedAtOnce) {
  const test::TempDir dir;
  const absl::Status status = MappedBuffer::create(std::size_t{1} << 60, dir.path()).status();
  EXPECT_FALSE(status.ok());
  EXPECT_NE(status.message().find(dir.path()), std::string::npos) << status;
  EXPECT_TRUE(std::filesystem::is_empty(dir.path()));
}

}  // namespace
}  // namespace bandsaw
