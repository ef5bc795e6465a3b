#pragma once

// The digests of the rows that were stored of one pass: what a second result for the same samples
// is compared with.

#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "coordinator/core/types.h"

namespace bandsaw::coordinator {

class RowDigests {
 public:
  /// One digest for each row of the band; those of `rows` are kept.
  void keep(const Band& band, const std::vector<RowRange>& rows,
            const std::vector<std::uint64_t>& digests);

  /// The first row of the band that is known with another digest, for the very same samples.
  std::optional<std::uint32_t> first_difference(const Band& band,
                                                const std::vector<std::uint64_t>& digests) const;

  /// Of a row of a node; nothing when it is not known.
  std::optional<std::uint64_t> of(const SampleRange& samples, std::uint32_t row) const;
  void forget(const Band& band);
  void clear() { known_.clear(); }

 private:
  std::map<SampleRange, std::map<std::uint32_t, std::uint64_t>> known_;
};

}  // namespace bandsaw::coordinator
