#pragma once

// Holds the current graphics state of a pbrt scene while its directives are executed, the states
// that AttributeBegin has saved, and the named coordinate systems.

#include <map>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "renderlib/import/pbrt/state.h"

namespace bandsaw::pbrt {

class GraphicsState {
 public:
  State& current() { return current_; }

  /// Replaces the active transformations, or multiplies them from the right. The active ones are
  /// those at the start or at the end of the motion, or both (ActiveTransform). The error is
  /// INVALID_ARGUMENT if a number is not finite or beyond 1e30.
  absl::Status set(const Place& place, const Transform& to);
  absl::Status concatenate(const Place& place, const Transform& by);

  void define_system(const std::string& name, const Transforms& transforms);
  /// Returns false if there is no system of this name.
  bool use_system(const std::string& name);

  /// Saves the state. The error is RESOURCE_EXHAUSTED if more than 1024 are nested.
  absl::Status save(const Place& place);
  /// Restores all of the state that was saved last, or its transformations alone. The error is
  /// INVALID_ARGUMENT if none is saved.
  absl::Status restore(const Place& place);
  absl::Status restore_transforms(const Place& place);
  /// Begins a file of the directive Import. The states that are saved outside of it cannot be
  /// restored inside of it.
  void begin_import();
  /// Ends that file: the state is again that of begin_import(), which MUST have been called.
  void end_import();
  /// Returns the number of states that are saved; inside of an imported file, by that file.
  std::size_t depth() const { return saved_.size(); }

  /// Adds parameters that Attribute sets for all following directives of a kind ("shape").
  absl::Status add_defaults(const Place& place, const std::string& target, Parameters parameters);
  /// Adds those parameters to the parameters of a directive of this kind.
  void apply_defaults(const std::string& target, Parameters& parameters) const;

 private:
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
