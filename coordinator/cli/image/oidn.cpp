// Loads the library OpenImageDenoise with dlopen and finds its functions by name. One function has
// different names in versions 1 and 2.

#include "coordinator/cli/image/oidn.h"

#include <dlfcn.h>

#include <cstddef>
#include <utility>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {

// Types of the C API. The program only passes pointers to them.
struct OidnDevice;
struct OidnFilter;

namespace {

/// Names of the library's file: of versions 2 and 1, and of a development package.
constexpr const char* kFiles[] = {"libOpenImageDenoise.so.2", "libOpenImageDenoise.so.1",
                                  "libOpenImageDenoise.so"};

// Constants and functions of the C API.
constexpr int kDeviceCpu = 1;     // OIDN_DEVICE_TYPE_CPU, which reads images without copying them
constexpr int kFormatFloat3 = 3;  // OIDN_FORMAT_FLOAT3

// OfDevice and OfFilter are functions whose only argument is a device or a filter.
using NewDevice = OidnDevice* (*)(int type);
using OfDevice = void (*)(OidnDevice* device);
using GetError = int (*)(OidnDevice* device, const char** message);
using NewFilter = OidnFilter* (*)(OidnDevice* device, const char* type);
using OfFilter = void (*)(OidnFilter* filter);
using SetImage = void (*)(OidnFilter* filter, const char* name, void* pixels, int format,
                          std::size_t width, std::size_t height, std::size_t offset,
                          std::size_t pixel_stride, std::size_t row_stride);
using SetBool = void (*)(OidnFilter* filter, const char* name, bool value);

}  // namespace

/// The opened library and those of its functions that are used here.
struct Oidn::Library {
  explicit Library(void* opened) : handle(opened) {}
  ~Library() { dlclose(handle); }
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;

  /// Sets `function` to the library's function of this name. Returns false if there is none.
  template <class Function>
  bool find(const char* name, Function& function) const {
    function = reinterpret_cast<Function>(dlsym(handle, name));
    return function != nullptr;
  }
  /// Returns false if the library lacks one of the functions.
  bool find_all() {
    return find("oidnNewDevice", new_device) && find("oidnCommitDevice", commit_device) &&
           find("oidnReleaseDevice", release_device) && find("oidnGetDeviceError", get_error) &&
           find("oidnNewFilter", new_filter) && find("oidnSetSharedFilterImage", set_image) &&
           // The first name is that of version 2, the second that of version 1.
           (find("oidnSetFilterBool", set_bool) || find("oidnSetFilter1b", set_bool)) &&
           find("oidnCommitFilter", commit_filter) && find("oidnExecuteFilter", execute_filter) &&
           find("oidnReleaseFilter", release_filter);
  }

  void* const handle;
  NewDevice new_device = nullptr;
  OfDevice commit_device = nullptr;
  OfDevice release_device = nullptr;
  GetError get_error = nullptr;
  NewFilter new_filter = nullptr;
  SetImage set_image = nullptr;
  SetBool set_bool = nullptr;
  OfFilter commit_filter = nullptr;
  OfFilter execute_filter = nullptr;
  OfFilter release_filter = nullptr;
};

absl::StatusOr<Oidn> Oidn::load(const std::string& file) {
  void* handle = nullptr;
  std::string why;
  const auto open = [&](const char* name) {
    if (handle == nullptr && (handle = dlopen(name, RTLD_NOW | RTLD_LOCAL)) == nullptr) {
      const char* const error = dlerror();
      why = why.empty() && error != nullptr ? error : why;
    }
  };
  if (file.empty()) {
    for (const char* const name : kFiles) {
      open(name);
    }
  } else {
    open(file.c_str());
  }
  if (handle == nullptr) {
    return absl::UnavailableError(
        absl::StrCat("the library OpenImageDenoise cannot be loaded (", why,
                     "); install it, or use --denoise, which needs no library"));
  }
  auto library = std::make_shared<Library>(handle);
  if (!library->find_all()) {
    return absl::UnavailableError(
        "the library OpenImageDenoise does not have the functions of version 1 or 2; install "
        "one of these versions, or use --denoise, which needs no library");
  }
  return Oidn(std::move(library));
}

absl::StatusOr<Image> Oidn::filter(const Image& color, const Image& albedo,
                                   const Image& normal) const {
  const Library& library = *library_;
  const std::unique_ptr<OidnDevice, OfDevice> device(library.new_device(kDeviceCpu),
                                                     library.release_device);
  const auto error = [&] {
    const char* message = nullptr;
    const int code = library.get_error(device.get(), &message);
    return code == 0 ? absl::OkStatus()
                     : absl::InternalError(absl::StrCat(
                           "OpenImageDenoise: ", message != nullptr ? message : "error ",
                           message != nullptr ? "" : absl::StrCat(code)));
  };
  if (device == nullptr) {
    RETURN_IF_ERROR(error());
    return absl::InternalError("OpenImageDenoise: no device of this machine can be used");
  }
  library.commit_device(device.get());
  RETURN_IF_ERROR(error());
  Image out{color.width, color.height, std::vector<Rgb>(color.pixels.size())};
  const std::unique_ptr<OidnFilter, OfFilter> filter(library.new_filter(device.get(), "RT"),
                                                     library.release_filter);
  if (filter == nullptr) {
    RETURN_IF_ERROR(error());
    return absl::InternalError("OpenImageDenoise: it has no filter for ray tracing");
  }
  const auto set = [&](const char* name, const Image& image) {
    // The library does not write to its input.
    library.set_image(filter.get(), name, const_cast<Rgb*>(image.pixels.data()), kFormatFloat3,
                      image.width, image.height, 0, sizeof(Rgb), image.width * sizeof(Rgb));
  };
  set("color", color);
  set("albedo", albedo);
  set("normal", normal);
  set("output", out);
  library.set_bool(filter.get(), "hdr", true);
  library.commit_filter(filter.get());
  RETURN_IF_ERROR(error());
  library.execute_filter(filter.get());
  RETURN_IF_ERROR(error());
  return out;
}

}  // namespace bandsaw::coordinator
