// Tests the line that `bandsaw serve` prints for a machine without a worker. A shell runs the line
// as if a user had pasted it.

#include <gtest/gtest.h>

#include <csignal>
#include <regex>

#include "tests/farm/farm_processes.h"

namespace bandsaw::test {
namespace {

// Returns the printed line with `exec` before the worker's program. So the shell that the test
// starts becomes the worker, and signals of the test reach the worker.
std::string pasted_line(Process& coordinator) {
  const std::string line = line_to_paste(coordinator);
  std::smatch parts;
  EXPECT_TRUE(std::regex_match(line, parts, std::regex("(case .*&& )(\\./.*)"))) << line;
  return parts[1].str() + "exec " + parts[2].str();
}

// Runs the line in a shell in a new folder, without Bandsaw's programs on its PATH.
Process paste(const FarmProcesses& farm, const std::string& host, const std::string& folder,
              const std::string& line) {
  return Process::start(
      farm.on(host, {"/bin/sh", "-c", "mkdir " + folder + " && cd " + folder + " && " + line}),
      {"PATH=/usr/bin:/bin", "HOME=" + folder});
}

TEST(Paste, TheLineInstallsAndStartsAWorker) {
  const auto hosts = Hosts::create({"coordinator", "desk"});
  if (!hosts.ok()) {
    GTEST_SKIP() << hosts.status().message();
  }
  FarmProcesses farm(hosts->get(), {"--web", (*hosts)->address("coordinator") + ":0"});
  const std::string line = pasted_line(farm.coordinator());
  EXPECT_NE(line.find(" --pinnedpubkey "), std::string::npos) << farm.coordinator().out();
  Process worker = paste(farm, "desk", farm.path("desk"), line);
  ASSERT_TRUE(worker.wait_for(" joined ")) << worker.err();
  const Finished submitted =
      run(farm.on("desk", farm.command({"submit", kCornell, "--width", "32", "--samples", "16",
                                        "-o", farm.path("a.pfm")})));
  EXPECT_EQ(submitted.code, 0) << submitted.err;
  EXPECT_NE(worker.err().find("rendered job=1"), std::string::npos) << worker.err();
  worker.signal(SIGTERM);
  EXPECT_EQ(worker.wait(), 0) << worker.err();
}

TEST(Paste, TheLineStartsNoWorkerIfTheKeyOrTheProgramDiffers) {
  const auto hosts = Hosts::create({"coordinator"});
  if (!hosts.ok()) {
    GTEST_SKIP() << hosts.status().message();
  }
  FarmProcesses farm(hosts->get(), {"--web", (*hosts)->address("coordinator") + ":0"});
  const std::string line = pasted_line(farm.coordinator());
  // 43 letters A and one "=" are 32 zero bytes in Base64. No key has this digest.
  const std::string zeros(43, 'A');
  const std::string other_key =
      std::regex_replace(line, std::regex("sha256//[^ ]*"), "sha256//" + zeros + "=");
  Process impostor = paste(farm, "coordinator", farm.path("one"), other_key);
  EXPECT_EQ(impostor.wait(), 90) << impostor.err();  // curl: the pinned key does not match
  const std::string other_digest =
      std::regex_replace(line, std::regex("d=[0-9a-f]{64}"), "d=" + std::string(64, '0'));
  Process damaged = paste(farm, "coordinator", farm.path("two"), other_digest);
  EXPECT_EQ(damaged.wait(), 1);  // sha256sum: the program has another digest
  EXPECT_NE(damaged.out().find("FAILED"), std::string::npos) << damaged.out();
}

TEST(Paste, TheLineNeedsNoKeyOnLoopback) {
  FarmProcesses farm(nullptr, {"--web", "127.0.0.1:0"});
  const std::string line = pasted_line(farm.coordinator());
  EXPECT_NE(line.find(" http://127.0.0.1:"), std::string::npos) << farm.coordinator().out();
  Process worker = paste(farm, "", farm.path("desk"), line);
  EXPECT_TRUE(worker.wait_for(" joined ")) << worker.err();
  worker.signal(SIGTERM);
  EXPECT_EQ(worker.wait(), 0) << worker.err();
}

}  // namespace
}  // namespace bandsaw::test
