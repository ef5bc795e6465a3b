// Generates a bash function that sets `words` to the words that fit at the cursor. It has a case
// for each option with a value, and a case for each command. The cases are made from the options
// and commands of the parser (CLI11).

#include "coordinator/cli/completion.h"

#include <map>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "coordinator/cli/options/choices.h"

namespace bandsaw::coordinator {
namespace {

// The script consists of kScriptStart, a case for each option, kScriptCommands, a case for each
// command, and kScriptEnd.
constexpr char kScriptStart[] =
    R"(# Completion of bandsaw for bash, made by: bandsaw completion bash
_bandsaw() {
  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} words=
  COMPREPLY=()
  if [ "$COMP_CWORD" -eq 1 ]; then
    before=
  fi
  case $before in
)";
constexpr char kScriptCommands[] = R"(    *)
      case $COMP_CWORD:${COMP_WORDS[1]}:$word in
)";
constexpr char kScriptEnd[] = R"(      esac ;;
  esac
  COMPREPLY=($(compgen -W "$words" -- "$word"))
}
complete -o default -F _bandsaw bandsaw
)";

// If nothing matches, bash offers file names. This shell code prevents that where no file is
// expected.
constexpr char kNoFiles[] = "compopt +o default 2>/dev/null || true; return";

/// Returns the names of the option, long and short, with their dashes.
std::vector<std::string> names_of(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_lnames()) {
    names.push_back("--" + name);
  }
  for (const std::string& name : option.get_snames()) {
    names.push_back("-" + name);
  }
  return names;
}

/// Returns true if bash offers file names for the value of the option: the type of the value is
/// text, file or folder.
bool takes_file(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  return type == "TEXT" || type == "FILE" || type == "DIR";
}

/// Maps the name of each option that has a value to the shell code that completes the value. The
/// code "return" offers no words, so bash offers file names.
std::map<std::string, std::string> after_options(const CLI::App& app) {
  std::map<std::string, std::string> cases;
  for (const CLI::App* command : app.get_subcommands({})) {
    for (const CLI::Option* option : command->get_options()) {
      if (option->get_positional() || option->get_items_expected_max() == 0) {
        continue;
      }
      for (const std::string& name : names_of(*option)) {
        const std::vector<std::string> words = choices_of(name);
        cases[name] = !words.empty() ? absl::StrCat("words='", absl::StrJoin(words, " "), "'")
                      : takes_file(*option) ? "return"
                                            : kNoFiles;
      }
    }
  }
  return cases;
}

/// Returns the words that the positional arguments of the command accept.
std::vector<std::string> arguments_of(const CLI::App& command) {
  std::vector<std::string> words;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& word : choices_of(option->get_name(true))) {
      words.push_back(word);
    }
  }
  return words;
}

/// Returns a case of the script that offers `words`. `pattern` is compared with a text of the form
/// NUMBER:COMMAND:WORD. WORD is the word at the cursor as far as it is typed, NUMBER its position.
/// Examples of patterns: "1:*" and "*:submit:-*".
std::string when(const std::string& pattern, const std::vector<std::string>& words) {
  return absl::StrCat("        ", pattern, ") words='", absl::StrJoin(words, " "), "' ;;\n");
}

}  // namespace

std::string bash_completion(const CLI::App& app) {
  std::string out = kScriptStart;
  for (const auto& [name, reply] : after_options(app)) {
    absl::StrAppend(&out, "    ", name, ") ", reply, " ;;\n");
  }
  absl::StrAppend(&out, kScriptCommands);
  std::vector<std::string> commands;
  std::string of_commands;
  for (const CLI::App* command : app.get_subcommands({})) {
    commands.push_back(command->get_name());
    std::vector<std::string> options;
    for (const CLI::Option* option : command->get_options()) {
      const std::vector<std::string> names = names_of(*option);
      options.insert(options.end(), names.begin(), names.end());
    }
    absl::StrAppend(&of_commands, when("*:" + command->get_name() + ":-*", options));
    if (const std::vector<std::string> words = arguments_of(*command); !words.empty()) {
      absl::StrAppend(&of_commands, when("*:" + command->get_name() + ":*", words));
    }
  }
  commands.insert(commands.end(), {"--help", "--version"});
  absl::StrAppend(&out, when("1:*", commands), of_commands, kScriptEnd);
  return out;
}

}  // namespace bandsaw::coordinator
