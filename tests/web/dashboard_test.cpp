// The dashboard in a real browser, with a real farm. Screenshots for inspection are kept in the
// build folder's `screenshots`.

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "absl/strings/str_replace.h"
#include "tests/support/temp_dir.h"
#include "tests/web/browser.h"

namespace bandsaw::test {
namespace {

using ::testing::IsEmpty;

std::string content_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream bytes;
  bytes << file.rdbuf();
  return bytes.str();
}

/// Returns the Cornell box as a scene file, with 96 pixels a side so that one core renders it
/// quickly.
std::string cornell() {
  return absl::StrReplaceAll(content_of(std::string(BANDSAW_GALLERY) + "/cornell.textproto"),
                             {{"480", "96"}});
}

class DashboardTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (chromedriver_program().empty()) {
      GTEST_SKIP() << "chromedriver is not installed (packages chromium, chromium-driver)";
    }
    std::filesystem::create_directories(BANDSAW_SCREENSHOTS);
    coordinator_.emplace(Process::start({BANDSAW_BIN, "serve", "--data", folder_ / "data",
                                         "--listen", "127.0.0.1:0", "--web", "127.0.0.1:0"}));
    ASSERT_TRUE(coordinator_->wait_for("join with:")) << coordinator_->err();
    worker_.emplace(Process::start({BANDSAW_WORKER_BIN, "--join", folder_ / "data/join", "--name",
                                    "desk", "--threads", "1", "--cache", folder_ / "cache"}));
    ASSERT_TRUE(worker_->wait_for("joined")) << worker_->err();
    link_ = content_of(folder_ / "data/dashboard");
    link_.pop_back();
    base_ = link_.substr(0, link_.find("/#"));
  }

  /// Logs in and opens the list of jobs.
  void enter(Browser& browser) {
    browser.go(link_);
    ASSERT_TRUE(browser.wait("document.querySelector('h1')?.textContent === 'Jobs'"));
  }
  /// Drops the file on the page as if it were dragged from the desktop.
  static void drop(Browser& browser, const std::string& name, const std::string& scene) {
    browser.run(
        "const data = new DataTransfer(); data.items.add(new File([arguments[0]], '" + name +
            "'));"
            "for (const kind of ['dragenter', 'dragover', 'drop'])"
            "  window.dispatchEvent(new DragEvent(kind, {dataTransfer: data, cancelable: true}));",
        scene);
  }
  static std::string shot(const std::string& name) {
    return std::string(BANDSAW_SCREENSHOTS) + "/" + name + ".png";
  }
  /// Returns true if the page is not wider than the window.
  static bool fits(Browser& browser) {
    return browser.wait("document.documentElement.scrollWidth <= window.innerWidth");
  }
  /// Returns true if no text of a gallery card is cut off.
  static bool cards_fit(Browser& browser) {
    return browser.wait(
        "[...document.querySelectorAll('.scene .text')]"
        ".every((one) => one.scrollWidth <= one.clientWidth)");
  }

  TempDir folder_;
  std::optional<Process> coordinator_;
  std::optional<Process> worker_;
  std::string link_;  ///< address of the dashboard with the secret
  std::string base_;  ///< the address alone
};

// Expressions in JavaScript. kPreview: the address of a job's picture. kPictured: true if the
// picture is shown. kDone: true if the job is done.
constexpr char kPreview[] = "document.querySelector('.picture img').src";
constexpr char kPictured[] = "document.querySelector('.picture img')?.naturalWidth > 0";
constexpr char kDone[] = "document.querySelector('.title .state')?.textContent === 'done'";

TEST_F(DashboardTest, RequiresTheJoinString) {
  Browser browser;
  browser.go(base_);
  ASSERT_TRUE(browser.wait("document.querySelector('form input')"));
  browser.screenshot(shot("login"));
  EXPECT_THAT(browser.console_errors(), IsEmpty());
  browser.type("form input", "wrong\n");
  EXPECT_TRUE(browser.wait("document.querySelector('[role=alert]').textContent !== ''"));
  browser.console_errors();  // discards the logged error of the refused request
  browser.run("document.querySelector('form input').value = ''");
  browser.type("form input", content_of(folder_ / "data/farm"));
  EXPECT_TRUE(browser.wait("document.querySelector('h1')?.textContent === 'Jobs'"));
  browser.screenshot(shot("jobs-none"));
  browser.go(base_);  // the cookie is kept
  EXPECT_TRUE(browser.wait("document.querySelector('h1')?.textContent === 'Jobs'"));
  EXPECT_THAT(browser.console_errors(), IsEmpty());
}

// An expression in JavaScript: the card with the link for browsers, if it is shown. Whoever opens
// this link can let a browser render for the farm.
constexpr char kCard[] = "document.querySelector('.invite:not([hidden])')";

TEST_F(DashboardTest, TheLinkForBrowsersIsShownOpenedAndRevoked) {
  Browser browser;
  enter(browser);
  browser.run("location.hash = '#/workers'");
  ASSERT_TRUE(browser.wait("document.querySelector('.joining button')"));
  browser.click(".joining button");
  ASSERT_TRUE(browser.wait(kCard));
  const std::string url = browser.text(std::string(kCard) + ".querySelector('input').value");
  EXPECT_THAT(url, ::testing::StartsWith(base_ + "/join#"));
  EXPECT_TRUE(browser.wait("document.querySelector('.code').naturalWidth > 0"));
  browser.screenshot(shot("link"));
  EXPECT_THAT(browser.console_errors(), IsEmpty());
  browser.go(url);
  // The page shows its introduction. If this build has no renderer for browsers, the page reports a
  // problem instead. It must not say that the device cannot join, as for a revoked link.
  EXPECT_TRUE(
      browser.wait("document.querySelector('#intro:not([hidden]), #problem:not([hidden])')"));
  EXPECT_NE(browser.text("document.querySelector('#problem h1').textContent"),
            "This device cannot join");
  EXPECT_THAT(browser.console_errors(), IsEmpty());
  enter(browser);
  browser.run("location.hash = '#/workers'");
  ASSERT_TRUE(browser.wait("document.querySelector('.joining button')"));
  browser.click(".joining button");
  ASSERT_TRUE(browser.wait(kCard));
  browser.click(".invite .danger");
  EXPECT_TRUE(browser.wait("document.querySelector('.invite').hidden"));
  browser.go(url);
  EXPECT_TRUE(browser.wait(
      "document.querySelector('#problem h1').textContent === 'This device cannot join'"));
}

TEST_F(DashboardTest, ADroppedSceneIsRenderedAndItsImageDownloaded) {
  Browser browser;
  enter(browser);
  browser.run(
      "document.querySelector('select').value = 'samples=256';"
      "document.querySelector('select').dispatchEvent(new Event('change'));");
  drop(browser, "cornell.textproto", cornell());
  ASSERT_TRUE(browser.wait("location.hash === '#/jobs/1'"));
  ASSERT_TRUE(browser.wait(kPictured));
  const std::string first = browser.text(kPreview);
  // `done`: the percentage of the job that is done, as the page shows it.
  const std::string done = browser.text("document.querySelector('.big strong').textContent");
  EXPECT_TRUE(browser.wait(std::string(kPreview) + " !== '" + first + "'"));
  EXPECT_TRUE(browser.wait("document.querySelector('.big strong').textContent !== '" + done + "'"));
  browser.run(
      "[...document.querySelectorAll('button')]"
      ".find((one) => one.textContent === 'Who rendered what').click()");
  EXPECT_TRUE(browser.wait("document.querySelectorAll('.owners i').length > 0"));
  browser.screenshot(shot("job-running"));
  EXPECT_TRUE(browser.wait(kDone));
  EXPECT_TRUE(browser.wait("document.querySelector('.plot polyline')"));
  browser.screenshot(shot("job-done"));
  // The first bytes of each kind of file: the signatures of PNG and EXR, and "{\n  ".
  const std::map<std::string, std::string> first_bytes = {
      {"png", "137,80,78,71"}, {"exr", "118,47,49,1"}, {"json", "123,10,32,32"}};
  for (const auto& [suffix, bytes] : first_bytes) {
    const std::string link = "document.querySelector('a[download=\"cornell-1." + suffix + "\"]')";
    ASSERT_TRUE(browser.wait(link + "?.hidden === false"));
    browser.run("fetch(" + link +
                ".href).then((answer) => answer.arrayBuffer())"
                ".then((bytes) => { window.taken = new Uint8Array(bytes); });");
    EXPECT_TRUE(browser.wait("window.taken?.length > 1000"));
    EXPECT_EQ(browser.text("window.taken.slice(0, 4)"), bytes);
    browser.run("window.taken = null");
  }
  EXPECT_THAT(browser.console_errors(), IsEmpty());
}

TEST_F(DashboardTest, AStripOfFramesFillsAndPlays) {
  const std::string scene = folder_ / "fly.textproto";
  std::ofstream(scene) << cornell() << R"(track { field: "camera.position"
      key { time: 0 value: [278, 278, -800] } key { time: 1 value: [478, 378, -700] } })";
  const Finished sent = run({BANDSAW_BIN, "submit", scene, "--farm", folder_ / "data/farm",
                             "--frames", "1-24", "--samples", "32", "--detach"});
  ASSERT_EQ(sent.code, 0) << sent.err;
  Browser browser;
  enter(browser);
  browser.run("location.hash = '#/jobs/1'");
  ASSERT_TRUE(browser.wait("document.querySelectorAll('.strip .frame').length === 24"));
  ASSERT_TRUE(
      browser.wait("[...document.querySelectorAll('.frame[data-state=done] img')]"
                   ".filter((one) => one.naturalWidth > 0).length >= 8"));
  browser.screenshot(shot("frames-running"));
  ASSERT_TRUE(browser.wait("document.querySelectorAll('.frame[data-state=done]').length === 24"));
  ASSERT_TRUE(browser.wait(kPictured));
  const std::string first = browser.text(kPreview);
  browser.run(
      "[...document.querySelectorAll('button')]"
      ".find((one) => one.textContent === 'Play').click()");
  EXPECT_TRUE(browser.wait(std::string(kPreview) + " !== '" + first + "'"));
  EXPECT_TRUE(browser.wait("document.querySelector('.frame[aria-current] span').textContent > 6"));
  browser.run("document.querySelectorAll('.strip .frame')[16].click()");
  EXPECT_EQ(browser.text("document.querySelector('.frame[aria-current] span').textContent"), "17");
  EXPECT_TRUE(browser.wait(kPictured));
  browser.screenshot(shot("frames-done"));
  browser.run("location.hash = '#/'");
  EXPECT_TRUE(browser.wait("document.body.textContent.includes('24 of 24 frames')"));
  browser.screenshot(shot("frames-jobs"));
  EXPECT_THAT(browser.console_errors(), IsEmpty());
}

TEST_F(DashboardTest, ABrokenSceneGivesOneErrorSentence) {
  Browser browser;
  enter(browser);
  drop(browser, "bad.textproto", "camera {");
  EXPECT_TRUE(
      browser.wait("document.querySelector('#notice.bad')?.textContent.includes('bad.textproto:')"))
      << browser.text("document.querySelector('#notice').textContent");
  drop(browser, "model.obj", "v 0 0 0");
  EXPECT_TRUE(
      browser.wait("document.querySelector('#notice').textContent.includes('bandsaw submit')"));
  browser.screenshot(shot("notice"));
}

TEST_F(DashboardTest, ACorrectedFileMayBeChosenAgain) {
  const std::string scene = folder_ / "scene.textproto";
  std::ofstream(scene) << "camera {";
  Browser browser;
  enter(browser);
  browser.run("document.querySelector('input[type=file]').hidden = false");
  browser.type("input[type=file]", scene);
  ASSERT_TRUE(browser.wait("document.querySelector('#notice.bad')"));
  std::ofstream(scene) << cornell();
  browser.type("input[type=file]", scene);
  EXPECT_TRUE(browser.wait("location.hash === '#/jobs/1'"));
}

TEST_F(DashboardTest, AJobIsPausedResumedAndCancelled) {
  Browser browser({.dark = true});
  enter(browser);
  drop(browser, "cornell.textproto", cornell());
  ASSERT_TRUE(browser.wait("location.hash === '#/jobs/1'"));
  const auto press = [&](const std::string& word) {
    EXPECT_TRUE(
        browser.wait("[...document.querySelectorAll('button:not([hidden])')]"
                     ".some((one) => one.textContent === '" +
                     word + "')"));
    browser.run(
        "[...document.querySelectorAll('button')]"
        ".find((one) => one.textContent === '" +
        word + "').click()");
  };
  const auto becomes = [&](const std::string& state) {
    EXPECT_TRUE(
        browser.wait("document.querySelector('.title .state')?.textContent === '" + state + "'"));
  };
  press("Pause");
  becomes("paused");
  press("Resume");
  becomes("running");
  EXPECT_TRUE(browser.wait(kPictured));
  browser.screenshot(shot("job-dark"));
  press("Cancel");
  becomes("cancelled");
  browser.go(base_ + "/#/workers");
  EXPECT_TRUE(browser.wait("document.querySelector('.worker .name')?.textContent === 'desk'"));
  browser.click("details summary");
  EXPECT_TRUE(browser.wait("document.querySelector('details pre').textContent.length > 20"));
  browser.screenshot(shot("workers-dark"));
  EXPECT_THAT(browser.console_errors(), IsEmpty());
}

TEST_F(DashboardTest, APictureThatWasNotLoadedIsRequestedAgain) {
  Browser browser;
  enter(browser);
  browser.run(
      "window.failed = {};"
      "document.addEventListener('error', ({target}) => { window.failed[target.src] = true; },"
      "  true);");
  // Waits until a picture whose address contains `part` has failed, then lets requests pass. The
  // parts below: "at=end" is in the address of the picture of a finished job, "clean.png" of its
  // denoised picture, and "side=256" of its small picture in the list of jobs.
  const auto fails = [&](const std::string& part) {
    EXPECT_TRUE(
        browser.wait("Object.keys(window.failed).some((one) => one.includes('" + part + "'))"));
    browser.block("");
  };
  browser.block("*/preview.png*");
  drop(browser, "cornell.textproto", cornell());
  fails("at=end");
  EXPECT_TRUE(browser.wait(kPictured));
  EXPECT_TRUE(browser.wait("!document.querySelector('.picture img').hidden"));
  browser.block("*/clean.png*");
  browser.click("[data-mode=clean]");
  fails("clean.png");
  EXPECT_TRUE(browser.wait("document.querySelectorAll('.pictures img')[1].naturalWidth > 0"));
  browser.block("*/preview.png*");
  browser.run("window.failed = {}; location.hash = '#/jobs'");
  fails("side=256");
  EXPECT_TRUE(browser.wait("document.querySelector('.thumb')?.naturalWidth > 0"));
}

// In the gallery, the first menu (select) chooses the width of the image, the second the number of
// samples. A click on `.face`, the picture of a card, renders the scene, or opens the job that has
// rendered it. `.took` shows the render time.
TEST_F(DashboardTest, TheGalleryFitsAPhoneAndRendersAScene) {
  Browser browser({.width = 390, .height = 844, .pixel_ratio = 2, .phone = true});
  enter(browser);
  EXPECT_TRUE(fits(browser));
  browser.go(base_ + "/#/gallery");
  ASSERT_TRUE(browser.wait("document.querySelectorAll('.scene').length > 20"));
  EXPECT_TRUE(fits(browser));
  EXPECT_EQ(browser.text("document.querySelector('select').value"),
            "640");  // the largest choice that fits into 2 x 390 pixels
  browser.run(
      "document.querySelectorAll('select')[1].value = '4';"
      "document.querySelectorAll('select')[1].dispatchEvent(new Event('change'));");
  browser.click("[data-scene=spheres] .face");
  EXPECT_TRUE(
      browser.wait("/^[0-9,]+ ms$/.test("
                   "document.querySelector('[data-scene=spheres] .took').textContent)"));
  EXPECT_TRUE(browser.wait("document.querySelector('[data-scene=spheres] img').naturalWidth > 0"));
  browser.run("document.querySelector('[data-scene=spheres]').scrollIntoView({block: 'center'})");
  EXPECT_TRUE(cards_fit(browser));
  browser.screenshot(shot("gallery-phone"));
  browser.click("[data-scene=spheres] .face");
  ASSERT_TRUE(browser.wait(kDone));
  EXPECT_TRUE(browser.wait(kPictured));
  EXPECT_TRUE(fits(browser));
  browser.screenshot(shot("job-phone"));
  browser.go(base_ + "/#/jobs");
  EXPECT_TRUE(browser.wait("document.querySelectorAll('.job').length === 1"));
  EXPECT_TRUE(browser.wait("document.querySelector('.thumb').naturalWidth > 0"));
  EXPECT_TRUE(fits(browser));
  browser.screenshot(shot("jobs-phone"));
  EXPECT_THAT(browser.console_errors(), IsEmpty());
}

TEST_F(DashboardTest, TheGalleryRendersScenesInDarkMode) {
  Browser browser({.dark = true});
  enter(browser);
  browser.click("nav a[href='#/gallery']");
  ASSERT_TRUE(browser.wait("document.querySelectorAll('.scene').length > 20"));
  browser.run(
      "document.querySelectorAll('select')[0].value = '320';"
      "document.querySelectorAll('select')[0].dispatchEvent(new Event('change'));"
      "document.querySelectorAll('select')[1].value = '4';"
      "document.querySelectorAll('select')[1].dispatchEvent(new Event('change'));");
  // The last scene needs a map that the build generates; the repository does not contain it.
  for (const char* scene : {"cube_map", "checker_and_noise", "study/texture_512"}) {
    browser.click(std::string("[data-scene='") + scene + "'] .face");
    EXPECT_TRUE(browser.wait(std::string("/ ms$/.test(document.querySelector('[data-scene=\"") +
                             scene + "\"] .took').textContent)"));
  }
  EXPECT_TRUE(cards_fit(browser));
  browser.run("window.scrollTo(0, 0)");
  browser.screenshot(shot("gallery-dark"));
  browser.run("document.querySelector('[data-scene=cube_map] .foot button').click()");
  EXPECT_TRUE(browser.wait("!document.querySelector('[data-scene=cube_map] .bar').hidden"));
  EXPECT_THAT(browser.console_errors(), IsEmpty());
}

}  // namespace
}  // namespace bandsaw::test
