// Compaction: a journal that has become long is rewritten as few records with the same meaning.

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <memory>

#include "tests/unit/engine/fakes.h"
#include "tests/unit/engine/test_farm.h"

namespace bandsaw::coordinator {
namespace {

TEST(Compaction, AJournalAbove10000RecordsIsRewrittenToTheSameState) {
  constexpr std::int32_t kChanges = 10'050;
  const auto disk = std::make_shared<JournalDisk>();
  TestFarm farm;
  const auto start = [&] {
    EngineDependencies dependencies;
    dependencies.journal = std::make_unique<MemoryJournal>(disk);
    ASSERT_TRUE(farm.start(std::move(dependencies)).ok());
  };
  start();
  const JobId job = farm.begin(StopAtSamples{.samples = 64});
  std::atomic<std::size_t> longest = 0;
  Box<std::int32_t> last;
  for (std::int32_t i = 1; i <= kChanges; ++i) {
    farm.engine().set_priority(job, i % 100, [&, i](const absl::StatusOr<JobView>& view) {
      EXPECT_TRUE(view.ok()) << view.status();
      longest = std::max<std::size_t>(longest, disk->size());
      last.put(i);
    });
  }
  last.wait([](std::int32_t i) { return i == kChanges; });
  const JobView before = farm.view(job);
  farm.stop();
  EXPECT_GT(longest, 9'900u) << "each change is a record";
  EXPECT_LT(disk->size(), 200u);  // the snapshot, and the records after it
  start();
  const JobView after = farm.view(job);
  EXPECT_EQ(after.priority, kChanges % 100);
  EXPECT_EQ(after.priority, before.priority);
  EXPECT_EQ(after.state, before.state);
}

}  // namespace
}  // namespace bandsaw::coordinator
