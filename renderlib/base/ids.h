#pragma once

// Typed indices into the scene's arrays: a MaterialId cannot be passed where a TextureId is meant.

#include <cstdint>

namespace bandsaw {

enum class MaterialId : std::uint32_t {};
enum class TextureId : std::uint32_t {};
enum class MeshId : std::uint32_t {};
enum class GroupId : std::uint32_t {};   ///< shapes that are placed together (geometry/shapes.h)
enum class FrameId : std::uint32_t {};   ///< a moving coordinate system (geometry/frame.h)
enum class MediumId : std::uint32_t {};  ///< a participating medium

template <class Id>
constexpr std::size_t index_of(Id id) {
  return static_cast<std::size_t>(id);
}

}  // namespace bandsaw
