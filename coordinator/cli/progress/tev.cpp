// The class Packet assembles one packet of tev's protocol. An image is sent in several packets,
// each with some of its rows.

#include "coordinator/cli/progress/tev.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cstring>
#include <limits>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

static_assert(std::endian::native == std::endian::little,
              "tev's numbers are little-endian and are copied without conversion");
static_assert(sizeof(Rgb) == 3 * sizeof(float), "a pixel is three floats without padding");

constexpr std::chrono::seconds kTevTimeout{5};
constexpr std::size_t kPacketPixels = 1 << 18;  // a packet of 3 MB

// Two of the operations of tev's protocol.
enum class Operation : std::uint8_t { kCreateImage = 4, kUpdateImageV3 = 6 };

constexpr const char* kChannels[] = {"R", "G", "B"};

// A packet to which fields are appended; finish() returns it with its length.
class Packet {
 public:
  explicit Packet(Operation operation) {
    number(std::uint32_t{0});  // placeholder for the length
    number(static_cast<std::uint8_t>(operation));
  }
  template <class T>
  void number(T value) {
    bytes(&value, sizeof(value));
  }
  void text(const std::string& value) { bytes(value.c_str(), value.size() + 1); }
  void bytes(const void* data, std::size_t size) {
    bytes_.append(static_cast<const char*>(data), size);
  }
  std::string finish() && {
    const auto length = static_cast<std::uint32_t>(bytes_.size());
    std::memcpy(bytes_.data(), &length, sizeof(length));
    return std::move(bytes_);
  }

 private:
  std::string bytes_;
};

// Appends the number and the names of the channels.
void channels(Packet& packet) {
  packet.number(static_cast<std::int32_t>(std::size(kChannels)));
  for (const char* channel : kChannels) {
    packet.text(channel);
  }
}

// Returns the deadline of an operation that begins now.
link::Deadline deadline_from_now() { return {std::chrono::steady_clock::now() + kTevTimeout}; }

}  // namespace

namespace tev {

std::string create_image(const std::string& name, std::uint32_t width, std::uint32_t height) {
  Packet packet(Operation::kCreateImage);
  packet.number(std::uint8_t{1});  // selects the new image
  packet.text(name);
  packet.number(static_cast<std::int32_t>(width));
  packet.number(static_cast<std::int32_t>(height));
  channels(packet);
  return std::move(packet).finish();
}

std::string update_rows(const std::string& name, const Image& image, std::uint32_t first,
                        std::uint32_t last) {
  Packet packet(Operation::kUpdateImageV3);
  packet.number(std::uint8_t{0});  // does not select the image
  packet.text(name);
  channels(packet);
  // The left, top, width and height of the part that is replaced.
  for (const std::uint32_t place : {0U, first, image.width, last - first}) {
    packet.number(static_cast<std::int32_t>(place));
  }
  for (std::int64_t channel = 0; channel < 3; ++channel) {
    packet.number(channel);  // index of the channel's first value, counted in floats
  }
  for (int channel = 0; channel < 3; ++channel) {
    packet.number(std::int64_t{3});  // floats from one value of the channel to the next
  }
  const std::size_t pixels = std::size_t{last - first} * image.width;
  packet.bytes(&image.pixels[std::size_t{first} * image.width], pixels * sizeof(Rgb));
  return std::move(packet).finish();
}

}  // namespace tev

absl::StatusOr<TevViewer> TevViewer::connect(const std::string& address, const std::string& name) {
  ASSIGN_OR_RETURN(link::Socket socket, link::Socket::connect(address, deadline_from_now()));
  return TevViewer(std::move(socket), name);
}

absl::Status TevViewer::show(const Image& image) {
  if (!created_) {
    RETURN_IF_ERROR(
        socket_.send(tev::create_image(name_, image.width, image.height), deadline_from_now()));
    created_ = true;
  }
  const auto rows =
      static_cast<std::uint32_t>(std::max<std::size_t>(1, kPacketPixels / image.width));
  for (std::uint32_t first = 0; first < image.height; first += rows) {
    const std::uint32_t last = std::min(first + rows, image.height);
    RETURN_IF_ERROR(socket_.send(tev::update_rows(name_, image, first, last), deadline_from_now()));
  }
  return absl::OkStatus();
}

}  // namespace bandsaw::coordinator
