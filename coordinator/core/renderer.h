#pragma once

// Who rendered a band, in all lives of the coordinator: what bands on disk name a worker process
// by.

#include <cstdint>
#include <span>
#include <string>

#include "renderlib/render/hash64.h"

namespace bandsaw::coordinator {

inline std::uint64_t renderer_of(const std::string& instance) {
  Hash64 hash;
  hash.add(std::as_bytes(std::span(instance)));
  return hash.value();
}

}  // namespace bandsaw::coordinator
