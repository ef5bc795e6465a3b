// A hash of everything that determines an image except the samples. Bands (rendered rows and
// samples of an image) may be added together only if their hashes are equal.

#include "renderlib/render/work_hash.h"

#include <algorithm>
#include <cstddef>

#include "renderlib/render/hash64.h"

namespace bandsaw {

std::uint64_t work_hash(absl::string_view manifest, const RenderSettings& settings) {
  Hash64 hash;
  hash.add(
      absl::MakeConstSpan(reinterpret_cast<const std::byte*>(manifest.data()), manifest.size()));
  for (const std::uint64_t number : {std::uint64_t{settings.width}, std::uint64_t{settings.height},
                                     std::uint64_t{settings.max_depth}, settings.seed,
                                     static_cast<std::uint64_t>(settings.integrator)}) {
    hash.add(number);
  }
  return std::max<std::uint64_t>(hash.value(), 1);
}

}  // namespace bandsaw
