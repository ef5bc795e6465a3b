#pragma once

// Chromium without a window, for tests of the pages that the coordinator serves. It is driven
// through chromedriver by the WebDriver protocol (W3C).

#include <google/protobuf/struct.pb.h>

#include <string>
#include <vector>

#include "tests/support/process.h"

namespace bandsaw::test {

/// Returns the path of chromedriver; empty: not installed.
std::string chromedriver_program();

struct BrowserOptions {
  int width = 1280;  ///< of the window, in CSS pixels
  int height = 900;
  double pixel_ratio = 1;
  bool phone = false;  ///< touch, and a phone's viewport
  bool dark = false;
};

/// One session with a profile of its own. A call that fails also fails the test, and returns an
/// empty value.
class Browser {
 public:
  explicit Browser(const BrowserOptions& options = {});
  ~Browser();
  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;

  void go(const std::string& url);
  /// Loads the page again, and returns when it is loaded.
  void reload();
  /// Runs the body of a JavaScript function and returns its result; `argument` is `arguments[0]`.
  google::protobuf::Value run(const std::string& body, const std::string& argument = "");
  /// Returns the value of a JavaScript expression as text.
  std::string text(const std::string& expression);
  /// Waits in the page until the expression is true. Returns false after 170 seconds.
  bool wait(const std::string& expression);
  /// Clicks on the first element that matches the CSS selector, or types into it.
  void click(const std::string& selector);
  void type(const std::string& selector, const std::string& keys);
  /// Makes later requests fail if their address matches the pattern, such as "*.png". The
  /// pattern "" lets all requests pass.
  void block(const std::string& pattern);
  /// Writes a PNG of the window's content to the file.
  void screenshot(const std::string& path);
  /// Returns the process of chromedriver. All processes of this browser descend from it.
  pid_t pid() const { return driver_.pid(); }
  /// Returns the errors on the browser's console since the last call.
  std::vector<std::string> console_errors();

 private:
  /// Sends a command to the driver and returns the value of its answer.
  google::protobuf::Value post(const std::string& path, const google::protobuf::Struct& body);
  /// Calls a method of Chromium's own protocol (DevTools). `parameters`: an object in JSON.
  void call(const std::string& method, const std::string& parameters);
  /// Returns WebDriver's name of an element.
  std::string element(const std::string& selector);

  Process driver_;
  int port_ = 0;         ///< of the driver
  std::string session_;  ///< "/session/…"
};

}  // namespace bandsaw::test
