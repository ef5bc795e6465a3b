#pragma once

// Decides whether a worker may render a band. Bands that it failed, and bands at which its machine
// was lost, are left to other workers as long as there are any.

#include <cstdint>
#include <vector>

#include "coordinator/scheduler/context/context.h"

namespace bandsaw::coordinator {

class Eligibility {
 public:
  /// A worker that failed this many bands of a job in a row gets no more of it.
  static constexpr std::uint32_t kMaxFailuresPerWorker = 3;

  explicit Eligibility(const Context& context) : context_(context) {}

  bool may_render(const Worker& worker, const Job& job) const;
  /// Returns true if some eligible worker may render the job.
  bool someone_may_render(const Job& job) const;
  /// Returns true if some eligible worker may render the job and has not failed the band.
  bool someone_else(const Job& job, const Band& band) const;
  /// Returns the same for workers whose machine was not lost at the band either.
  bool another_machine(const Job& job, const Band& band) const;

  /// Returns the bands of the job that are left to others than this worker.
  std::vector<Band> left_to_others(const Job& job, const Worker& worker) const;
  /// Returns true if `band` overlaps one of them.
  bool left_to_others(const Job& job, const Worker& worker, const Band& band) const;

 private:
  const Context& context_;
};

}  // namespace bandsaw::coordinator
