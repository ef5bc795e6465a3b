// Lists the scene files below the folder, each with the comment at its beginning as its
// description.

#include "coordinator/web/gallery.h"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "proto/wire/digest.h"
#include "renderlib/base/clean_text.h"

namespace bandsaw::coordinator {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxAboutBytes = 300;
constexpr char kSuffix[] = ".textproto";

/// Returns the comment at the beginning of a scene file as one line of at most kMaxAboutBytes,
/// without the signs #.
std::string leading_comment(const std::string& path) {
  std::ifstream file(path);
  std::string about;
  for (std::string line; std::getline(file, line) && absl::StartsWith(line, "#");) {
    const std::size_t text = line.find_first_not_of("# \t");
    absl::StrAppend(&about, about.empty() ? "" : " ",
                    text == std::string::npos ? "" : line.substr(text));
  }
  return clean_text(about, kMaxAboutBytes);
}

}  // namespace

Gallery::Gallery(const std::string& folder) {
  std::error_code error;
  for (auto entry = fs::recursive_directory_iterator(folder, error);
       !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    const fs::path& path = entry->path();
    if (path.extension() == kSuffix) {
      const std::string name = path.lexically_relative(folder).replace_extension().string();
      scenes_.push_back({name, path.string(), leading_comment(path.string())});
    }
  }
  // The scenes of subfolders come last.
  std::sort(scenes_.begin(), scenes_.end(), [](const GalleryScene& a, const GalleryScene& b) {
    const auto deep = [](const GalleryScene& s) { return absl::StrContains(s.name, "/"); };
    return deep(a) != deep(b) ? deep(b) : a.name < b.name;
  });
}

const GalleryScene* Gallery::find(const std::string& name) const {
  const auto found = std::find_if(scenes_.begin(), scenes_.end(),
                                  [&](const GalleryScene& scene) { return scene.name == name; });
  return found == scenes_.end() ? nullptr : &*found;
}

std::string request_prefix(const GalleryScene& scene) {
  return absl::StrCat("gallery", wire::sha256(scene.name).hex().substr(0, 16), "-");
}

const JobView* newest_of(const GalleryScene& scene, const std::vector<JobView>& jobs) {
  const std::string prefix = request_prefix(scene);
  const JobView* newest = nullptr;
  for (const JobView& job : jobs) {
    if (absl::StartsWith(job.spec.request_id, prefix) &&
        (newest == nullptr || job.id > newest->id)) {
      newest = &job;
    }
  }
  return newest;
}

}  // namespace bandsaw::coordinator
