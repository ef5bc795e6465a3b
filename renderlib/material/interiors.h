#pragma once

// Which glasses a path is inside of (Schmidt and Budge 2002, "Simple Nested Dielectrics in Ray
// Traced Images", JGT 7(2)): where several overlap, the one of the highest priority is there. Only
// materials with a priority take part.

#include <algorithm>
#include <array>
#include <cstdint>

#include "renderlib/base/ids.h"
#include "renderlib/material/material.h"

namespace bandsaw {

/// A glass that takes part; null: the material is none.
inline const Dielectric* nested_glass(const Material& material) {
  const auto* glass = std::get_if<Dielectric>(&material);
  return glass != nullptr && glass->priority > 0 ? glass : nullptr;
}

class Interiors {
 public:
  /// No material.
  static constexpr MaterialId kNothing{0xffffffffu};
  /// More than these inside each other are not kept.
  static constexpr std::size_t kMost = 8;

  // Most paths never enter one: what is not there is neither set nor copied.
  Interiors() {}
  Interiors(const Interiors& other) { *this = other; }
  Interiors& operator=(const Interiors& other) {
    size_ = other.size_;
    std::copy_n(other.entries_.begin(), size_, entries_.begin());
    return *this;
  }

  /// Whether passing a boundary of `glass` changes nothing: something of higher priority is there,
  /// or another body of the same.
  bool hides(MaterialId id, const Dielectric& glass, bool inwards) const {
    const auto bodies = std::count_if(entries_.begin(), entries_.begin() + size_,
                                      [id](const Entry& entry) { return entry.id == id; });
    const Entry* top = highest_but(id);
    return bodies > (inwards ? 0 : 1) || (top != nullptr && top->priority > glass.priority);
  }

  /// The index of refraction where `id` is not.
  double index_without(MaterialId id) const {
    const Entry* top = highest_but(id);
    return top != nullptr ? top->index : 1;
  }

  /// The glass that is there; kNothing: none.
  MaterialId there() const {
    const Entry* top = highest_but(kNothing);
    return top != nullptr ? top->id : kNothing;
  }

  /// Passing a boundary of `glass`.
  void pass(MaterialId id, const Dielectric& glass, bool inwards) {
    if (inwards) {
      if (size_ < kMost) {
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

  const Entry* highest_but(MaterialId id) const {
    const Entry* top = nullptr;
    for (std::size_t i = 0; i < size_; ++i) {
      // Of equals the lower material: the order of entering must not matter.
      if (entries_[i].id != id &&
          (top == nullptr || entries_[i].priority > top->priority ||
           (entries_[i].priority == top->priority && entries_[i].id < top->id))) {
        top = &entries_[i];
      }
    }
    return top;
  }

  std::array<Entry, kMost> entries_;
  std::size_t size_ = 0;
};

}  // namespace bandsaw
