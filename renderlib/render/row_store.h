#pragma once

// Allocator for rows of sums, all of the same length, in memory-mapped slabs
// (base/mapped_buffer.h). A film (film.h) keeps its sums here.

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
  using Slot = std::uint32_t;  ///< number of a row

  /// `length` (>= 1) is the number of doubles in a row. The slabs are files without a name in
  /// `folder`; "" keeps them in memory.
  RowStore(std::size_t length, std::string folder);

  /// Ensures that the next `rows` calls of take() succeed. Returns the errors of
  /// MappedBuffer::create (RESOURCE_EXHAUSTED, NOT_FOUND, PERMISSION_DENIED); existing rows are
  /// unchanged.
  absl::Status reserve(std::size_t rows);
  /// Returns a row with unspecified content. It MUST have been reserved.
  Slot take();
  /// Frees a row for a later take().
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
