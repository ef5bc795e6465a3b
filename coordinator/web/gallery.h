#pragma once

// The gallery: scene files that are installed with Bandsaw below one folder, which the dashboard
// shows and renders.

#include <optional>
#include <string>
#include <vector>

#include "coordinator/scheduler/api/job_view.h"

namespace bandsaw::coordinator {

struct GalleryScene {
  std::string name;   ///< the path below the folder without its suffix: "books/earth"
  std::string path;   ///< path of the file
  std::string about;  ///< comment at the beginning of the file, as one line
};

/// The folder is read once, by the constructor. Later changes of the folder have no effect.
class Gallery {
 public:
  /// Finds every *.textproto. Scenes are sorted by name; those of subfolders come last. A missing
  /// folder is an empty gallery.
  explicit Gallery(const std::string& folder);

  const std::vector<GalleryScene>& scenes() const { return scenes_; }
  /// Returns the scene of this name; nullptr: no such scene.
  const GalleryScene* find(const std::string& name) const;

 private:
  std::vector<GalleryScene> scenes_;
};

/// Returns the beginning of the request ids of a scene's jobs, 24 characters. The scene's jobs
/// are found by this prefix, also after a restart of the coordinator.
std::string request_prefix(const GalleryScene& scene);

/// Returns the newest job that rendered the scene from the gallery; nullptr: none.
const JobView* newest_of(const GalleryScene& scene, const std::vector<JobView>& jobs);

}  // namespace bandsaw::coordinator
