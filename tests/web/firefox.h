#pragma once

// Firefox without a window. Tests drive it by Firefox's protocol Marionette, because Debian has no
// geckodriver, the program that would translate WebDriver into Marionette. A message of Marionette
// is its length and then JSON, over TCP.

#include <google/protobuf/struct.pb.h>

#include <memory>
#include <optional>
#include <string>

#include "tests/support/process.h"
#include "tests/support/temp_dir.h"

namespace bandsaw::test {

/// Returns the path of Firefox; empty: not installed.
std::string firefox_program();

/// One Firefox with a profile of its own. A call that fails also fails the test, and returns an
/// empty value.
class Firefox {
 public:
  Firefox();
  ~Firefox();
  Firefox(const Firefox&) = delete;
  Firefox& operator=(const Firefox&) = delete;

  void go(const std::string& url);
  /// Loads the page again, and returns when it is loaded.
  void reload();
  /// Runs the body of a JavaScript function and returns its result.
  google::protobuf::Value run(const std::string& body);
  /// Returns an expression's value as text.
  std::string text(const std::string& expression);
  /// Waits in the page until the expression is true. Returns false after 170 seconds.
  bool wait(const std::string& expression);
  /// Returns the first process of this Firefox. Its other processes descend from the first.
  pid_t pid() const { return firefox_->pid(); }

 private:
  class Socket;
  /// Sends a command and returns the value of its answer.
  google::protobuf::Value call(const std::string& command,
                               const google::protobuf::Struct& parameters);

  TempDir profile_;
  std::optional<Process> firefox_;
  std::unique_ptr<Socket> socket_;
  int last_id_ = 0;
};

}  // namespace bandsaw::test
