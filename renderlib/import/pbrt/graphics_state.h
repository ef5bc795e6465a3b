#pragma once

// Holds the graphics state of a pbrt scene while its directives are executed: what the following
// shapes get, such as transformations, material and media. Also holds the states that
// AttributeBegin has saved, and the named coordinate systems.

#include <map>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "renderlib/import/pbrt/state.h"

namespace bandsaw::pbrt {

class GraphicsState {
 public:
  State& current() { return current_; }

  /// set() replaces the active transformations, concatenate() multiplies them from the right. The
  /// active transformations are the one at the start of the motion, the one at its end, or both
  /// (ActiveTransform). The error is INVALID_ARGUMENT if a number is not finite or beyond 1e30.
  absl::Status set(const Place& place, const Transform& to);
  absl::Status concatenate(const Place& place, const Transform& by);

  /// Stores `transforms` as the coordinate system `name`.
  void define_system(const std::string& name, const Transforms& transforms);
  /// Replaces the current transformations by those of a named coordinate system. Returns false if
  /// no system has this name.
  bool use_system(const std::string& name);

  /// Saves the state. The error is RESOURCE_EXHAUSTED if 1024 states are saved already.
  absl::Status save(const Place& place);
  /// Restores the state that was saved last, and removes it from the saved states. The error is
  /// INVALID_ARGUMENT if no state is saved.
  absl::Status restore(const Place& place);
  /// Works as restore(), but restores only the transformations.
  absl::Status restore_transforms(const Place& place);
  /// Begins a file of the directive Import. The directives of this file cannot restore states that
  /// were saved before.
  void begin_import();
  /// Ends the imported file that was begun last, which MUST exist. Restores the state that was
  /// current when begin_import() was called.
  void end_import();
  /// Returns the number of states that are saved. Inside of an imported file, counts only the
  /// states that this file has saved.
  std::size_t depth() const { return saved_.size(); }

  /// Adds the parameters that Attribute sets for all following directives of the kind `target`
  /// ("shape").
  absl::Status add_defaults(const Place& place, const std::string& target, Parameters parameters);
  /// Adds the parameters that add_defaults() stored for `target` to the parameters of a directive,
  /// except those that the directive sets itself.
  void apply_defaults(const std::string& target, Parameters& parameters) const;

 private:
  /// Replaces one transformation. `k` is 0 for the start of the motion, 1 for its end.
  absl::Status set(const Place& place, std::size_t k, const Transform& to);

  /// The state that end_import() restores.
  struct Importing {
    State current;
    std::vector<State> saved;
  };

  State current_;
  std::vector<State> saved_;
  std::vector<Importing> importing_;  ///< one for each imported file that is open
  std::map<std::string, Transforms> systems_;
};

}  // namespace bandsaw::pbrt
