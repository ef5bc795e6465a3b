// HTTP without a server: parsing of a request's target, byte ranges of a response, and the choice
// of a route by method and path.

#include "coordinator/web/http.h"

#include <gtest/gtest.h>

#include "coordinator/web/router.h"

namespace bandsaw::coordinator {
namespace {

HttpBody no_body() {
  return [] { return absl::string_view(); };
}

TEST(HttpTarget, IsDecoded) {
  HttpRequest request;
  parse_target("/a%20b%2f+?name=x%26y+z&empty=&flag&name=second", request);
  EXPECT_EQ(request.path, "/a b/+");
  EXPECT_EQ(request.parameter("name"), "x&y z");
  EXPECT_EQ(request.parameter("empty"), "");
  EXPECT_EQ(request.parameters.size(), 4u);
  EXPECT_EQ(request.parameter("Name"), "") << "the case of a parameter's name must matter";
  parse_target("/%", request);
  EXPECT_EQ(request.path, "/%");
  EXPECT_TRUE(request.parameters.empty());
  parse_target("/%4%zz%4", request);
  EXPECT_EQ(request.path, "/%4%zz%4");
}

TEST(HttpHeaders, HaveNamesOfAnyCase) {
  HttpRequest request;
  request.headers = {{"X-Bandsaw", "1"}, {"x-bandsaw", "2"}};
  EXPECT_EQ(request.header("x-BANDSAW"), "1");
  EXPECT_FALSE(request.has_header("X-Band"));
}

/// Returns `reply`, restricted to the range of a Range header.
HttpReply ranged(const std::string& range, HttpReply reply = text_reply("0123456789", "text")) {
  HttpRequest request;
  request.method = "GET";
  request.headers = {{"Range", range}};
  return with_range(request, std::move(reply));
}

TEST(HttpRange, ARangeOfOnePartReturnsThatPart) {
  const std::vector<std::tuple<std::string, std::string, std::string>> cases = {
      {"bytes=0-0", "0", "bytes 0-0/10"},  {"bytes=2-5", "2345", "bytes 2-5/10"},
      {"bytes=7-", "789", "bytes 7-9/10"}, {"bytes=7-99", "789", "bytes 7-9/10"},
      {"bytes=-3", "789", "bytes 7-9/10"}, {"bytes=-99", "0123456789", "bytes 0-9/10"},
      {"BYTES=9-9", "9", "bytes 9-9/10"},
  };
  for (const auto& [range, bytes, content_range] : cases) {
    const HttpReply reply = ranged(range);
    EXPECT_EQ(reply.status, 206) << range;
    EXPECT_EQ(reply.bytes, bytes) << range;
    ASSERT_EQ(reply.headers.size(), 1u) << range;
    EXPECT_EQ(reply.headers[0], HttpField("Content-Range", content_range));
  }
}

TEST(HttpRange, ARangeBeyondTheEndIsRefused) {
  for (const std::string range :
       {"bytes=10-", "bytes=10-12", "bytes=-0", "bytes=99999999999999-99999999999999"}) {
    const HttpReply reply = ranged(range);
    EXPECT_EQ(reply.status, 416) << range;
    EXPECT_TRUE(reply.bytes.empty()) << range;
    ASSERT_EQ(reply.headers.size(), 1u) << range;
    EXPECT_EQ(reply.headers[0], HttpField("Content-Range", "bytes */10"));
  }
  for (const std::string range : {"bytes=0-", "bytes=-1", "bytes=0-0"}) {
    EXPECT_EQ(ranged(range, text_reply("", "text")).status, 416) << range << " of an empty body";
  }
}

// The server ignores a malformed range, several ranges, a range of an error message, and a range
// with the condition If-Range.
TEST(HttpRange, AnUnsupportedRangeReturnsEverything) {
  for (const std::string range :
       {"", "bytes", "bytes=", "bytes=-", "bytes=5-2", "bytes=a-b", "bytes=1-2,4-5", "rows=1-2",
        "bytes=1", "bytes=99999999999999999999-", "bytes=--1"}) {
    const HttpReply reply = ranged(range);
    EXPECT_EQ(reply.status, 200) << range;
    EXPECT_EQ(reply.bytes, "0123456789") << range;
  }
  HttpReply missing = text_reply("there is none", "text");
  missing.status = 404;
  EXPECT_EQ(ranged("bytes=2-3", missing).bytes, "there is none");
  HttpRequest conditional;
  conditional.method = "GET";
  conditional.headers = {{"Range", "bytes=2-3"}, {"If-Range", "\"a\""}};
  EXPECT_EQ(with_range(conditional, text_reply("0123456789", "text")).status, 200);
}

// "*" in a route stands for one or more characters other than "/". The handler gets these
// characters as `captured`.
TEST(HttpRouter, ARouteMatchesAMethodAndAWholePath) {
  Router router;
  router.get("/", [](const HttpRequest&) { return text_reply("page", "text"); });
  router.get("/jobs/*", [](const HttpRequest& r) { return text_reply(r.captured, "text"); });
  router.get("/jobs/*/a.png",
             [](const HttpRequest& r) { return text_reply("a " + r.captured, "text"); });
  router.post("/jobs/*/stop", [](const HttpRequest& r, const HttpBody&) {
    return text_reply("stop " + r.captured, "text");
  });
  const auto answer = [&](const std::string& method, const std::string& path) {
    HttpRequest request;
    request.method = method;
    request.path = path;
    const HttpReply reply = router.answer(request, no_body());
    return reply.status == 200 ? std::string(reply.bytes) : std::to_string(reply.status);
  };
  EXPECT_EQ(answer("GET", "/"), "page");
  EXPECT_EQ(answer("HEAD", "/"), "page");
  EXPECT_EQ(answer("GET", "/jobs/17"), "17");
  EXPECT_EQ(answer("GET", "/jobs/17/a.png"), "a 17");
  EXPECT_EQ(answer("POST", "/jobs/17/stop"), "stop 17");
  for (const std::string path : {"", "//", "/jobs/", "/jobs", "/jobs/1/2", "/jobs//a.png",
                                 "/jobs/a.png/", "/jobs/1/2/a.png", "/jobs/1/stop", "/\n"}) {
    EXPECT_EQ(answer("GET", path), "404") << path;
  }
  EXPECT_EQ(answer("POST", "/"), "404");
  EXPECT_EQ(answer("GET", "/jobs/a.png"), "a.png");
}

}  // namespace
}  // namespace bandsaw::coordinator
