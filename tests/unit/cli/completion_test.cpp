// Tests the completion of commands and options, with the script that `bandsaw completion bash`
// prints, in a real bash.

#include "coordinator/cli/completion.h"

#include <gmock/gmock.h>

#include <fstream>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "coordinator/cli/command_line.h"
#include "tests/support/process.h"
#include "tests/support/temp_dir.h"

namespace bandsaw::coordinator {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::IsSupersetOf;
using testing::Not;

class CompletionTest : public testing::Test {
 protected:
  CompletionTest() {
    const auto script = parse_command_line({"completion", "bash"});
    std::ofstream(folder_ / "script") << std::get<ShowText>(*script).text;
  }

  /// Returns the completions that bash offers for the last of these words.
  std::vector<std::string> offered(const std::string& words) {
    const test::Finished finished =
        test::run({"/bin/bash", "-uc",
                   absl::StrCat(". ", folder_ / "script", "; COMP_WORDS=(bandsaw ", words,
                                "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _bandsaw; "
                                "for word in \"${COMPREPLY[@]}\"; do echo \"$word\"; done")});
    EXPECT_EQ(finished.code, 0) << words << ": " << finished.err;
    return absl::StrSplit(finished.out, '\n', absl::SkipEmpty());
  }

  test::TempDir folder_;
};

TEST_F(CompletionTest, OffersCommands) {
  EXPECT_THAT(offered("su"), ElementsAre("submit"));
  EXPECT_THAT(offered("''"), IsSupersetOf({"serve", "render", "completion", "--help"}));
}

TEST_F(CompletionTest, OffersTheOptionsOfTheCommand) {
  EXPECT_THAT(offered("render --in"), ElementsAre("--inside", "--integrator"));
  EXPECT_THAT(offered("jobs --"), Not(Contains("--samples")));
  EXPECT_THAT(offered("submit a.glb --prio"), ElementsAre("--priority"));
}

TEST_F(CompletionTest, OffersTheWordsThatAnOptionTakes) {
  EXPECT_THAT(offered("render a.glb --tone ''"), ElementsAre("none", "filmic"));
  EXPECT_THAT(offered("submit --integrator al"), ElementsAre("albedo"));
  EXPECT_THAT(offered("secret rotate w"), ElementsAre("worker"));
  EXPECT_THAT(offered("completion ''"), ElementsAre("bash"));
}

// Where the script offers nothing, bash offers the names of files.
TEST_F(CompletionTest, LeavesFilesToTheShell) {
  EXPECT_THAT(offered("render cor"), IsEmpty());
  EXPECT_THAT(offered("render --environment se"), IsEmpty());
  EXPECT_THAT(offered("render --samples ''"), IsEmpty());
}

}  // namespace
}  // namespace bandsaw::coordinator
