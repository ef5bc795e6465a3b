// A stand-in for the library OpenImageDenoise, version 2, for tests: it has the functions that
// coordinator/cli/image/oidn.cpp calls. Its "filter" returns (color + albedo) / 2 + normal / 4, so
// that a test sees which images the filter got. To test how errors are handled, an image of 13
// pixels in width fails. The numbers are those of oidn.h: device type 1 is the CPU, format 3 is
// three floats, error 2 is an invalid argument.

#include <cstddef>
#include <cstring>
#include <map>
#include <string>

namespace {

struct Picture {
  char* pixels = nullptr;
  std::size_t width = 0;
  std::size_t height = 0;
  std::size_t pixel_stride = 0;
  std::size_t row_stride = 0;

  float* at(std::size_t x, std::size_t y) const {
    return reinterpret_cast<float*>(pixels + y * row_stride + x * pixel_stride);
  }
};

}  // namespace

extern "C" {

struct OIDNDeviceImpl {
  bool committed = false;
  std::string error;
};

struct OIDNFilterImpl {
  OIDNDeviceImpl* device = nullptr;
  std::map<std::string, Picture> pictures;
  bool hdr = false;
  bool committed = false;
};

OIDNDeviceImpl* oidnNewDevice(int type) { return type == 1 ? new OIDNDeviceImpl : nullptr; }
void oidnCommitDevice(OIDNDeviceImpl* device) { device->committed = true; }
void oidnReleaseDevice(OIDNDeviceImpl* device) { delete device; }
int oidnGetDeviceError(OIDNDeviceImpl* device, const char** message) {
  static const std::string kNone = "no device";
  const std::string& error = device != nullptr ? device->error : kNone;
  *message = error.c_str();
  return error.empty() ? 0 : 2;
}

OIDNFilterImpl* oidnNewFilter(OIDNDeviceImpl* device, const char* type) {
  return std::strcmp(type, "RT") == 0 ? new OIDNFilterImpl{device, {}, false, false} : nullptr;
}
void oidnSetSharedFilterImage(OIDNFilterImpl* filter, const char* name, void* pixels, int format,
                              std::size_t width, std::size_t height, std::size_t offset,
                              std::size_t pixel_stride, std::size_t row_stride) {
  if (format != 3) {
    filter->device->error = "unsupported format";
  }
  filter->pictures[name] = {static_cast<char*>(pixels) + offset, width, height, pixel_stride,
                            row_stride};
}
void oidnSetFilterBool(OIDNFilterImpl* filter, const char* name, bool value) {
  filter->hdr = filter->hdr || (std::strcmp(name, "hdr") == 0 && value);
}
void oidnCommitFilter(OIDNFilterImpl* filter) {
  // Four images: color, albedo, normal and output.
  filter->committed = filter->device->committed && filter->hdr && filter->pictures.size() == 4;
}
void oidnExecuteFilter(OIDNFilterImpl* filter) {
  if (!filter->committed) {
    filter->device->error = "not committed, not HDR, or an image is missing";
    return;
  }
  const Picture& out = filter->pictures["output"];
  if (out.width == 13) {
    filter->device->error = "an unlucky width";
    return;
  }
  for (std::size_t y = 0; y < out.height; ++y) {
    for (std::size_t x = 0; x < out.width; ++x) {
      for (std::size_t c = 0; c < 3; ++c) {
        out.at(x, y)[c] =
            (filter->pictures["color"].at(x, y)[c] + filter->pictures["albedo"].at(x, y)[c]) / 2 +
            filter->pictures["normal"].at(x, y)[c] / 4;
      }
    }
  }
}
void oidnReleaseFilter(OIDNFilterImpl* filter) { delete filter; }

}  // extern "C"
