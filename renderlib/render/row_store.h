#pragma once

// Room for rows of sums, all of one length, taken and given back one by one; mapped in slabs
// (base/mapped_buffer.h).

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/types/span.h"
#include "renderlib/base/mapped_buffer.h"

namespace bandsaw {

class RowStore {
 public:
  using Slot = std::uint32_t;

  /// `length` >= 1: doubles a row. `folder`: as MappedBuffer::create takes it.
  RowStore(std::size_t length, std::string folder);

  /// Makes sure that the next `rows` calls of take() find room. RESOURCE_EXHAUSTED, NOT_FOUND,
  /// PERMISSION_DENIED: as MappedBuffer::create; what was there stays as it was.
  absl::Status reserve(std::size_t rows);
  /// A row of any content. It MUST have been reserved.
  Slot take();
  void give_back(Slot slot) { free_.push_back(slot); }

  absl::Span<double> row(Slot slot);
  absl::Span<const double> row(Slot slot) const;

 private:
  std::size_t length_;
  std::size_t rows_per_slab_;
  std::string folder_;
  std::vector<MappedBuffer> slabs_;
  std::vector<Slot> free_;
};

}  // namespace bandsaw
