#pragma once

// Nested dielectrics: the glasses that contain a path (Schmidt and Budge 2002, "Simple Nested
// Dielectrics in Ray Traced Images", JGT 7(2)). Where several glasses overlap, only the one of
// highest priority is present. Only materials with a priority take part.

#include <algorithm>
#include <array>
#include <cstdint>

#include "renderlib/base/ids.h"
#include "renderlib/material/material.h"

namespace bandsaw {

/// Returns the dielectric of a material that has a priority; null for other materials.
inline const Dielectric* nested_glass(const Material& material) {
  const auto* glass = std::get_if<Dielectric>(&material.kind);
  return glass != nullptr && glass->priority > 0 ? glass : nullptr;
}

/// The set of glasses that contain a point of a path.
class Interiors {
 public:
  /// No material.
  static constexpr MaterialId kNothing{0xffffffffu};
  /// Maximum number of nested glasses; further ones are ignored.
  static constexpr std::size_t kMaxNested = 8;

  // Most paths never enter a nested glass, so unused entries are neither initialised nor copied.
  Interiors() {}
  Interiors(const Interiors& other) { *this = other; }
  Interiors& operator=(const Interiors& other) {
    size_ = other.size_;
    std::copy_n(other.entries_.begin(), size_, entries_.begin());
    return *this;
  }

  /// Returns true if crossing a boundary of `glass`, whose material is `id`, changes nothing: a
  /// glass of higher priority is present, or the path is in another body of the same material.
  /// `inwards` is true if the path enters `glass`.
  bool hides(MaterialId id, const Dielectric& glass, bool inwards) const {
    const auto bodies = std::count_if(entries_.begin(), entries_.begin() + size_,
                                      [id](const Entry& entry) { return entry.id == id; });
    const Entry* top = highest_except(id);
    return bodies > (inwards ? 0 : 1) || (top != nullptr && top->priority > glass.priority);
  }

  /// Returns the index of refraction that would be present without material `id`.
  double index_without(MaterialId id) const {
    const Entry* top = highest_except(id);
    return top != nullptr ? top->index : 1;
  }

  /// Returns the material of the glass that is present, the one of highest priority; kNothing if
  /// there is none.
  MaterialId there() const {
    const Entry* top = highest_except(kNothing);
    return top != nullptr ? top->id : kNothing;
  }

  /// Crosses a boundary of `glass`, whose material is `id`; `inwards` is true if the path enters
  /// it.
  void pass(MaterialId id, const Dielectric& glass, bool inwards) {
    if (inwards) {
      if (size_ < kMaxNested) {
        entries_[size_++] = {id, glass.priority, glass.index_of_refraction};
      }
      return;
    }
    for (std::size_t i = size_; i-- > 0;) {
      if (entries_[i].id == id) {
        entries_[i] = entries_[--size_];
        return;
      }
    }
  }

 private:
  struct Entry {
    MaterialId id;
    std::uint32_t priority;
    double index;
  };

  /// Returns the glass of highest priority among those whose material is not `id`; null if there is
  /// none.
  const Entry* highest_except(MaterialId id) const {
    const Entry* top = nullptr;
    for (std::size_t i = 0; i < size_; ++i) {
      // Among equal priorities the lower id wins, so that the order of entering does not matter.
      if (entries_[i].id != id &&
          (top == nullptr || entries_[i].priority > top->priority ||
           (entries_[i].priority == top->priority && entries_[i].id < top->id))) {
        top = &entries_[i];
      }
    }
    return top;
  }

  std::array<Entry, kMaxNested> entries_;
  std::size_t size_ = 0;
};

}  // namespace bandsaw
