#pragma once

// The scenes that came with the program, as files below one folder.

#include <optional>
#include <string>
#include <vector>

#include "coordinator/scheduler/api/job_view.h"

namespace bandsaw::coordinator {

struct GalleryScene {
  std::string name;   ///< the path below the folder without its suffix: "books/earth"
  std::string path;   ///< of the file
  std::string about;  ///< the comment that the file begins with, as one line
};

/// What is found there once; it does not change later.
class Gallery {
 public:
  /// Every *.textproto, by name. A folder that is not there is an empty gallery.
  explicit Gallery(const std::string& folder);

  const std::vector<GalleryScene>& scenes() const { return scenes_; }
  /// Null: no such scene.
  const GalleryScene* find(const std::string& name) const;

 private:
  std::vector<GalleryScene> scenes_;
};

/// How the request ids of a scene's jobs begin, so that its jobs are known for ever. 24 characters.
std::string request_prefix(const GalleryScene& scene);

/// The newest of the jobs that rendered it from the gallery; null: none.
const JobView* newest_of(const GalleryScene& scene, const std::vector<JobView>& jobs);

}  // namespace bandsaw::coordinator
