// Reads Mitsuba's *.vol files. They have these values, little-endian and without gaps:
//
//   "VOL", uint8 version = 3
//   int32 encoding: 1 float32; 2 float16; 3 uint8 (n stands for n / 255)
//   int32 cells in x, y, z; int32 channels
//   float32 x 6: the box, least x y z, largest x y z
//   the numbers: x fastest, then y, then z; the channels of a cell together

#include <array>
#include <cmath>
#include <cstring>
#include <optional>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "renderlib/import/volume/volume_file.h"
#include "renderlib/medium/brick_builder.h"

namespace bandsaw {
namespace {

constexpr std::size_t kHeaderBytes = 48;

struct Header {
  std::int32_t encoding = 0;
  std::array<std::int32_t, 3> cells = {};
  std::int32_t channels = 0;
  std::array<float, 6> box = {};
};

template <class T>
T load(const std::byte* from) {
  T value;
  std::memcpy(&value, from, sizeof(T));
  return value;
}

Header read_header(const std::byte* bytes) {
  Header header;
  header.encoding = load<std::int32_t>(bytes + 4);
  header.cells = load<std::array<std::int32_t, 3>>(bytes + 8);
  header.channels = load<std::int32_t>(bytes + 20);
  header.box = load<std::array<float, 6>>(bytes + 24);
  return header;
}

/// Returns the size of a number in bytes; 0 if the encoding is unknown.
std::uint64_t number_bytes(std::int32_t encoding) {
  return encoding == 1 ? 4 : encoding == 2 ? 2 : encoding == 3 ? 1 : 0;
}

absl::Status check_header(const Header& header) {
  if (number_bytes(header.encoding) == 0) {
    return absl::InvalidArgumentError(
        absl::StrCat("has encoding ", header.encoding,
                     "; only 1 (float32), 2 (float16) and 3 (8 bits) can be read"));
  }
  for (const std::int32_t side : header.cells) {
    if (side < 1 || side > static_cast<std::int32_t>(kMaxGridSide)) {
      return absl::InvalidArgumentError(
          absl::StrCat("has a side of ", side, " cells, must be in [1, ", kMaxGridSide, "]"));
    }
  }
  if (header.channels != 1 && header.channels != 3) {
    return absl::InvalidArgumentError(
        absl::StrCat("has ", header.channels, " channels; only 1 or 3 can be read"));
  }
  for (std::size_t k = 0; k < 3; ++k) {
    if (!(std::isfinite(header.box[k]) && std::isfinite(header.box[k + 3]) &&
          header.box[k] < header.box[k + 3])) {
      return absl::InvalidArgumentError(absl::StrCat("has a box from ", header.box[k], " to ",
                                                     header.box[k + 3], " along axis ", k));
    }
  }
  return absl::OkStatus();
}

float number_at(const std::byte* numbers, std::int32_t encoding, std::size_t i) {
  switch (encoding) {
    case 1:
      return load<float>(numbers + 4 * i);
    case 2:
      return half_to_float(load<std::uint16_t>(numbers + 2 * i));
    default:
      return static_cast<float>(static_cast<std::uint8_t>(numbers[i])) / 255;
  }
}

}  // namespace

absl::StatusOr<FileGrid> read_vol(absl::Span<const std::byte> bytes) {
  if (bytes.size() < kHeaderBytes || std::memcmp(bytes.data(), "VOL", 3) != 0) {
    return absl::InvalidArgumentError("is no *.vol file, or its header is damaged");
  }
  if (const int version = static_cast<int>(bytes[3]); version != 3) {
    return absl::InvalidArgumentError(
        absl::StrCat("has version ", version, "; only version 3 can be read"));
  }
  const Header header = read_header(bytes.data());
  if (const absl::Status good = check_header(header); !good.ok()) {
    return good;
  }
  const std::array<std::uint32_t, 3> cells = {static_cast<std::uint32_t>(header.cells[0]),
                                              static_cast<std::uint32_t>(header.cells[1]),
                                              static_cast<std::uint32_t>(header.cells[2])};
  const auto channels = static_cast<std::uint32_t>(header.channels);
  // Each of the three sides has at most kMaxGridSide = 2^20 cells, so the product of the sides is
  // at most 2^60 and does not overflow.
  const std::uint64_t claimed = std::uint64_t{cells[0]} * cells[1] * cells[2];
  const std::uint64_t most = (bytes.size() - kHeaderBytes) / number_bytes(header.encoding);
  if (claimed > most / channels) {
    return absl::InvalidArgumentError(
        absl::StrCat("claims ", cells[0], " x ", cells[1], " x ", cells[2], " cells of ", channels,
                     " channels, and has ", most, " numbers: it is cut off or damaged"));
  }
  if (all_bricks(cells) > kMaxGridBricks) {
    return absl::ResourceExhaustedError(absl::StrCat("has ", all_bricks(cells),
                                                     " bricks of 8 x 8 x 8 cells, at most ",
                                                     kMaxGridBricks, " are read"));
  }
  FileGrid result;
  std::optional<std::size_t> broken;
  const std::byte* const numbers = bytes.data() + kHeaderBytes;
  result.grid = dense_grid(cells, channels, [&](std::size_t i) {
    const float number = number_at(numbers, header.encoding, i);
    if (!std::isfinite(number)) {
      broken = broken.value_or(i);
      return 0.0f;
    }
    result.negative += number < 0 ? 1 : 0;
    return number > 0 ? number : 0.0f;
  });
  if (broken) {
    return absl::InvalidArgumentError(absl::StrCat(
        "number ", *broken, " is ", number_at(numbers, header.encoding, *broken), ", not finite"));
  }
  const Vec3 low{header.box[0], header.box[1], header.box[2]};
  const Vec3 high{header.box[3], header.box[4], header.box[5]};
  const Vec3 cell{1.0 / cells[0], 1.0 / cells[1], 1.0 / cells[2]};
  result.to_unit_box = scaling(cell);
  result.grid.to_medium = translation(low) * scaling(high - low) * result.to_unit_box;
  return result;
}

}  // namespace bandsaw
