#pragma once

// The current graphics state, the states that AttributeBegin has saved, and the named coordinate
// systems.

#include <map>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "renderlib/import/pbrt/state.h"

namespace bandsaw::pbrt {

class GraphicsState {
 public:
  State& current() { return current_; }

  /// Replaces the active transformations, or multiplies them from the right. INVALID_ARGUMENT: a
  /// number is not finite or beyond 1e30.
  absl::Status set(const Place& place, const Transform& to);
  absl::Status concatenate(const Place& place, const Transform& by);

  void define_system(const std::string& name, const Transforms& transforms);
  /// Returns false if there is no system of this name.
  bool use_system(const std::string& name);

  /// Saves the state. RESOURCE_EXHAUSTED: more than 1024 are nested.
  absl::Status save(const Place& place);
  /// Restores all of the state that was saved last, or its transformations alone.
  absl::Status restore(const Place& place);
  absl::Status restore_transforms(const Place& place);
  /// Returns the number of states that are saved.
  std::size_t depth() const { return saved_.size(); }

  /// Adds parameters that Attribute sets for all following directives of a kind ("shape").
  absl::Status add_defaults(const Place& place, const std::string& target, Parameters parameters);
  /// Adds those parameters to the parameters of a directive of this kind.
  void apply_defaults(const std::string& target, Parameters& parameters) const;

 private:
  absl::Status set(const Place& place, std::size_t k, const Transform& to);

  State current_;
  std::vector<State> saved_;
  std::map<std::string, Transforms> systems_;
};

}  // namespace bandsaw::pbrt
