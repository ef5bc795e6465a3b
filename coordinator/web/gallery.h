#pragma once

// The gallery: the scene files below one folder, which is installed with Bandsaw. The dashboard
// shows these scenes and renders them on request.

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

/// Returns the first 24 characters of the request id of each job that the gallery submits for this
/// scene. These jobs are found by this prefix, also after a restart of the coordinator. A request
/// id is a text that the submitter of a job chooses.
std::string request_prefix(const GalleryScene& scene);

/// Returns the newest of the `jobs` that the gallery has submitted for the scene; nullptr: none.
const JobView* newest_of(const GalleryScene& scene, const std::vector<JobView>& jobs);

}  // namespace bandsaw::coordinator
