#pragma once

// Client of the viewer tev (https://github.com/Tom94/tev), for the option --tev. The viewer shows
// images that other programs send. Its protocol has packets over TCP. Each packet begins with the
// length of the whole packet in 32 bits and the operation in one byte. The fields of the operation
// follow. Numbers are little-endian, and strings end with a zero byte.

#include <cstdint>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "proto/link/socket.h"
#include "renderlib/image/image.h"

namespace bandsaw::coordinator {

/// Pure functions that encode packets.
namespace tev {

/// Returns the packet that creates a black image of this size with the channels R, G and B, and
/// selects it in the viewer.
std::string create_image(const std::string& name, std::uint32_t width, std::uint32_t height);
/// Returns the packet that replaces rows [first, last) of the viewer's image by the same rows of
/// `image`, as linear values. The rows MUST be few enough for a packet of less than 4 GiB.
std::string update_rows(const std::string& name, const Image& image, std::uint32_t first,
                        std::uint32_t last);

}  // namespace tev

/// Connection to a viewer that shows one image. A call gives up if a packet cannot be sent within
/// five seconds.
class TevViewer {
 public:
  /// `address` is HOST:PORT; `name` is the image's name in the viewer. UNAVAILABLE: no viewer can
  /// be reached at this address.
  static absl::StatusOr<TevViewer> connect(const std::string& address, const std::string& name);

  /// Shows an image. It replaces the image that was shown before. All images MUST have the same
  /// size. UNAVAILABLE: the viewer is gone.
  absl::Status show(const Image& image);

 private:
  TevViewer(link::Socket socket, std::string name)
      : socket_(std::move(socket)), name_(std::move(name)) {}
  link::Socket socket_;
  std::string name_;
  bool created_ = false;  ///< the viewer has the image, so it is only updated
};

}  // namespace bandsaw::coordinator
