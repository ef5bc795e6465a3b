// Coprocess: a child process that gets lines and answers each with a line. The arguments of
// `exchange` are a line, the longest time to wait for the answer in seconds, and a flag that stops
// the wait (nullptr: none).

#include "coordinator/cli/base/coprocess.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <csignal>

namespace bandsaw::coordinator {
namespace {

using ::testing::HasSubstr;

/// Starts a shell script as the child. The child's lines that begin with `prefix` are its answers.
std::unique_ptr<Coprocess> shell(const std::string& script, const std::string& prefix = "") {
  auto child = Coprocess::start({"/bin/sh", "-c", script}, prefix);
  EXPECT_TRUE(child.ok()) << child.status();
  return *std::move(child);
}

/// Returns the outcome of a child that ended instead of answering.
ChildOutcome end_of(const std::variant<std::string, ChildOutcome>& answer) {
  EXPECT_TRUE(std::holds_alternative<ChildOutcome>(answer)) << std::get<std::string>(answer);
  return std::get<ChildOutcome>(answer);
}

TEST(Coprocess, AnswersEachLine) {
  const auto child = shell("while read n; do echo noise; echo \"a: $n\"; done", "a: ");
  EXPECT_EQ(std::get<std::string>(child->exchange("1", 60, nullptr)), "a: 1");
  EXPECT_EQ(std::get<std::string>(child->exchange("22", 60, nullptr)), "a: 22");
}

TEST(Coprocess, ReportsHowItExited) {
  const auto child = shell("read n; echo broken; exit 3", "a: ");
  const ChildOutcome outcome = end_of(child->exchange("1", 60, nullptr));
  EXPECT_EQ(outcome.end, ChildOutcome::End::kExited);
  ASSERT_TRUE(WIFEXITED(outcome.wait_status));
  EXPECT_EQ(WEXITSTATUS(outcome.wait_status), 3);
  EXPECT_THAT(outcome.output, HasSubstr("broken"));
}

TEST(Coprocess, IsKilledIfItDoesNotAnswer) {
  const auto late = shell("read n; read more");
  EXPECT_EQ(end_of(late->exchange("1", 0.05, nullptr)).end, ChildOutcome::End::kTimedOut);
  const std::atomic<bool> stop = true;
  const auto stopped = shell("read n; read more");
  EXPECT_EQ(end_of(stopped->exchange("1", 60, &stop)).end, ChildOutcome::End::kStopped);
}

/// The child closes its streams and does not exit, so waiting for its output would never end.
TEST(Coprocess, IsKilledIfItClosesItsStreamsAndDoesNotExit) {
  const auto child = shell("exec </dev/null >/dev/null; while :; do sleep 1; done");
  const ChildOutcome outcome = end_of(child->exchange("1", 0.3, nullptr));
  EXPECT_EQ(outcome.end, ChildOutcome::End::kTimedOut);
  ASSERT_TRUE(WIFSIGNALED(outcome.wait_status));
  EXPECT_EQ(WTERMSIG(outcome.wait_status), SIGKILL);
}

}  // namespace
}  // namespace bandsaw::coordinator
