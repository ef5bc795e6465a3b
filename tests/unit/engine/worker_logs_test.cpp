// WorkerLogs keeps the last lines of each worker's log. Its constructor takes two limits: the
// number of lines of each log, and the bytes of all logs together.

#include "coordinator/engine/worker_logs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace bandsaw::coordinator {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(WorkerLogs, KeepsTheLastLinesOfEachLog) {
  WorkerLogs logs(3, 1'000'000);
  logs.add("desk", {"1", "2"});
  logs.add("laptop", {"a"});
  logs.add("desk", {"3", "4"});
  EXPECT_THAT(*logs.of("desk"), ElementsAre("2", "3", "4"));
  EXPECT_THAT(*logs.of("laptop"), ElementsAre("a"));
}

TEST(WorkerLogs, AnErrorListsTheWorkersWithLogs) {
  WorkerLogs logs(3, 1'000'000);
  EXPECT_TRUE(absl::IsNotFound(logs.of("desk").status()));
  logs.add("laptop", {"a"});
  EXPECT_THAT(std::string(logs.of("desk").status().message()), HasSubstr("laptop"));
}

TEST(WorkerLogs, IfThereAreTooManyBytesTheLogWithTheOldestLastLineIsDropped) {
  WorkerLogs logs(100, 3'000);
  logs.add("one", {std::string(1'000, 'x')});
  logs.add("two", {std::string(1'000, 'x')});
  logs.add("one", {"y"});
  logs.add("three", {std::string(1'000, 'x')});
  EXPECT_TRUE(logs.of("one").ok());
  EXPECT_TRUE(logs.of("three").ok());
  EXPECT_FALSE(logs.of("two").ok());
}

}  // namespace
}  // namespace bandsaw::coordinator
