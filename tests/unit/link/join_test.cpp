// A join string is the line of text with which a machine or a user connects to a farm. Join strings
// are written and read back, and error messages do not repeat the secret in a join string.
//
// The parts of a join string are the format version, the role (w: worker, f: farm user), the
// addresses, the port or the address of the dashboard after a +, the digest of the certificate, and
// the secret:
//
//   bsw1-f-192.168.1.5:7878,10.0.0.5:7878+8787-<43 characters>-<22 characters>

#include "proto/link/join.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "absl/strings/str_cat.h"
#include "tests/support/temp_dir.h"

namespace bandsaw::link {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

const std::string kSecret = "abcdefghijklmnopqrst-_";
const std::string kDigest43(43, 'A');  ///< a digest of 32 bytes has 43 characters in base64url

/// Returns a join string with three addresses of different forms.
JoinString example() {
  JoinString join;
  join.role = Role::kFarm;
  join.addresses = {"192.168.1.5:7878", "my-host.lan:1", "[fe80::1%eth0]:65535"};
  wire::Digest digest;
  for (std::size_t i = 0; i < digest.bytes.size(); ++i) {
    digest.bytes[i] = static_cast<unsigned char>(255 - i * 7);  // has - and _ in base64url
  }
  join.certificate = digest;
  join.secret = kSecret;
  return join;
}

void expect_equal(const JoinString& a, const JoinString& b) {
  EXPECT_EQ(a.role, b.role);
  EXPECT_EQ(a.addresses, b.addresses);
  EXPECT_EQ(a.web, b.web);
  EXPECT_EQ(a.certificate, b.certificate);
  EXPECT_EQ(a.secret, b.secret);
}

TEST(JoinString, RoundTrips) {
  const JoinString join = example();
  const absl::StatusOr<JoinString> parsed = parse_join_string(join.text() + "\n");
  ASSERT_TRUE(parsed.ok()) << parsed.status();
  expect_equal(*parsed, join);
}

TEST(JoinString, RoundTripsEveryDigestByte) {
  JoinString join = example();
  join.addresses = {"h:1"};
  for (int byte = 0; byte < 256; ++byte) {
    join.certificate->bytes.fill(static_cast<unsigned char>(byte));
    const absl::StatusOr<JoinString> parsed = parse_join_string(join.text());
    ASSERT_TRUE(parsed.ok()) << parsed.status();
    expect_equal(*parsed, join);
  }
}

TEST(JoinString, RoundTripsWithoutACertificate) {
  JoinString join = example();
  join.role = Role::kWorker;
  join.certificate.reset();
  const absl::StatusOr<JoinString> parsed = parse_join_string(join.text());
  ASSERT_TRUE(parsed.ok()) << parsed.status();
  expect_equal(*parsed, join);
}

TEST(JoinString, RoundTripsThePlaceOfTheDashboard) {
  for (const std::string web : {"8787", "127.0.0.1:8787", "[::1]:1"}) {
    for (const bool plain : {false, true}) {
      JoinString join = example();
      join.web = web;
      if (plain) {
        join.certificate.reset();
      }
      const absl::StatusOr<JoinString> parsed = parse_join_string(join.text());
      ASSERT_TRUE(parsed.ok()) << parsed.status();
      expect_equal(*parsed, join);
    }
  }
}

TEST(JoinString, ReportsErrorsWithoutTheSecret) {
  const std::string tail = absl::StrCat("-", kDigest43, "-", kSecret);
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "does not begin with"},
      {"bsw2-w-h:1" + tail, "does not begin with"},
      {"bsw1-x-h:1" + tail, "role"},
      {"bsw1-w-h:1", "secret"},
      {"bsw1-w-h:1-" + kDigest43 + "-short", "cut off"},
      {"bsw1-w-h:1-" + kDigest43 + "-abcdefghijklmnopqrst+/", "secret"},
      {"bsw1-w-h:1-AAAA-" + kSecret, "digest"},
      {"bsw1-w-h:1-" + std::string(43, '*') + "-" + kSecret, "digest"},
      {absl::StrCat("bsw1-w-", tail.substr(1)), "digest"},
      {"bsw1-w-" + tail, "HOST:PORT"},
      {"bsw1-w-host" + tail, "HOST:PORT"},
      {"bsw1-w-:7878" + tail, "HOST:PORT"},
      {"bsw1-w-h:0" + tail, "port"},
      {"bsw1-w-h:65536" + tail, "port"},
      {"bsw1-w-h:78x8" + tail, "port"},
      {"bsw1-w-a:b:1" + tail, "host"},
      {"bsw1-w-a b:1" + tail, "host"},
      {"bsw1-w-[]:1" + tail, "host"},
      {"bsw1-w-h:1," + tail, "HOST:PORT"},
      {"bsw1-f-h:1+0" + tail, "port"},
      {"bsw1-f-h:1+" + tail, "port"},
      {"bsw1-f-h:1+a b:1" + tail, "host"},
      {"bsw1-w-h:1,h:1,h:1,h:1,h:1,h:1,h:1,h:1,h:1" + tail, "more than 8"},
  };
  for (const auto& [text, what] : cases) {
    const absl::StatusOr<JoinString> parsed = parse_join_string(text);
    EXPECT_EQ(parsed.status().code(), absl::StatusCode::kInvalidArgument) << text;
    EXPECT_THAT(std::string(parsed.status().message()), HasSubstr(what)) << text;
    EXPECT_THAT(std::string(parsed.status().message()), Not(HasSubstr(kSecret))) << text;
  }
}

TEST(JoinStringFrom, TakesAStringOrAFile) {
  const test::TempDir folder;
  const std::string path = folder / "join";
  std::ofstream(path) << example().text() << "\n";
  for (const std::string& text : {example().text(), path}) {
    const absl::StatusOr<JoinString> join = join_string_from(text);
    ASSERT_TRUE(join.ok()) << join.status();
    expect_equal(*join, example());
  }
}

TEST(JoinStringFrom, NamesAMissingFile) {
  const absl::StatusOr<JoinString> join = join_string_from("/nowhere/join");
  EXPECT_EQ(join.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(join.status().message()), HasSubstr("/nowhere/join"));
}

TEST(JoinStringFrom, NamesAFileWithOtherContents) {
  const test::TempDir folder;
  const std::string path = folder / "join";
  std::ofstream(path) << "hello\n";
  const absl::StatusOr<JoinString> join = join_string_from(path);
  EXPECT_EQ(join.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(join.status().message()), HasSubstr(path));
}

TEST(JoinStringFrom, DoesNotRepeatAMistypedSecret) {
  const absl::StatusOr<JoinString> join = join_string_from(absl::StrCat("x", example().text()));
  EXPECT_EQ(join.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(join.status().message()), Not(HasSubstr(kSecret)));
}

TEST(HideJoinStrings, RemovesSecretsFromTheArguments) {
  std::string name = "bandsaw-worker";
  std::string apart = example().text();
  std::string joined = absl::StrCat("--join=", example().text());
  char* arguments[] = {name.data(), apart.data(), joined.data()};
  hide_join_strings(arguments);
  EXPECT_EQ(name, "bandsaw-worker");
  EXPECT_EQ(apart, "bsw1-" + std::string(example().text().size() - 5, 'x'));
  EXPECT_EQ(joined, "--join=" + apart);
}

}  // namespace
}  // namespace bandsaw::link
