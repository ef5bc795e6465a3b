#pragma once

// Client of the viewer tev (https://github.com/Tom94/tev), which shows images sent by other
// programs. Protocol: packets over TCP, each with a 32-bit length of the whole packet, an operation
// in one byte, then fields; numbers are little-endian, strings end with a zero byte.

#include <cstdint>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "proto/link/socket.h"
#include "renderlib/image/image.h"

namespace bandsaw::coordinator {

/// Encodes packets. Pure functions. The packets of TevViewer are far smaller than a length field of
/// 32 bits allows.
namespace tev {

/// Creates a black image of this size with the channels R, G and B, and shows it at once.
std::string create_image(const std::string& name, std::uint32_t width, std::uint32_t height);
/// Updates rows [first, last) of the image with linear values.
std::string update_rows(const std::string& name, const Image& image, std::uint32_t first,
                        std::uint32_t last);

}  // namespace tev

/// Connection to a viewer that shows one image. Each call blocks for a few seconds at most.
class TevViewer {
 public:
  /// `address` is HOST:PORT; `name` is the image's name in the viewer. UNAVAILABLE: not reachable.
  static absl::StatusOr<TevViewer> connect(const std::string& address, const std::string& name);

  /// Replaces the image shown by one of the same size. UNAVAILABLE: the viewer is gone.
  absl::Status show(const Image& image);

 private:
  TevViewer(link::Socket socket, std::string name)
      : socket_(std::move(socket)), name_(std::move(name)) {}
  link::Socket socket_;
  std::string name_;
  bool created_ = false;
};

}  // namespace bandsaw::coordinator
