// Starts chromedriver and sends it the commands of WebDriver by HTTP.

#include "tests/web/browser.h"

#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "renderlib/base/check.h"
#include "tests/support/http_client.h"

namespace bandsaw::test {
namespace {

using google::protobuf::Struct;
using google::protobuf::Value;

/// Parses an object in JSON.
Struct object(const std::string& json) {
  Struct out;
  const auto status = google::protobuf::util::JsonStringToMessage(json, &out);
  BANDSAW_CHECK(status.ok(), json.c_str());
  return out;
}

/// Returns an object with one field.
Struct object(const std::string& name, const std::string& text) {
  Struct out;
  (*out.mutable_fields())[name].set_string_value(text);
  return out;
}

/// Returns a field of an object; an empty value if there is none.
const Value& field(const Value& value, const std::string& name) {
  static const Value kNothing;
  const auto found = value.struct_value().fields().find(name);
  return found == value.struct_value().fields().end() ? kNothing : found->second;
}

Process start_driver() { return Process::start({chromedriver_program(), "--port=0"}); }

/// Waits until chromedriver prints its port, and returns it.
int port_of(Process& driver) {
  const std::string before = "successfully on port ";
  BANDSAW_CHECK(driver.wait_for(before), driver.out().c_str());
  int port = 0;
  driver.wait_until([&](const std::string& out, const std::string&) {
    const std::size_t at = out.find(before) + before.size();
    port = std::atoi(out.c_str() + at);
    return out.find('.', at) != std::string::npos;
  });
  return port;
}

}  // namespace

std::string chromedriver_program() {
  for (const char* program : {"/usr/bin/chromedriver", "/usr/local/bin/chromedriver"}) {
    if (access(program, X_OK) == 0) {
      return program;
    }
  }
  return "";
}

Browser::Browser(const BrowserOptions& options) : driver_(start_driver()) {
  port_ = port_of(driver_);
  const std::string phone =
      options.phone ? absl::StrCat(R"(, "mobileEmulation": {"deviceMetrics": {"width": )",
                                   options.width, R"(, "height": )", options.height,
                                   R"(, "pixelRatio": )", options.pixel_ratio, "}}")
                    : "";
  const Value made =
      post("/session",
           object(absl::StrCat(
               R"({"capabilities": {"alwaysMatch": {"acceptInsecureCerts": true, )",
               R"("timeouts": {"script": 180000, "pageLoad": 120000}, )",
               R"("goog:loggingPrefs": {"browser": "ALL"}, "goog:chromeOptions": {"args": [)",
               R"("--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--disable-gpu", )",
               R"("--force-device-scale-factor=)", options.pixel_ratio, R"(", "--window-size=)",
               options.width, ",", options.height, R"("])", phone, "}}}}")));
  session_ = absl::StrCat("/session/", field(made, "sessionId").string_value());
  call("Emulation.setEmulatedMedia",
       absl::StrCat(R"({"features": [{"name": "prefers-color-scheme", "value": ")",
                    options.dark ? "dark" : "light", R"("}]})"));
}

Browser::~Browser() { http_call(port_, {.method = "DELETE", .target = session_}); }

Value Browser::post(const std::string& path, const Struct& body) {
  std::string json;
  BANDSAW_CHECK(google::protobuf::util::MessageToJsonString(body, &json).ok(),
                "the command cannot be written as JSON");
  const auto result = http_call(port_, {.method = "POST",
                                        .target = path,
                                        .headers = {{"Content-Type", "application/json"}},
                                        .body = json});
  if (!result) {
    ADD_FAILURE() << path << ": the driver gave no answer";
    return {};
  }
  Struct answer;
  const auto status = google::protobuf::util::JsonStringToMessage(result->body, &answer);
  EXPECT_TRUE(status.ok()) << result->body.substr(0, 1000);
  EXPECT_EQ(result->status, 200) << path << " " << json << "\n" << result->body.substr(0, 1000);
  return answer.fields().contains("value") ? answer.fields().at("value") : Value();
}

void Browser::call(const std::string& method, const std::string& parameters) {
  post(session_ + "/goog/cdp/execute",
       object(absl::StrCat(R"({"cmd": ")", method, R"(", "params": )", parameters, "}")));
}

void Browser::go(const std::string& url) { post(session_ + "/url", object("url", url)); }

void Browser::reload() { post(session_ + "/refresh", {}); }

Value Browser::run(const std::string& body, const std::string& argument) {
  Struct call = object("script", body);
  (*call.mutable_fields())["args"].mutable_list_value()->add_values()->set_string_value(argument);
  return post(session_ + "/execute/sync", call);
}

std::string Browser::text(const std::string& expression) {
  return run(absl::StrCat("return String(", expression, ");")).string_value();
}

bool Browser::wait(const std::string& expression) {
  Struct call = object("script", absl::StrCat("const done = arguments[arguments.length - 1];"
                                              "const until = Date.now() + 170000;"
                                              "const look = () => { if (",
                                              expression,
                                              ") done(true);"
                                              " else if (Date.now() > until) done(false);"
                                              " else setTimeout(look, 50); }; look();"));
  (*call.mutable_fields())["args"].mutable_list_value();
  return post(session_ + "/execute/async", call).bool_value();
}

std::string Browser::element(const std::string& selector) {
  Struct by = object("using", "css selector");
  (*by.mutable_fields())["value"].set_string_value(selector);
  // The name of this field is fixed by the WebDriver standard.
  return field(post(session_ + "/element", by), "element-6066-11e4-a52e-4f735466cecf")
      .string_value();
}

void Browser::click(const std::string& selector) {
  post(absl::StrCat(session_, "/element/", element(selector), "/click"), Struct());
}

void Browser::type(const std::string& selector, const std::string& keys) {
  post(absl::StrCat(session_, "/element/", element(selector), "/value"), object("text", keys));
}

void Browser::block(const std::string& pattern) {
  call("Network.enable", "{}");
  call("Network.setBlockedURLs",
       pattern.empty() ? R"({"urls": []})" : absl::StrCat(R"({"urls": [")", pattern, R"("]})"));
}

void Browser::screenshot(const std::string& path) {
  const auto result = http_call(port_, {.target = session_ + "/screenshot"});
  ASSERT_TRUE(result);
  Struct answer;
  ASSERT_TRUE(google::protobuf::util::JsonStringToMessage(result->body, &answer).ok());
  std::string png;
  ASSERT_TRUE(absl::Base64Unescape(answer.fields().at("value").string_value(), &png));
  std::ofstream(path, std::ios::binary) << png;
}

std::vector<std::string> Browser::console_errors() {
  std::vector<std::string> errors;
  const Value log = post(session_ + "/se/log", object("type", "browser"));
  for (const Value& entry : log.list_value().values()) {
    if (field(entry, "level").string_value() == "SEVERE") {
      errors.push_back(field(entry, "message").string_value());
    }
  }
  return errors;
}

}  // namespace bandsaw::test
