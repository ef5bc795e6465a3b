// Starts a child process, and collects its standard output and standard error on two threads.

#include "tests/support/process.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstring>
#include <thread>

#include "renderlib/base/check.h"
#include "renderlib/base/mutex.h"

extern char** environ;

namespace bandsaw::test {

struct Process::State {
  pid_t pid = -1;
  mutable Mutex mutex;
  CondVar changed;
  std::string text[2] GUARDED_BY(mutex);
  int open_streams GUARDED_BY(mutex) = 2;
  bool exited GUARDED_BY(mutex) = false;
  int code GUARDED_BY(mutex) = -1;
  std::vector<std::thread> threads;

  /// Appends the output of the child to text[stream] until the end of the pipe `fd`.
  void read_stream(int stream, int fd) {
    char buffer[4096];
    ssize_t n = 0;
    while ((n = read(fd, buffer, sizeof buffer)) > 0 || (n < 0 && errno == EINTR)) {
      MutexLock lock(mutex);
      text[stream].append(buffer, static_cast<std::size_t>(std::max<ssize_t>(n, 0)));
      changed.notify_all();
    }
    close(fd);
    MutexLock lock(mutex);
    --open_streams;
    changed.notify_all();
  }

  /// Waits for the end of the child and stores its exit code.
  void reap() {
    int status = 0;
    while (waitpid(pid, &status, 0) < 0 && errno == EINTR) {
    }
    MutexLock lock(mutex);
    code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    exited = true;
    changed.notify_all();
  }
};

namespace {

/// Returns pointers to the strings and a final null pointer, as posix_spawn() takes them.
std::vector<char*> pointers(std::vector<std::string>& strings) {
  std::vector<char*> out;
  for (std::string& s : strings) {
    out.push_back(s.data());
  }
  out.push_back(nullptr);
  return out;
}

// Adds the environment variables of this process that `environment` does not set. No name may occur
// twice, because shells would use the later entry.
void inherit(std::vector<std::string>& environment) {
  const std::size_t given = environment.size();
  for (char** e = environ; *e != nullptr; ++e) {
    const std::string entry = *e;
    const std::string name = entry.substr(0, entry.find('=') + 1);
    const bool replaced =
        std::any_of(environment.begin(), environment.begin() + static_cast<std::ptrdiff_t>(given),
                    [&](const std::string& other) { return other.starts_with(name); });
    if (!replaced) {
      environment.push_back(entry);
    }
  }
}

}  // namespace

Process Process::start(std::vector<std::string> argv, std::vector<std::string> environment) {
  inherit(environment);
  int pipes[2][2];
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  for (int stream = 0; stream < 2; ++stream) {
    BANDSAW_CHECK(pipe2(pipes[stream], O_CLOEXEC) == 0, "a test can make a pipe");
    posix_spawn_file_actions_adddup2(&actions, pipes[stream][1], stream + 1);
  }
  auto state = std::make_unique<State>();
  const int failed = posix_spawn(&state->pid, argv[0].c_str(), &actions, nullptr,
                                 pointers(argv).data(), pointers(environment).data());
  posix_spawn_file_actions_destroy(&actions);
  BANDSAW_CHECK(failed == 0, "a test names programs that exist");
  for (int stream = 0; stream < 2; ++stream) {
    close(pipes[stream][1]);
    state->threads.emplace_back(
        [s = state.get(), stream, fd = pipes[stream][0]] { s->read_stream(stream, fd); });
  }
  state->threads.emplace_back([s = state.get()] { s->reap(); });
  return Process(std::move(state));
}

Process::Process(std::unique_ptr<State> state) : state_(std::move(state)) {}
Process::Process(Process&&) noexcept = default;

Process& Process::operator=(Process&& other) noexcept {
  std::swap(state_, other.state_);
  return *this;
}

Process::~Process() {
  if (!state_) {
    return;
  }
  signal(SIGKILL);
  for (std::thread& thread : state_->threads) {
    thread.join();
  }
}

pid_t Process::pid() const { return state_->pid; }

void Process::signal(int number) {
  MutexLock lock(state_->mutex);
  if (!state_->exited) {
    kill(state_->pid, number);
  }
}

std::string Process::out() const {
  MutexLock lock(state_->mutex);
  return state_->text[0];
}

std::string Process::err() const {
  MutexLock lock(state_->mutex);
  return state_->text[1];
}

bool Process::wait_for(const std::string& text, Milliseconds timeout) {
  return wait_until(
      [&](const std::string& out, const std::string& err) {
        return out.find(text) != std::string::npos || err.find(text) != std::string::npos;
      },
      timeout);
}

bool Process::wait_until(const std::function<bool(const std::string&, const std::string&)>& holds,
                         Milliseconds timeout) {
  const auto end = std::chrono::steady_clock::now() + timeout;
  MutexLock lock(state_->mutex);
  while (!holds(state_->text[0], state_->text[1])) {
    const auto left = end - std::chrono::steady_clock::now();
    if (left.count() <= 0 || (state_->exited && state_->open_streams == 0)) {
      return false;
    }
    state_->changed.wait_for(state_->mutex, left);
  }
  return true;
}

std::optional<int> Process::wait(Milliseconds timeout) {
  const auto end = std::chrono::steady_clock::now() + timeout;
  MutexLock lock(state_->mutex);
  while (!state_->exited || state_->open_streams > 0) {
    const auto left = end - std::chrono::steady_clock::now();
    if (left.count() <= 0) {
      return std::nullopt;
    }
    state_->changed.wait_for(state_->mutex, left);
  }
  return state_->code;
}

Finished run(std::vector<std::string> argv, std::vector<std::string> environment) {
  Process process = Process::start(std::move(argv), std::move(environment));
  const std::optional<int> code = process.wait();
  return {code.value_or(-1), process.out(), process.err()};
}

}  // namespace bandsaw::test
