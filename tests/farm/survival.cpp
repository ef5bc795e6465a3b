// Runs one job on a farm while a test harms the farm. At the end it checks the image's bytes
// against a local render, and that no finished band was rendered again.

#include "tests/farm/survival.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "tests/support/sanitized.h"

namespace bandsaw::test {
namespace {

// kSlower is above 1 if the build has a sanitizer, which makes tests slow.
const std::vector<std::string> kSurvivalSettings = {
    "--width", "128", "--height", "128", "--samples", std::to_string(64 / kSlower)};

std::vector<std::string> with_survival_settings(std::vector<std::string> arguments) {
  arguments.insert(arguments.end(), kSurvivalSettings.begin(), kSurvivalSettings.end());
  return arguments;
}

}  // namespace

Survival::Survival(FarmProcesses& farm, std::string scene)
    : farm_(farm), scene_(scene.empty() ? kCornell : std::move(scene)) {}

Process Survival::submit(const std::string& host) {
  return Process::start(farm_.on(host, farm_.command(with_survival_settings(
                                           {"submit", scene_, "-o", farm_.path("farm.pfm")}))));
}

void Survival::wait_until_stored(const std::string& worker, std::size_t bands) {
  ASSERT_TRUE(farm_.worker(worker).wait_until([&](const std::string&, const std::string& log) {
    return logged_bands(log, "stored").size() >= bands;
  })) << farm_.worker_log(worker);
}

void Survival::wait_until_joined(const std::string& worker, int times) {
  ASSERT_TRUE(farm_.worker(worker).wait_until([times](const std::string&, const std::string& log) {
    int joined = 0;
    for (std::size_t at = log.find("joined"); at != std::string::npos;
         at = log.find("joined", at + 1)) {
      ++joined;
    }
    return joined >= times;
  })) << "the worker did not join again: "
      << farm_.worker_log(worker);
}

void Survival::expect_the_same_bytes(Process& client) {
  const std::optional<int> code = client.wait();
  ASSERT_EQ(code, 0) << client.out() << client.err() << farm_.coordinator().err();
  const Finished finished =
      run(with_survival_settings({BANDSAW_BIN, "render", scene_, "-o", farm_.path("local.pfm")}));
  ASSERT_EQ(finished.code, 0) << finished.err;
  EXPECT_TRUE(file_bytes(farm_.path("farm.pfm")) == file_bytes(farm_.path("local.pfm")));
}

// Returns true if the coordinator gave the rows that both bands contain to two workers on purpose.
// At the end of a job it assigns a slow worker's bands to idle workers too. It logs each such band
// as "copied" or "moved".
bool Survival::shared(const LoggedBand& one, const LoggedBand& other) const {
  // Whether `whole`, a logged band, overlaps `band` and contains all rows that `one` and `other`
  // share.
  const auto within = [&](const LoggedBand& band, const LoggedBand& whole) {
    const std::uint32_t first = std::max(one.first_row, other.first_row);
    const std::uint32_t last = std::min(one.last_row, other.last_row);
    return band.overlaps(whole) && whole.first_row <= first && last <= whole.last_row;
  };
  const std::string log = farm_.coordinator_log();
  for (const char* verb : {"copied", "moved"}) {
    for (const LoggedBand& band : logged_bands(log, verb)) {
      if (within(one, band) && within(other, band)) {
        return true;
      }
    }
  }
  return false;
}

int Survival::rendered_again(const std::string& cut_off) {
  int again = 0;
  for (const std::string& one : farm_.worker_names()) {
    const std::vector<LoggedBand> stored = logged_bands(farm_.worker_log(one), "stored");
    const std::vector<LoggedBand> own = logged_bands(farm_.worker_log(one), "rendered");
    for (std::size_t i = 0; i < own.size(); ++i) {
      for (std::size_t j = i + 1; j < own.size(); ++j) {
        again += own[i].overlaps(own[j]) && !shared(own[i], own[j]);
      }
    }
    for (const std::string& other : farm_.worker_names()) {
      if (one == other || other == cut_off) {
        continue;
      }
      for (const LoggedBand& theirs : logged_bands(farm_.worker_log(other), "rendered")) {
        for (const LoggedBand& ours : stored) {
          again += ours.overlaps(theirs) && !shared(ours, theirs);
        }
      }
    }
  }
  return again;
}

void Survival::expect_nothing_rendered_again(const std::string& cut_off) {
  std::string logs = farm_.coordinator_log();
  for (const std::string& name : farm_.worker_names()) {
    logs += "\n" + name + ":\n" + farm_.worker_log(name);
  }
  EXPECT_EQ(rendered_again(cut_off), 0) << logs;
}

}  // namespace bandsaw::test
