// Holds the graphics state of a pbrt scene: what the following shapes get, such as transformations,
// material and media. AttributeBegin and TransformBegin push a copy of the state to a stack.
// AttributeEnd restores the last copy, TransformEnd only the transformations of the last copy. An
// imported file has a stack of its own.

#include "renderlib/import/pbrt/graphics_state.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::pbrt {
namespace {

/// Maximum nesting of AttributeBegin and TransformBegin.
constexpr std::size_t kMaxNesting = 1024;

}  // namespace

absl::Status GraphicsState::set(const Place& place, std::size_t k, const Transform& to) {
  for (const auto& row : to.m) {
    for (const double number : row) {
      if (!(std::abs(number) < 1e30)) {
        return error_at(place, "the transformation has a number beyond 1e30");
      }
    }
  }
  current_.transforms[k] = to;
  return absl::OkStatus();
}

absl::Status GraphicsState::set(const Place& place, const Transform& to) {
  for (std::size_t k = 0; k < 2; ++k) {
    if (current_.is_active[k]) {
      RETURN_IF_ERROR(set(place, k, to));
    }
  }
  return absl::OkStatus();
}

absl::Status GraphicsState::concatenate(const Place& place, const Transform& by) {
  for (std::size_t k = 0; k < 2; ++k) {
    if (current_.is_active[k]) {
      RETURN_IF_ERROR(set(place, k, current_.transforms[k] * by));
    }
  }
  return absl::OkStatus();
}

void GraphicsState::define_system(const std::string& name, const Transforms& transforms) {
  systems_[name] = transforms;
}

bool GraphicsState::use_system(const std::string& name) {
  const auto found = systems_.find(name);
  if (found == systems_.end()) {
    return false;
  }
  current_.transforms = found->second;
  return true;
}

absl::Status GraphicsState::save(const Place& place) {
  if (saved_.size() >= kMaxNesting) {
    return absl::ResourceExhaustedError(
        absl::StrCat(text_of(place), ": more than ", kMaxNesting, " attributes within each other"));
  }
  saved_.push_back(current_);
  return absl::OkStatus();
}

absl::Status GraphicsState::restore(const Place& place) {
  if (saved_.empty()) {
    return error_at(place, "AttributeEnd without AttributeBegin");
  }
  current_ = std::move(saved_.back());
  saved_.pop_back();
  return absl::OkStatus();
}

absl::Status GraphicsState::restore_transforms(const Place& place) {
  if (saved_.empty()) {
    return error_at(place, "TransformEnd without TransformBegin");
  }
  current_.transforms = saved_.back().transforms;
  std::copy(std::begin(saved_.back().is_active), std::end(saved_.back().is_active),
            std::begin(current_.is_active));
  saved_.pop_back();
  return absl::OkStatus();
}

void GraphicsState::begin_import() { importing_.push_back({current_, std::exchange(saved_, {})}); }

void GraphicsState::end_import() {
  current_ = std::move(importing_.back().current);
  saved_ = std::move(importing_.back().saved);
  importing_.pop_back();
}

absl::Status GraphicsState::add_defaults(const Place& place, const std::string& target,
                                         Parameters parameters) {
  auto defaults = current_.defaults == nullptr ? std::vector<std::pair<std::string, Parameter>>()
                                               : *current_.defaults;
  for (Parameter& parameter : parameters.list) {
    std::erase_if(defaults, [&](const auto& old) {
      return old.first == target && old.second.name == parameter.name;
    });
    defaults.emplace_back(target, std::move(parameter));
  }
  if (defaults.size() > kMaxParameters) {
    return error_at(place, "too many attributes");
  }
  current_.defaults =
      std::make_shared<const std::vector<std::pair<std::string, Parameter>>>(std::move(defaults));
  return absl::OkStatus();
}

void GraphicsState::apply_defaults(const std::string& target, Parameters& parameters) const {
  if (current_.defaults == nullptr) {
    return;
  }
  std::vector<Parameter> defaults;
  for (const auto& [of, parameter] : *current_.defaults) {
    if (of == target) {
      defaults.push_back(parameter);
    }
  }
  parameters.add_defaults(defaults);
}

}  // namespace bandsaw::pbrt
