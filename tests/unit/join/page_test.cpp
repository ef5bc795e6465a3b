// The page /join, on which a browser joins the farm: its content security policy, the renderer that
// it loads (WebAssembly), and the link that leads to it.

#include <gmock/gmock.h>

#include "absl/strings/escaping.h"
#include "coordinator/web/qr_code.h"
#include "tests/unit/join/join_farm.h"

namespace bandsaw::coordinator {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

class JoinPageTest : public JoinTest {};

TEST_F(JoinPageTest, OnlyThePageForBrowsersMayCompileWebAssembly) {
  for (const char* path : {"/join", "/join.js", "/join_picture.js"}) {
    const auto got = get(path);
    ASSERT_TRUE(got) << path;
    EXPECT_EQ(got->status, 200) << path;
    const std::string policy = got->header("Content-Security-Policy");
    EXPECT_THAT(policy, HasSubstr("script-src 'self' 'wasm-unsafe-eval'; worker-src 'self';"));
    EXPECT_THAT(policy, StartsWith("default-src 'none';"));
    EXPECT_THAT(policy, Not(HasSubstr("unsafe-inline")));
    EXPECT_THAT(policy, Not(HasSubstr("'unsafe-eval'")));
    EXPECT_EQ(got->headers.count("Content-Security-Policy"), 1U)
        << "there must be exactly one policy";
  }
  for (const char* path : {"/", "/main.js", "/style.css", "/join/bandsaw.wasm", "/nothing"}) {
    const std::string policy = get(path)->header("Content-Security-Policy");
    EXPECT_THAT(policy, StartsWith("default-src 'none';")) << path;
    EXPECT_THAT(policy, Not(HasSubstr("wasm"))) << path;
    EXPECT_THAT(policy, Not(HasSubstr("worker-src"))) << path;
    EXPECT_THAT(policy, Not(HasSubstr("unsafe"))) << path;
  }
}

TEST_F(JoinPageTest, ThePageHasNoInlineScriptOrStyle) {
  const std::string page = get("/join")->body;
  EXPECT_THAT(page, Not(HasSubstr("style=")));
  EXPECT_THAT(page, Not(HasSubstr("<style")));
  EXPECT_THAT(page, Not(testing::ContainsRegex("<script[^>]*>[^<]")));
  EXPECT_THAT(page, Not(testing::ContainsRegex(" on[a-z]+=")));
}

TEST_F(JoinPageTest, TheRendererIsCompressedForClientsThatAcceptBrotli) {
  const auto plain = get("/join/bandsaw.wasm");
  ASSERT_TRUE(plain);
  EXPECT_EQ(plain->header("Content-Type"), "application/wasm");
  EXPECT_EQ(plain->body, "the renderer");
  EXPECT_EQ(plain->header("Content-Encoding"), "");
  headers_.emplace("Accept-Encoding", "gzip, deflate, br");
  const auto small = get("/join/bandsaw.wasm");
  EXPECT_EQ(small->body, "smaller");
  EXPECT_EQ(small->header("Content-Encoding"), "br");
  EXPECT_EQ(small->header("Vary"), "Accept-Encoding");
  EXPECT_NE(small->header("ETag"), plain->header("ETag"));
}

TEST_F(JoinPageTest, TheRendererIsFetchedOnceAndThenRevalidated) {
  const std::string tag = get("/join/bandsaw.wasm")->header("ETag");
  EXPECT_EQ(get("/join/bandsaw.wasm")->header("Cache-Control"), "no-cache");
  headers_.emplace("If-None-Match", tag);
  const auto unchanged = get("/join/bandsaw.wasm");
  ASSERT_TRUE(unchanged);
  EXPECT_EQ(unchanged->status, 304);
  EXPECT_EQ(unchanged->body, "");
  options_.browser_program.tag = "4567";  // the tag of a changed renderer
  start_dashboard();
  EXPECT_EQ(get("/join/bandsaw.wasm")->status, 200);
}

TEST_F(JoinPageTest, AMissingRendererIsReportedWithItsRemedy) {
  EXPECT_TRUE(message<web::JoinAbout>(join_get("/join/about")).renderer());
  options_.browser_program = {};
  start_dashboard();
  EXPECT_FALSE(message<web::JoinAbout>(join_get("/join/about")).renderer());
  const auto missing = get("/join/bandsaw.wasm");
  EXPECT_EQ(missing->status, 404);
  EXPECT_THAT(message<web::Problem>(missing).error(), HasSubstr("install share/bandsaw/browser"));
  EXPECT_EQ(get("/join")->status, 200);
}

TEST_F(JoinPageTest, ABlobIsKeptByTheBrowserAndMayBeReadInPart) {
  log_in();
  submit_box();
  test::SocketClient socket = open();
  const std::string manifest = absl::BytesToHexString(lease_to(socket).manifest_sha256());
  const auto whole = join_get("/join/blob/" + manifest);
  ASSERT_EQ(whole->status, 200);
  EXPECT_EQ(wire::sha256(whole->body).hex(), manifest);
  EXPECT_EQ(whole->header("Cache-Control"), "private, max-age=31536000, immutable");
  const auto part = test::http_call(
      dashboard_->port(),
      {.target = "/join/blob/" + manifest,
       .headers = {{"Authorization", "Bearer " + secret_}, {"Range", "bytes=3-9"}}});
  EXPECT_EQ(part->status, 206);
  EXPECT_EQ(part->body, whole->body.substr(3, 7));
}

TEST_F(JoinPageTest, UsersOfTheDashboardMakeShowAndRevokeTheLink) {
  log_in();
  const auto shown = message<web::BrowserLink>(get("/api/link"));
  EXPECT_EQ(shown.url(), base() + "/join#" + secret_);
  EXPECT_GT(shown.left_s(), 0);
  EXPECT_LE(shown.left_s(), 60);
  const auto longer = message<web::BrowserLink>(post("/api/link", "{\"seconds\": 7200}"));
  EXPECT_EQ(longer.url(), shown.url()) << "the link must stay the same";
  EXPECT_GT(longer.left_s(), 7000);
  EXPECT_EQ(post("/api/link", "{\"seconds\": 0.5}")->status, 400);
  EXPECT_EQ(post("/api/link", "{\"seconds\": 1e9}")->status, 400);
  EXPECT_EQ(message<web::BrowserLink>(post("/api/link/revoke")).url(), "");
  EXPECT_EQ(message<web::BrowserLink>(get("/api/link")).url(), "");
  EXPECT_EQ(get("/api/link.svg")->status, 404);
  const auto made = message<web::BrowserLink>(post("/api/link"));
  EXPECT_THAT(made.url(), StartsWith(base() + "/join#"));
  EXPECT_NE(made.url(), shown.url());
  EXPECT_GT(made.left_s(), 7.9 * 3600);  // a new link ends after 8 hours
  const auto code = get("/api/link.svg");
  EXPECT_EQ(code->header("Content-Type"), "image/svg+xml");
  EXPECT_EQ(code->body, qr_svg(*qr_code(made.url())));
}

TEST(Qr, ACodeHasAMarkInThreeOfItsCorners) {
  const auto code = qr_code("https://192.168.1.5:8787/join#0123456789abcdefghijkl");
  ASSERT_TRUE(code.ok());
  EXPECT_EQ((code->side - 17) % 4, 0) << "the side must be one that the standard allows";
  // A mark has 7 x 7 modules (squares of the code). They are dark, except for a light ring around
  // the inner 3 x 3 modules.
  const auto is_mark = [&](int x0, int y0) {
    for (int y = 0; y < 7; ++y) {
      for (int x = 0; x < 7; ++x) {
        const int ring = std::max(std::abs(x - 3), std::abs(y - 3));
        if (code->is_dark(x0 + x, y0 + y) != (ring != 2)) {
          return false;
        }
      }
    }
    return true;
  };
  const int end = code->side - 7;
  EXPECT_TRUE(is_mark(0, 0) && is_mark(end, 0) && is_mark(0, end));
  EXPECT_FALSE(is_mark(end, end));
  EXPECT_FALSE(code->is_dark(-1, 0) || code->is_dark(0, code->side));
  EXPECT_FALSE(qr_code(std::string(5000, 'x')).ok());
}

}  // namespace
}  // namespace bandsaw::coordinator
