// bandsaw-gallery: generates the files of the gallery that are defined by formulas. They include
// globe maps (too large for the repository), surfaces of revolution, skies, volumes, and scenes of
// hundreds of shapes.
//
//   bandsaw-gallery FOLDER    writes FOLDER/study/globe_512.png …; replaces existing files
//
// Every run on every machine writes the same bytes. Exit status 0: success, 1: failure, 2: wrong
// usage.

#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <span>
#include <string>
#include <thread>

#include "absl/strings/str_cat.h"
#include "renderlib/base/atomic_file.h"
#include "renderlib/base/pool.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/gallery/book_scenes.h"
#include "renderlib/gallery/globe.h"
#include "renderlib/gallery/hard_light.h"
#include "renderlib/gallery/pergola.h"
#include "renderlib/gallery/sky.h"
#include "renderlib/gallery/turned.h"
#include "renderlib/gallery/volumes.h"
#include "renderlib/image/hdr.h"
#include "renderlib/image/png.h"

namespace bandsaw::gallery {
namespace {

/// Creates a folder, with all permissions that the umask leaves, unless it exists.
absl::Status make_open_folder(const std::string& path) {
  return mkdir(path.c_str(), 0777) == 0 || errno == EEXIST ? absl::OkStatus()
                                                           : errno_status(errno, path);
}

/// Writes the file, and prints its path to standard output.
absl::Status write(const std::string& path, absl::Span<const std::byte> bytes) {
  RETURN_IF_ERROR(write_file_atomically(path, bytes));
  std::puts(path.c_str());
  return absl::OkStatus();
}
absl::Status write(const std::string& path, const std::string& text) {
  return write(path, std::as_bytes(std::span(text)));
}

/// Generates all files below `folder`.
absl::Status make_all(const std::string& folder) {
  Pool pool(static_cast<int>(std::max(1U, std::thread::hardware_concurrency())));
  const std::string study = folder + "/study";
  const std::string books = folder + "/books";
  const std::string hard_light = folder + "/hard_light";
  for (const std::string& path : {folder, study, books, hard_light}) {
    RETURN_IF_ERROR(make_open_folder(path));
  }
  RETURN_IF_ERROR(write(folder + "/vase.obj", vase()));
  RETURN_IF_ERROR(write(folder + "/pawn.obj", pawn()));
  RETURN_IF_ERROR(write(folder + "/lamp_foot.obj", lamp_foot()));
  RETURN_IF_ERROR(write(folder + "/lamp_shade.obj", lamp_shade()));
  RETURN_IF_ERROR(write(hard_light + "/ring.obj", ring()));
  RETURN_IF_ERROR(write(hard_light + "/waves.obj", waves()));
  RETURN_IF_ERROR(write(folder + "/pergola.gltf", pergola()));
  RETURN_IF_ERROR(write(folder + "/campfire_smoke.vol", smoke_volume()));
  RETURN_IF_ERROR(write(folder + "/campfire_flames.vol", flame_volume()));
  RETURN_IF_ERROR(write(folder + "/evening.hdr", encode_hdr(evening_sky_map(64))));
  RETURN_IF_ERROR(write(folder + "/dusk.hdr", encode_hdr(dusk_sky_map(128))));
  constexpr const char* kSides[] = {"px", "nx", "py", "ny", "pz", "nz"};
  for (std::uint32_t i = 0; i < 6; ++i) {
    RETURN_IF_ERROR(write(absl::StrCat(folder, "/evening_", kSides[i], ".hdr"),
                          encode_hdr(evening_sky_side(i, 48))));
  }
  RETURN_IF_ERROR(write(books + "/one_weekend.textproto", many_spheres(/*bouncing=*/false)));
  RETURN_IF_ERROR(write(books + "/bouncing_spheres.textproto", many_spheres(/*bouncing=*/true)));
  RETURN_IF_ERROR(write(books + "/next_week.textproto", next_week_final()));
  for (const std::uint32_t rows : {512, 1024, 2048, 4096}) {
    ASSIGN_OR_RETURN(const auto png, encode_png(2 * rows, rows, globe_map(rows, pool)));
    const std::string name = absl::StrCat("/globe_", rows, ".png");
    RETURN_IF_ERROR(write(study + name, png));
    if (rows == 512) {
      RETURN_IF_ERROR(write(books + name, png));
    }
  }
  return absl::OkStatus();
}

}  // namespace
}  // namespace bandsaw::gallery

int main(int argc, char** argv) {
  if (argc != 2 || argv[1][0] == '-') {
    std::fputs("usage: bandsaw-gallery FOLDER, as in: bandsaw-gallery renderlib/gallery\n", stderr);
    return 2;
  }
  if (const absl::Status status = bandsaw::gallery::make_all(argv[1]); !status.ok()) {
    std::fprintf(stderr, "bandsaw-gallery: %s\n", std::string(status.message()).c_str());
    return 1;
  }
  return 0;
}
