// Reads the parameters of a pbrt directive: the type, the name and the values of each. The
// accessors check the type and mark the parameter as used.

#include "renderlib/import/pbrt/parameters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::pbrt {
namespace {

struct Type {
  const char* name;
  const char* same_as;  ///< stored in Parameter::type; the same for all names of one type
  bool has_texts;       ///< the values may be strings in quotes
};
constexpr std::array kTypes = {
    Type{"float", "float", false},         Type{"integer", "integer", false},
    Type{"bool", "bool", false},           Type{"point2", "point2", false},
    Type{"point3", "point3", false},       Type{"point", "point3", false},
    Type{"vector2", "vector2", false},     Type{"vector3", "vector3", false},
    Type{"vector", "vector3", false},      Type{"normal3", "normal", false},
    Type{"normal", "normal", false},       Type{"rgb", "rgb", false},
    Type{"blackbody", "blackbody", false}, Type{"string", "string", true},
    Type{"texture", "texture", true},      Type{"spectrum", "spectrum", true}};

/// Appends the value of a token to `to`. A bool may be written with or without quotes.
absl::Status add_value(const Token& token, bool has_texts, Parameter& to) {
  if (token.kind == Token::Kind::kString) {
    if (!has_texts && to.type != "bool") {
      return error_at(token.place,
                      absl::StrCat("\"", to.type, " ", to.name, "\" has numbers, not strings"));
    }
    if (to.type != "bool") {
      to.texts.push_back(token.text);
      return absl::OkStatus();
    }
  }
  if (to.type == "bool") {
    if (token.text != "true" && token.text != "false") {
      return error_at(token.place, absl::StrCat("\"bool ", to.name, "\" must be true or false, is ",
                                                token.text));
    }
    to.numbers.push_back(token.text == "true" ? 1 : 0);
    return absl::OkStatus();
  }
  if (has_texts && to.type != "spectrum") {
    return error_at(token.place, absl::StrCat("\"", to.type, " ", to.name,
                                              "\" has strings in quotes, not ", token.text));
  }
  ASSIGN_OR_RETURN(const double number, number_of(token));
  to.numbers.push_back(number);
  return to.numbers.size() <= kMaxValues
             ? absl::OkStatus()
             : absl::Status(absl::StatusCode::kResourceExhausted,
                            absl::StrCat(text_of(token.place), ": too many values"));
}

/// Reads the value that follows, or a list of values in brackets.
absl::Status read_values(Tokens& tokens, bool has_texts, Parameter& to) {
  ASSIGN_OR_RETURN(std::optional<Token> token, tokens.next());
  if (!token || token->kind == Token::Kind::kClose) {
    return error_at(to.place, absl::StrCat("\"", to.type, " ", to.name, "\" has no value"));
  }
  if (token->kind != Token::Kind::kOpen) {
    return add_value(*token, has_texts, to);
  }
  while (true) {
    ASSIGN_OR_RETURN(token, tokens.next());
    if (!token || token->kind == Token::Kind::kOpen) {
      return error_at(to.place, absl::StrCat("the list of values of \"", to.type, " ", to.name,
                                             "\" has no closing ]"));
    }
    if (token->kind == Token::Kind::kClose) {
      return absl::OkStatus();
    }
    RETURN_IF_ERROR(add_value(*token, has_texts, to));
  }
}

}  // namespace

absl::StatusOr<double> number_of(const Token& token) {
  double number = 0;
  if (token.kind != Token::Kind::kWord || !absl::SimpleAtod(token.text, &number)) {
    return error_at(token.place,
                    absl::StrCat("a number is expected, not ", token.text.substr(0, 80)));
  }
  if (!std::isfinite(number)) {
    return error_at(token.place, absl::StrCat("numbers must be finite, one is ", token.text));
  }
  return number;
}

absl::StatusOr<Parameters> read_parameters(Tokens& tokens, const Place& place) {
  Parameters parameters;
  parameters.place = place;
  while (true) {
    ASSIGN_OR_RETURN(std::optional<Token> token, tokens.next());
    if (!token) {
      return parameters;
    }
    if (token->kind != Token::Kind::kString) {
      if (token->kind != Token::Kind::kWord) {
        return error_at(token->place, absl::StrCat("unexpected ", token->text));
      }
      tokens.put_back(*std::move(token));
      return parameters;
    }
    const std::vector<std::string> words =
        absl::StrSplit(token->text, absl::ByAnyChar(" \t"), absl::SkipEmpty());
    const auto type = std::find_if(kTypes.begin(), kTypes.end(), [&](const Type& known) {
      return words.size() == 2 && words[0] == known.name;
    });
    if (type == kTypes.end()) {
      return error_at(token->place,
                      absl::StrCat("\"", token->text.substr(0, 80),
                                   "\" is no parameter: a type and a name are expected, as in "
                                   "\"float radius\""));
    }
    Parameter parameter{.type = type->same_as, .name = words[1], .place = token->place};
    RETURN_IF_ERROR(read_values(tokens, type->has_texts, parameter));
    if (std::any_of(parameters.list.begin(), parameters.list.end(),
                    [&](const Parameter& other) { return other.name == parameter.name; })) {
      return error_at(parameter.place, absl::StrCat("\"", parameter.name, "\" is given twice"));
    }
    if (parameters.list.size() == kMaxParameters) {
      return error_at(parameter.place, "the directive has too many parameters");
    }
    parameters.list.push_back(std::move(parameter));
  }
}

void Parameters::add_defaults(const std::vector<Parameter>& defaults) {
  for (const Parameter& parameter : defaults) {
    if (std::none_of(list.begin(), list.end(),
                     [&](const Parameter& own) { return own.name == parameter.name; })) {
      list.push_back(parameter);
      list.back().is_used = true;
    }
  }
}

const Parameter* Parameters::find(const std::string& name) const {
  for (const Parameter& parameter : list) {
    if (parameter.name == name) {
      parameter.is_used = true;
      return &parameter;
    }
  }
  return nullptr;
}

absl::StatusOr<std::vector<double>> Parameters::numbers(const std::string& name,
                                                        std::initializer_list<const char*> types,
                                                        std::size_t group) const {
  const Parameter* found = find(name);
  if (found == nullptr) {
    return std::vector<double>();
  }
  if (std::find(types.begin(), types.end(), found->type) == types.end()) {
    return error_at(found->place, absl::StrCat("\"", found->type, " ", name, "\" must be of type ",
                                               absl::StrJoin(types, " or ")));
  }
  if (found->numbers.size() % group != 0) {
    return error_at(found->place, absl::StrCat("\"", name, "\" must have a multiple of ", group,
                                               " numbers, has ", found->numbers.size()));
  }
  return found->numbers;
}

absl::StatusOr<std::optional<double>> Parameters::number(const std::string& name) const {
  const Parameter* found = find(name);
  if (found == nullptr) {
    return std::nullopt;
  }
  if ((found->type != "float" && found->type != "integer") || found->numbers.size() != 1) {
    return error_at(found->place,
                    absl::StrCat("\"", found->type, " ", name, "\" must be one float"));
  }
  return found->numbers[0];
}

absl::StatusOr<double> Parameters::number(const std::string& name, double otherwise) const {
  ASSIGN_OR_RETURN(const std::optional<double> value, number(name));
  return value.value_or(otherwise);
}

absl::StatusOr<int> Parameters::integer(const std::string& name, int otherwise) const {
  const Parameter* found = find(name);
  if (found == nullptr) {
    return otherwise;
  }
  if (found->type != "integer" || found->numbers.size() != 1 || std::abs(found->numbers[0]) > 2e9 ||
      found->numbers[0] != std::floor(found->numbers[0])) {
    return error_at(found->place,
                    absl::StrCat("\"", found->type, " ", name, "\" must be one integer"));
  }
  return static_cast<int>(found->numbers[0]);
}

absl::StatusOr<bool> Parameters::boolean(const std::string& name, bool otherwise) const {
  const Parameter* found = find(name);
  if (found == nullptr) {
    return otherwise;
  }
  if (found->type != "bool" || found->numbers.size() != 1) {
    return error_at(found->place,
                    absl::StrCat("\"", found->type, " ", name, "\" must be one bool"));
  }
  return found->numbers[0] != 0;
}

absl::StatusOr<std::string> Parameters::text(const std::string& name,
                                             const std::string& otherwise) const {
  const Parameter* found = find(name);
  if (found == nullptr) {
    return otherwise;
  }
  if (found->type != "string" || found->texts.size() != 1) {
    return error_at(found->place,
                    absl::StrCat("\"", found->type, " ", name, "\" must be one string"));
  }
  return found->texts[0];
}

absl::StatusOr<std::vector<std::string>> Parameters::texts(const std::string& name) const {
  const Parameter* found = find(name);
  if (found == nullptr) {
    return std::vector<std::string>();
  }
  if (found->type != "string") {
    return error_at(found->place, absl::StrCat("\"", found->type, " ", name, "\" must be strings"));
  }
  return found->texts;
}

absl::StatusOr<Vec3> Parameters::point(const std::string& name, const Vec3& otherwise) const {
  ASSIGN_OR_RETURN(const std::vector<double> values,
                   numbers(name, {"point3", "vector3", "normal"}, 3));
  if (values.empty()) {
    return otherwise;
  }
  if (values.size() != 3) {
    return error_at(find(name)->place, absl::StrCat("\"", name, "\" must be one point"));
  }
  return Vec3{values[0], values[1], values[2]};
}

void Parameters::ignore(std::initializer_list<const char*> names) const {
  for (const char* name : names) {
    find(name);
  }
}

}  // namespace bandsaw::pbrt
