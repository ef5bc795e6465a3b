#pragma once

// A limit on the bytes of one kind of data that are in memory at the same time.

#include <atomic>
#include <cstdint>
#include <optional>
#include <utility>

namespace bandsaw::coordinator {

/// Thread-safe. Nothing waits for a budget: a share that does not fit is refused.
class MemoryBudget {
 public:
  explicit MemoryBudget(std::uint64_t bytes) : left_(static_cast<std::int64_t>(bytes)) {}

  /// A part of the budget. Its destructor returns the bytes to the budget. MUST NOT outlive the
  /// budget. Used by one thread at a time.
  class Share {
   public:
    Share() = default;
    Share(Share&& other) noexcept
        : budget_(std::exchange(other.budget_, nullptr)), bytes_(std::exchange(other.bytes_, 0)) {}
    Share& operator=(Share&& other) noexcept {
      std::swap(budget_, other.budget_);
      std::swap(bytes_, other.bytes_);
      return *this;
    }
    ~Share() { resize(0); }

    /// Changes the size of the share. Growing never fails, because the data is in memory already;
    /// later shares are refused until the budget has space again.
    void resize(std::uint64_t bytes) {
      if (budget_ != nullptr) {
        budget_->left_ += bytes_ - static_cast<std::int64_t>(bytes);
        bytes_ = static_cast<std::int64_t>(bytes);
      }
    }

   private:
    friend class MemoryBudget;
    Share(MemoryBudget* budget, std::int64_t bytes) : budget_(budget), bytes_(bytes) {}
    MemoryBudget* budget_ = nullptr;
    std::int64_t bytes_ = 0;
  };

  /// Takes a share of `bytes`. std::nullopt: fewer bytes are left.
  std::optional<Share> take(std::uint64_t bytes) {
    const auto wanted = static_cast<std::int64_t>(bytes);
    if ((left_ -= wanted) < 0) {
      left_ += wanted;
      return std::nullopt;
    }
    return Share(this, wanted);
  }

  /// Returns the bytes that are left; negative after a share has grown beyond the budget.
  std::int64_t left() const { return left_; }

 private:
  std::atomic<std::int64_t> left_;
};

}  // namespace bandsaw::coordinator
