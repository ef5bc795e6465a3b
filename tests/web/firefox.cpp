// Starts Firefox and sends it the commands of Marionette.

#include "tests/web/firefox.h"

#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <chrono>
#include <fstream>
#include <thread>

#include "absl/strings/str_cat.h"
#include "renderlib/base/check.h"

namespace bandsaw::test {
namespace {

using google::protobuf::ListValue;
using google::protobuf::Struct;
using google::protobuf::Value;
namespace asio = boost::asio;

Struct parsed(const std::string& json) {
  Struct out;
  const auto status = google::protobuf::util::JsonStringToMessage(json, &out);
  BANDSAW_CHECK(status.ok(), json.c_str());
  return out;
}

/// Returns the port that Firefox has written into its profile; 0: Firefox did not write it within a
/// minute.
int port_in(const std::string& profile) {
  for (int i = 0; i < 600; ++i) {
    int port = 0;
    if (std::ifstream(profile + "/MarionetteActivePort") >> port) {
      return port;
    }
    // Only the file shows that Firefox has written it, so the file must be polled.
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  return 0;
}

}  // namespace

/// The connection: messages `LENGTH:JSON` in both directions.
class Firefox::Socket {
 public:
  explicit Socket(int port) : socket_(context_) {
    boost::system::error_code error;
    socket_.connect({asio::ip::address_v4::loopback(), static_cast<unsigned short>(port)}, error);
  }
  void send(const std::string& json) {
    boost::system::error_code error;
    asio::write(socket_, asio::buffer(absl::StrCat(json.size(), ":", json)), error);
  }
  /// Waits for a message and returns its JSON; empty: the connection has ended.
  std::string receive() {
    std::size_t size = 0;
    char c = 0;
    boost::system::error_code error;
    while (asio::read(socket_, asio::buffer(&c, 1), error) == 1 && c != ':') {
      size = size * 10 + static_cast<std::size_t>(c - '0');
    }
    std::string json(error ? 0 : size, '\0');
    asio::read(socket_, asio::buffer(json), error);
    return error ? "" : json;
  }

 private:
  asio::io_context context_;
  asio::ip::tcp::socket socket_;
};

std::string firefox_program() {
  for (const char* program : {"/usr/bin/firefox-esr", "/usr/bin/firefox"}) {
    if (access(program, X_OK) == 0) {
      return program;
    }
  }
  return "";
}

Firefox::Firefox() {
  const std::string profile = profile_ / "profile";
  BANDSAW_CHECK(mkdir(profile.c_str(), 0700) == 0, profile.c_str());
  std::ofstream(profile + "/user.js")
      << "user_pref('marionette.port', 0);\n"
         "user_pref('datareporting.policy.dataSubmissionEnabled', false);\n"
         "user_pref('app.update.disabledForTesting', true);\n"
         "user_pref('browser.shell.checkDefaultBrowser', false);\n";
  firefox_.emplace(Process::start(
      {firefox_program(), "--headless", "--marionette", "--no-remote", "--profile", profile},
      {"HOME=" + (profile_ / ""), "MOZ_CRASHREPORTER_DISABLE=1"}));
  socket_ = std::make_unique<Socket>(port_in(profile));
  socket_->receive();  // Firefox's greeting, which names the versions of the protocol
  call("WebDriver:NewSession", parsed(R"({"acceptInsecureCerts": true,
                  "timeouts": {"script": 180000, "pageLoad": 120000}})"));
}

Firefox::~Firefox() {
  call("Marionette:Quit", parsed(R"({"flags": ["eForceQuit"]})"));
  firefox_->wait(std::chrono::seconds(20));
}

Value Firefox::call(const std::string& command, const Struct& parameters) {
  // A command is the list [0, id, name, parameters]. Its answer is a list of four values, of which
  // the third is null or an error, and the fourth is the result.
  Value message;
  message.mutable_list_value()->add_values()->set_number_value(0);
  message.mutable_list_value()->add_values()->set_number_value(++last_id_);
  message.mutable_list_value()->add_values()->set_string_value(command);
  *message.mutable_list_value()->add_values()->mutable_struct_value() = parameters;
  std::string json;
  BANDSAW_CHECK(google::protobuf::util::MessageToJsonString(message, &json).ok(),
                "the command cannot be written as JSON");
  socket_->send(json);
  const std::string text = socket_->receive();
  ListValue answer;
  const auto status = google::protobuf::util::JsonStringToMessage(text, &answer);
  if (!status.ok() || answer.values_size() != 4 || !answer.values(2).has_null_value()) {
    ADD_FAILURE() << command << " " << json.substr(0, 300) << "\n" << text.substr(0, 1000);
    return {};
  }
  const Value& result = answer.values(3);
  const auto& fields = result.struct_value().fields();
  return fields.contains("value") ? fields.at("value") : result;
}

void Firefox::go(const std::string& url) {
  Struct where;
  (*where.mutable_fields())["url"].set_string_value(url);
  call("WebDriver:Navigate", where);
}

void Firefox::reload() { call("WebDriver:Refresh", {}); }

Value Firefox::run(const std::string& body) {
  Struct script = parsed(R"({"args": []})");
  (*script.mutable_fields())["script"].set_string_value(body);
  return call("WebDriver:ExecuteScript", script);
}

std::string Firefox::text(const std::string& expression) {
  return run(absl::StrCat("return String(", expression, ");")).string_value();
}

bool Firefox::wait(const std::string& expression) {
  Struct script = parsed(R"({"args": []})");
  (*script.mutable_fields())["script"].set_string_value(
      absl::StrCat("const done = arguments[arguments.length - 1];"
                   "const until = Date.now() + 170000;"
                   "const look = () => { if (",
                   expression,
                   ") done(true);"
                   " else if (Date.now() > until) done(false);"
                   " else setTimeout(look, 50); }; look();"));
  return call("WebDriver:ExecuteAsyncScript", script).bool_value();
}

}  // namespace bandsaw::test
