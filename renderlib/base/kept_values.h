#pragma once

// A map that keeps values from one round of work to the next. A round is, for example, the encoding
// of one frame of an animation. A value that a round does not use is removed at the end of it.

#include <map>
#include <utility>

namespace bandsaw {

template <class Key, class Value>
class KeptValues {
 public:
  bool contains(const Key& key) const { return values_.find(key) != values_.end(); }
  /// Returns the value, which becomes part of this round; nullptr: there is none.
  const Value* find(const Key& key) {
    const auto found = values_.find(key);
    if (found == values_.end()) {
      return nullptr;
    }
    found->second.used = true;
    return &found->second.value;
  }
  /// Adds a value of this round, or replaces it.
  void set(const Key& key, Value value) { values_[key] = {std::move(value)}; }
  /// Ends the round: forgets the values that were neither found nor set in it.
  void end_round() {
    std::erase_if(values_, [](const auto& kept) { return !kept.second.used; });
    for (auto& [key, kept] : values_) {
      kept.used = false;
    }
  }

 private:
  struct Kept {
    Value value;
    bool used = true;
  };
  std::map<Key, Kept> values_;
};

}  // namespace bandsaw
