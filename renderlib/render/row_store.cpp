// Takes memory for rows of sums in slabs of about 8 MiB. Rows that are given back are used again.

#include "renderlib/render/row_store.h"

#include <algorithm>

#include "renderlib/base/check.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw {
namespace {

/// Large enough for few mappings in a big image, small enough to waste little in a small one.
constexpr std::size_t kSlabBytes = std::size_t{8} << 20;

}  // namespace

RowStore::RowStore(std::size_t length, std::string folder)
    : length_(length),
      rows_per_slab_(std::max<std::size_t>(1, kSlabBytes / (length * sizeof(double)))),
      folder_(std::move(folder)) {}

absl::Status RowStore::reserve(std::size_t rows) {
  while (free_.size() < rows) {
    ASSIGN_OR_RETURN(MappedBuffer slab,
                     MappedBuffer::create(rows_per_slab_ * length_ * sizeof(double), folder_));
    const std::size_t first = slabs_.size() * rows_per_slab_;
    slabs_.push_back(std::move(slab));
    for (std::size_t i = rows_per_slab_; i-- > 0;) {
      free_.push_back(static_cast<Slot>(first + i));
    }
  }
  return absl::OkStatus();
}

RowStore::Slot RowStore::take() {
  BANDSAW_CHECK(!free_.empty(), "rows are reserved before they are taken");
  const Slot slot = free_.back();
  free_.pop_back();
  return slot;
}

absl::Span<double> RowStore::row(Slot slot) {
  return slabs_[slot / rows_per_slab_].as<double>().subspan(slot % rows_per_slab_ * length_,
                                                            length_);
}

absl::Span<const double> RowStore::row(Slot slot) const {
  return slabs_[slot / rows_per_slab_].as<double>().subspan(slot % rows_per_slab_ * length_,
                                                            length_);
}

}  // namespace bandsaw
