// Tests the three ways to see an image while it is rendered: in the terminal, in the image viewer
// tev, and by the coordinator's call for previews.

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <cstring>
#include <thread>

#include "coordinator/cli/farm/farm_client.h"
#include "tests/farm/farm_processes.h"

namespace bandsaw::test {
namespace {

using coordinator::FarmClient;
using coordinator::FarmImage;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

/// A fake viewer that accepts one connection and stores all bytes received.
class FakeViewer {
 public:
  FakeViewer() : listening_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(address);
    auto* const any = reinterpret_cast<sockaddr*>(&address);
    EXPECT_EQ(bind(listening_, any, size), 0);
    EXPECT_EQ(listen(listening_, 1), 0);
    EXPECT_EQ(getsockname(listening_, any, &size), 0);
    address_ = "127.0.0.1:" + std::to_string(ntohs(address.sin_port));
    thread_ = std::thread([this] { take(); });
  }
  ~FakeViewer() {
    shutdown(listening_, SHUT_RDWR);
    if (thread_.joinable()) {
      thread_.join();
    }
    close(listening_);
  }
  const std::string& address() const { return address_; }
  /// Waits until the other side has closed the connection, then returns all packets.
  std::vector<std::string> packets() {
    thread_.join();
    std::vector<std::string> out;
    std::uint32_t size = 0;
    for (std::size_t at = 0; at + sizeof(size) <= bytes_.size(); at += size) {
      std::memcpy(&size, &bytes_[at], sizeof(size));
      if (size < 5 || size > bytes_.size() - at) {
        ADD_FAILURE() << "a packet of " << size << " bytes, " << bytes_.size() - at << " left";
        break;
      }
      out.push_back(bytes_.substr(at, size));
    }
    return out;
  }

 private:
  void take() {
    const int connection = accept(listening_, nullptr, nullptr);
    char piece[4096];
    for (ssize_t got = 0; connection >= 0 && (got = read(connection, piece, sizeof(piece))) > 0;) {
      bytes_.append(piece, static_cast<std::size_t>(got));
    }
    if (connection >= 0) {
      close(connection);
    }
  }

  int listening_;
  std::string address_;
  std::string bytes_;
  std::thread thread_;
};

/// Returns the pixels of a PFM file, with rows from the top as in a viewer.
std::string pixels_of_pfm(const std::string& file, std::size_t width, std::size_t height) {
  const std::string bytes = file_bytes(file);
  const std::size_t row = width * 12;
  std::string out;
  for (std::size_t y = 0; y < height; ++y) {
    out += bytes.substr(bytes.size() - (y + 1) * row, row);
  }
  return out;
}

constexpr std::size_t kSide = 16;
// Bytes before the pixels in an update packet of tev: length, type, flag that selects the image,
// name of the image with its closing zero (14 bytes for a job), number of channels, their three
// names, rectangle, and offset and stride of each channel.
constexpr std::size_t kHeader = 4 + 1 + 1 + 14 + 4 + 6 + 16 + 48;

// Expects one packet that creates the image and then updates of the whole image, the last of them
// with the pixels of the file `pfm`. `header`: bytes before the pixels.
void expect_the_image(std::vector<std::string> packets, std::size_t header,
                      const std::string& pfm) {
  ASSERT_GE(packets.size(), 2u);
  // Byte 4 is the type of a packet: 4 creates an image, 6 updates it.
  EXPECT_EQ(packets.front()[4], 4) << "the first packet must create the image";
  for (std::size_t i = 1; i < packets.size(); ++i) {
    EXPECT_EQ(packets[i][4], 6);
    ASSERT_EQ(packets[i].size(), header + kSide * kSide * 12);
  }
  EXPECT_TRUE(packets.back().substr(header) == pixels_of_pfm(pfm, kSide, kSide));
}

TEST(Views, AViewerGetsTheImageOfAJobWhileItIsRendered) {
  FarmProcesses farm;
  farm.add_worker("one", 1);
  FakeViewer viewer;
  const Finished done = run(farm.command({"submit", kCornell, "--width", "16", "--samples", "8",
                                          "--tev", viewer.address(), "-o", farm.path("a.pfm")}));
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_EQ(done.err, "");
  expect_the_image(viewer.packets(), kHeader, farm.path("a.pfm"));
}

TEST(Views, AViewerGetsTheImageOfALocalRender) {
  TempDir folder;
  FakeViewer viewer;
  const Finished done = run({BANDSAW_BIN, "render", kCornell, "--width", "16", "--samples", "8",
                             "--tev", viewer.address(), "-o", folder / "a.pfm"});
  ASSERT_EQ(done.code, 0) << done.err;
  const std::size_t name = std::string("cornell").size() + 1;
  expect_the_image(viewer.packets(), kHeader - 14 + name, folder / "a.pfm");
}

TEST(Views, AMissingViewerIsReportedOnceAndTheImageIsRendered) {
  std::string address;
  {
    const FakeViewer gone;
    address = gone.address();
  }
  TempDir folder;
  const Finished done = run({BANDSAW_BIN, "render", kCornell, "--width", "16", "--samples", "8",
                             "--tev", address, "-o", folder / "a.pfm"});
  EXPECT_EQ(done.code, 0);
  EXPECT_THAT(done.err, StartsWith("bandsaw: warning: no viewer at " + address));
  EXPECT_EQ(std::count(done.err.begin(), done.err.end(), '\n'), 1) << done.err;
  EXPECT_FALSE(file_bytes(folder / "a.pfm").empty());
}

// Runs the command on a terminal, which the program `script` provides. `environment`: one more
// variable, "NAME=value". The standard output is what the terminal would show.
Finished on_terminal(const std::vector<std::string>& command, const std::string& environment) {
  std::string line;
  for (const std::string& word : command) {
    line += "'" + word + "' ";
  }
  return run({"/usr/bin/script", "-qec", line, "/dev/null"}, {"TERM=xterm-256color", environment});
}

TEST(Views, TheTerminalShowsTheImage) {
  FarmProcesses farm;
  farm.add_worker("one", 1);
  const auto submit = farm.command({"submit", kCornell, "--width", "16", "--samples", "8",
                                    "--preview", "-o", farm.path("a.png")});
  const Finished shown = on_terminal(submit, "COLUMNS=80");
  EXPECT_EQ(shown.code, 0) << shown.out;
  EXPECT_THAT(shown.out, HasSubstr("\x1b[38;2;"));  // the escape code of a 24-bit colour
  EXPECT_THAT(shown.out, HasSubstr("▀"));
  const Finished plain = on_terminal(submit, "NO_COLOR=1");
  EXPECT_EQ(plain.code, 0) << plain.out;
  EXPECT_THAT(plain.out, Not(HasSubstr("▀")));
  EXPECT_THAT(plain.out, HasSubstr("--preview draws on a terminal with colours only"));
  const Finished piped = run(submit);
  EXPECT_EQ(piped.code, 0) << piped.err;
  EXPECT_THAT(piped.out, Not(HasSubstr("\x1b")));
  EXPECT_THAT(piped.err, StartsWith("bandsaw: --preview draws"));
  EXPECT_EQ(std::count(piped.err.begin(), piped.err.end(), '\n'), 1) << piped.err;
}

TEST(Views, APreviewShowsTheRowsThatAreStored) {
  FarmProcesses farm;
  farm.add_worker("one", 1);
  const auto client = FarmClient::connect(*link::join_string_from(farm.farm_file()));
  ASSERT_TRUE(client.ok()) << client.status();
  EXPECT_TRUE(absl::IsNotFound((*client)->preview(/*job=*/1, /*most_side=*/0).status()));
  const Finished submitted =
      run(farm.command({"submit", kCornell, "--width", "64", "--samples", "1048576", "--detach"}));
  ASSERT_EQ(submitted.code, 0) << submitted.err;
  // preview(1, 20) asks for job 1 with at most about 20 pixels a side. With 0 instead of 20, a
  // preview is as large as the image.
  absl::StatusOr<FarmImage> early = (*client)->preview(1, 20);
  while (absl::IsNotFound(early.status())) {
    early = (*client)->preview(1, 20);
  }
  ASSERT_TRUE(early.ok()) << early.status();
  EXPECT_EQ(early->image.width, 16u);  // every fourth of 64 pixels
  EXPECT_EQ(early->image.height, 16u);
  EXPECT_EQ((*client)->preview(1, 0)->image.width, 64u);
  EXPECT_TRUE(absl::IsInvalidArgument((*client)->preview(1, 65'537).status()));
  EXPECT_TRUE((*client)->cancel(1).ok());
  const Finished done = run(farm.command(
      {"submit", kCornell, "--width", "16", "--samples", "8", "-o", farm.path("a.pfm")}));
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_EQ((*client)->preview(2, 0)->image.pixels, (*client)->result(2)->image.pixels);
}

}  // namespace
}  // namespace bandsaw::test
