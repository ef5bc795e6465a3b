// A child that is asked line by line.

#include "coordinator/cli/base/asked_child.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <csignal>

namespace bandsaw::coordinator {
namespace {

using ::testing::HasSubstr;

std::unique_ptr<AskedChild> shell(const std::string& script, const std::string& prefix = "") {
  auto child = AskedChild::start({"/bin/sh", "-c", script}, prefix);
  EXPECT_TRUE(child.ok()) << child.status();
  return *std::move(child);
}

ChildOutcome end_of(const std::variant<std::string, ChildOutcome>& answer) {
  EXPECT_TRUE(std::holds_alternative<ChildOutcome>(answer)) << std::get<std::string>(answer);
  return std::get<ChildOutcome>(answer);
}

TEST(AskedChild, AnswersEachLine) {
  const auto child = shell("while read n; do echo noise; echo \"a: $n\"; done", "a: ");
  EXPECT_EQ(std::get<std::string>(child->ask("1", 60, nullptr)), "a: 1");
  EXPECT_EQ(std::get<std::string>(child->ask("22", 60, nullptr)), "a: 22");
}

TEST(AskedChild, ReportsHowItExited) {
  const auto child = shell("read n; echo broken; exit 3", "a: ");
  const ChildOutcome outcome = end_of(child->ask("1", 60, nullptr));
  EXPECT_EQ(outcome.end, ChildOutcome::End::kExited);
  ASSERT_TRUE(WIFEXITED(outcome.wait_status));
  EXPECT_EQ(WEXITSTATUS(outcome.wait_status), 3);
  EXPECT_THAT(outcome.output, HasSubstr("broken"));
}

TEST(AskedChild, IsKilledIfItDoesNotAnswer) {
  const auto late = shell("read n; read more");
  EXPECT_EQ(end_of(late->ask("1", 0.05, nullptr)).end, ChildOutcome::End::kTimedOut);
  const std::atomic<bool> stop = true;
  const auto stopped = shell("read n; read more");
  EXPECT_EQ(end_of(stopped->ask("1", 60, &stop)).end, ChildOutcome::End::kStopped);
}

/// It neither answers nor exits, and nobody can wait for its output.
TEST(AskedChild, IsKilledIfItClosesItsStreamsAndStays) {
  const auto child = shell("exec </dev/null >/dev/null; while :; do sleep 1; done");
  const ChildOutcome outcome = end_of(child->ask("1", 0.3, nullptr));
  EXPECT_EQ(outcome.end, ChildOutcome::End::kTimedOut);
  ASSERT_TRUE(WIFSIGNALED(outcome.wait_status));
  EXPECT_EQ(WTERMSIG(outcome.wait_status), SIGKILL);
}

}  // namespace
}  // namespace bandsaw::coordinator
