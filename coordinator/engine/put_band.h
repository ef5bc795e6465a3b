#pragma once

// A band on its way from a worker to the disk and the film, and the memory that such bands may
// take.

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "coordinator/core/types.h"
#include "coordinator/engine/answer.h"
#include "coordinator/engine/engine.h"
#include "renderlib/render/band.h"
#include "renderlib/render/tile_samples.h"

namespace bandsaw::coordinator {

/// Bytes of the bands that are in memory at the same time. Passing it is RESOURCE_EXHAUSTED for the
/// worker, who keeps the band.
class BandBudget {
 public:
  explicit BandBudget(std::uint64_t bytes) : left_(static_cast<std::int64_t>(bytes)) {}

  /// Gives the bytes back when it ends. MUST not outlive the budget.
  class Share {
   public:
    Share() = default;
    Share(Share&& other) noexcept
        : budget_(std::exchange(other.budget_, nullptr)), bytes_(other.bytes_) {}
    Share& operator=(Share&& other) noexcept {
      std::swap(budget_, other.budget_);
      std::swap(bytes_, other.bytes_);
      return *this;
    }
    ~Share() {
      if (budget_ != nullptr) {
        budget_->left_ += bytes_;
      }
    }

   private:
    friend class BandBudget;
    Share(BandBudget* budget, std::int64_t bytes) : budget_(budget), bytes_(bytes) {}
    BandBudget* budget_ = nullptr;
    std::int64_t bytes_ = 0;
  };

  /// Nothing when the budget is used up. Thread-safe.
  std::optional<Share> take(std::uint64_t bytes) {
    const auto wanted = static_cast<std::int64_t>(bytes);
    if ((left_ -= wanted) < 0) {
      left_ += wanted;
      return std::nullopt;
    }
    return Share(this, wanted);
  }

 private:
  std::atomic<std::int64_t> left_;
};

struct PutBand {
  JobId job = 0;
  std::uint64_t work = 0;      ///< that it says it is of (renderlib/render/work_hash.h); 0: nothing
  std::string instance;        ///< of the worker
  std::uint64_t renderer = 0;  ///< of it (core/renderer.h)
  BandPixels pixels;
  std::string worker;      ///< as action::AddToFilm tells it
  TileSamples tiles = {};  ///< likewise
  double render_s = 0;
  double cpu_s = 0;
  bool written = false;
  std::uint64_t offset = 0;  ///< of its record in the job's log, once it is written
  Answer<BandOutcome> answer;
  BandBudget::Share share;
};

}  // namespace bandsaw::coordinator
