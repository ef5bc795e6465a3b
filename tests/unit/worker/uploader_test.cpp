// The upload of finished bands, which are kept until the coordinator acknowledges them.

#include "worker/executor/uploader.h"

#include <gtest/gtest.h>

#include <functional>
#include <map>

namespace bandsaw::worker {
namespace {

using Outcome = absl::StatusOr<farm::PutBandReply::Outcome>;

FinishedBand band(TaskId id) {
  FinishedBand band;
  band.task.id = id;
  return band;
}

/// A coordinator that answers each attempt to send a band with answer_(task, attempt). Attempts
/// are counted from 1. By default the coordinator stores all bands.
class UploaderTest : public ::testing::Test {
 protected:
  Outcome put(const FinishedBand& band) {
    MutexLock lock(mutex_);
    const int attempt = ++attempts_[band.task.id];
    changed_.notify_all();
    return answer_(band.task.id, attempt);
  }
  /// The uploader calls this when a band is acknowledged or rejected for good.
  void settled(TaskId task, const Outcome& outcome) {
    MutexLock lock(mutex_);
    settled_.emplace_back(task, outcome.status());
    changed_.notify_all();
  }
  void start() {
    uploader_ = std::make_unique<Uploader>(
        [this](const FinishedBand& b) { return put(b); },
        [this](TaskId task, const Outcome& outcome) { settled(task, outcome); }, /*seed=*/1);
  }
  void wait_for_settled(std::size_t count) {
    MutexLock lock(mutex_);
    while (settled_.size() < count) {
      changed_.wait(mutex_);
    }
  }
  void wait_for_attempts(TaskId task, int count) {
    MutexLock lock(mutex_);
    while (attempts_[task] < count) {
      changed_.wait(mutex_);
    }
  }

  Mutex mutex_;
  CondVar changed_;
  std::function<Outcome(TaskId, int)> answer_ = [](TaskId, int) -> Outcome {
    return farm::PutBandReply::OUTCOME_STORED;
  };
  std::map<TaskId, int> attempts_;
  std::vector<std::pair<TaskId, absl::Status>> settled_;
  std::unique_ptr<Uploader> uploader_;
};

TEST_F(UploaderTest, SendsInOrder) {
  start();
  for (TaskId id = 1; id <= 3; ++id) {
    uploader_->add(band(id));
  }
  wait_for_settled(3);
  for (TaskId id = 1; id <= 3; ++id) {
    EXPECT_EQ(settled_[id - 1].first, id);
    EXPECT_TRUE(settled_[id - 1].second.ok());
  }
}

TEST_F(UploaderTest, KeepsABandUntilItIsAcknowledged) {
  answer_ = [](TaskId, int attempt) -> Outcome {
    if (attempt < 3) {
      return absl::UnavailableError("away");
    }
    return farm::PutBandReply::OUTCOME_DUPLICATE;
  };
  start();
  uploader_->add(band(1));
  wait_for_settled(1);
  EXPECT_EQ(attempts_[1], 3);
  EXPECT_EQ(settled_.size(), 1U);
}

TEST_F(UploaderTest, DropsABandAfterAPermanentError) {
  answer_ = [](TaskId task, int) -> Outcome {
    if (task == 1) {
      return absl::InvalidArgumentError("not a band of that job");
    }
    return farm::PutBandReply::OUTCOME_UNWANTED;
  };
  start();
  uploader_->add(band(1));
  uploader_->add(band(2));
  wait_for_settled(2);
  EXPECT_EQ(settled_[0].second.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_TRUE(settled_[1].second.ok());
}

TEST_F(UploaderTest, TriesAtOnceWhenTheCoordinatorIsBack) {
  answer_ = [](TaskId, int attempt) -> Outcome {
    if (attempt == 1) {
      return absl::ResourceExhaustedError("the disk is full");
    }
    return farm::PutBandReply::OUTCOME_STORED;
  };
  start();
  uploader_->add(band(1));
  wait_for_attempts(1, 1);
  uploader_->retry_now();
  wait_for_settled(1);
}

TEST_F(UploaderTest, DropsUnwantedBands) {
  answer_ = [](TaskId task, int) -> Outcome {
    if (task == 1) {
      return absl::UnavailableError("away");
    }
    return farm::PutBandReply::OUTCOME_STORED;
  };
  start();
  uploader_->add(band(1));
  uploader_->add(band(2));
  wait_for_attempts(1, 1);
  uploader_->drop(1);  // as when the lease of the band is revoked
  wait_for_settled(1);
  EXPECT_EQ(settled_[0].first, 2U);
}

TEST_F(UploaderTest, EndsWhileItWaits) {
  answer_ = [](TaskId, int) -> Outcome { return absl::ResourceExhaustedError("the disk is full"); };
  start();
  uploader_->add(band(1));
  wait_for_attempts(1, 1);
  uploader_.reset();
  EXPECT_TRUE(settled_.empty());
}

}  // namespace
}  // namespace bandsaw::worker
