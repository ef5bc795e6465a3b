#pragma once

// A bound on the bytes of one kind of data that are in memory at the same time.

#include <atomic>
#include <cstdint>
#include <optional>
#include <utility>

namespace bandsaw::coordinator {

/// Thread-safe.
class MemoryBudget {
 public:
  explicit MemoryBudget(std::uint64_t bytes) : left_(static_cast<std::int64_t>(bytes)) {}

  /// Gives its bytes back when it ends. MUST not outlive the budget. Used by one thread at a time.
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

    /// The data that the share stands for has another size now. Growing never fails: the data is
    /// in memory already, and later shares are refused until the budget has room again.
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

  /// Nothing where fewer bytes are left.
  std::optional<Share> take(std::uint64_t bytes) {
    const auto wanted = static_cast<std::int64_t>(bytes);
    if ((left_ -= wanted) < 0) {
      left_ += wanted;
      return std::nullopt;
    }
    return Share(this, wanted);
  }

  /// Bytes that a share may have now; negative after one has grown beyond the budget.
  std::int64_t left() const { return left_; }

 private:
  std::atomic<std::int64_t> left_;
};

}  // namespace bandsaw::coordinator
