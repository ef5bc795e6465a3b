// LogQueue: the lines of a worker's log that wait to be sent to the coordinator. At most 500 lines
// wait. Lines that are lost are replaced by one line with their number. take() removes lines from
// the queue, to send them. arrived() says that the coordinator has received all lines that were
// taken. again() is called when the worker has connected again. It inserts taken lines into the
// queue again, because the coordinator may lack them. If the coordinator has not restarted, it may
// lack the lines taken since the last call of arrived(). If the coordinator has restarted, it may
// lack all lines. At most the last 50 taken lines are inserted again.

#include "worker/log_queue.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spdlog/logger.h>

namespace bandsaw::worker {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

struct Logging {
  std::shared_ptr<LogQueue> queue = std::make_shared<LogQueue>();
  spdlog::logger logger{"test", queue};
  Logging() { logger.set_pattern("%l %v"); }
};

TEST(LogQueue, ReturnsEachLineOnceInOrder) {
  Logging log;
  log.logger.info("one");
  log.logger.warn("two");
  log.logger.info("three");
  EXPECT_THAT(log.queue->take(2), ElementsAre("info one\n", "warning two\n"));
  EXPECT_THAT(log.queue->take(2), ElementsAre("info three\n"));
  EXPECT_THAT(log.queue->take(2), IsEmpty());
}

TEST(LogQueue, ReturnsTheLastLinesAgainBeforeNewOnes) {
  Logging log;
  for (int i = 0; i < 60; ++i) {
    log.logger.info("{}", i);
  }
  EXPECT_EQ(log.queue->take(60).size(), 60u);
  log.queue->arrived();
  log.logger.info("new");
  log.queue->again(/*restarted=*/true);
  const std::vector<std::string> again = log.queue->take(100);
  ASSERT_EQ(again.size(), 51u);
  EXPECT_EQ(again.front(), "info 10\n");
  EXPECT_EQ(again.back(), "info new\n");
}

TEST(LogQueue, ReturnsAgainLinesThatMayNotHaveArrived) {
  Logging log;
  log.logger.info("one");
  log.logger.info("two");
  log.logger.info("three");
  EXPECT_THAT(log.queue->take(1), ElementsAre("info one\n"));
  log.queue->arrived();
  EXPECT_EQ(log.queue->take(2).size(), 2u);
  log.logger.info("new");
  log.queue->again(/*restarted=*/false);
  EXPECT_THAT(log.queue->take(9), ElementsAre("info two\n", "info three\n", "info new\n"));
  log.queue->arrived();
  log.queue->again(/*restarted=*/false);
  EXPECT_THAT(log.queue->take(9), IsEmpty());
  log.queue->again(/*restarted=*/true);
  EXPECT_EQ(log.queue->take(9).size(), 4u) << "a coordinator that restarted must get all lines";
}

TEST(LogQueue, CountsLinesThatItCannotReturnAgain) {
  Logging log;
  for (int i = 0; i < 60; ++i) {
    log.logger.info("{}", i);
  }
  EXPECT_EQ(log.queue->take(60).size(), 60u);
  log.queue->again(/*restarted=*/false);
  EXPECT_THAT(log.queue->take(2), ElementsAre(HasSubstr("10 lines"), "info 10\n"));
  log.queue->again(/*restarted=*/false);
  EXPECT_THAT(log.queue->take(3), ElementsAre(HasSubstr("10 lines"), "info 10\n", "info 11\n"));
}

TEST(LogQueue, CountsDroppedLines) {
  Logging log;
  for (int i = 0; i < 507; ++i) {
    log.logger.info("{}", i);
  }
  const std::vector<std::string> first = log.queue->take(2);
  EXPECT_THAT(first, ElementsAre(HasSubstr("7 lines"), "info 7\n"));
  EXPECT_THAT(log.queue->take(1), ElementsAre("info 8\n"));
}

}  // namespace
}  // namespace bandsaw::worker
