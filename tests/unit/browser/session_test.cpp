// Tests the session of a browser's tab with the coordinator, through the functions that the session
// exports. The tests make the messages of the coordinator; a lease is a message that assigns a band
// (some samples of some rows) to the worker. Answers of the functions are JSON or serialised
// messages. The helper good() expects that a call succeeds, and error_of() that a call fails. Both
// return the answer of the call.

#include <gmock/gmock.h>
#include <google/protobuf/struct.pb.h>
#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "absl/strings/escaping.h"
#include "proto/convert/render_values.h"
#include "proto/farm.pb.h"
#include "proto/wire/digest.h"
#include "proto/wire/limits.h"
#include "renderlib/render/canary.h"
#include "renderlib/render/pixel_version.h"
#include "tests/support/session_messages.h"
#include "tests/unit/browser/answers.h"
#include "worker/browser/exports.h"
#include "worker/browser/json_text.h"

namespace bandsaw::worker {
namespace {

using google::protobuf::Struct;
using google::protobuf::Value;
using test::lease;
using test::revoke;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr double kMemory = 3e9;

/// Returns the message with which the coordinator accepts the worker. `epoch`: id of the
/// coordinator's process.
farm::ToWorker welcome(const std::string& epoch) {
  farm::ToWorker message;
  message.mutable_welcome()->set_name("tab-2");
  message.mutable_welcome()->set_heartbeat_ms(500);
  message.mutable_welcome()->set_epoch(epoch);
  return message;
}

farm::FromWorker message_of(const std::string& bytes) {
  farm::FromWorker message;
  EXPECT_TRUE(message.ParseFromString(bytes));
  return message;
}
Struct json_of(const std::string& text) {
  Struct json;
  EXPECT_TRUE(google::protobuf::util::JsonStringToMessage(text, &json).ok()) << text;
  return json;
}
/// Returns a field, which MUST be there.
const Value& field(const Struct& json, const std::string& name) { return json.fields().at(name); }
const Value& field(const Value& json, const std::string& name) {
  return field(json.struct_value(), name);
}

BandsawSession* make(const std::string& instance = std::string(32, 'a'),
                     const std::string& name = "tab", const std::string& build = "test",
                     std::uint32_t threads = 4) {
  return bandsaw_session_new(instance.data(), instance.size(), name.data(), name.size(),
                             build.data(), build.size(), threads, kMemory);
}

class BrowserSessionTest : public ::testing::Test {
 protected:
  ~BrowserSessionTest() override { bandsaw_session_delete(session_); }

  Struct receive(const farm::ToWorker& message) {
    const std::string bytes = message.SerializeAsString();
    return json_of(good(bandsaw_session_receive(session_, bytes.data(), bytes.size())));
  }
  /// Receives a lease of two rows, and returns the task that the tab is told to start.
  std::uint32_t start(std::uint64_t id, std::uint32_t first_row) {
    return static_cast<std::uint32_t>(
        field(field(receive(lease(id, first_row)), "start"), "task").number_value());
  }
  /// Reports that `rows` rows of the band are rendered in all. `counters`: those of the new rows.
  void render(std::uint32_t task, std::uint32_t rows, const Counters& counters) {
    const std::string bytes = to_message(counters).SerializeAsString();
    EXPECT_EQ(good(bandsaw_session_rendering(session_, task, rows, bytes.data(), bytes.size())),
              "");
  }
  /// Returns the header of a finished band of 8 x 2 pixels, 384 bytes, with a render time of 2 s
  /// and a CPU time of 3 s.
  const BandsawAnswer* header(std::uint32_t task) {
    const std::string digest = wire::sha256("sums").raw();
    return bandsaw_session_band_header(session_, task, digest.data(), digest.size(), 384, 2, 3);
  }
  /// Tells the session that the task has failed. Returns the message for the coordinator, which is
  /// empty if the lease was revoked.
  std::string failed(std::uint32_t task, const std::string& reason, const std::string& log) {
    return good(bandsaw_session_failed(session_, task, reason.data(), reason.size(), log.data(),
                                       log.size()));
  }
  /// Gives the session the coordinator's reply to the band of the task.
  const BandsawAnswer* reply(std::uint32_t task, farm::PutBandReply::Outcome outcome) {
    farm::PutBandReply message;
    message.set_outcome(outcome);
    const std::string bytes = message.SerializeAsString();
    return bandsaw_session_band_reply(session_, task, bytes.data(), bytes.size());
  }
  Struct state() { return json_of(good(bandsaw_session_state(session_))); }

  BandsawSession* session_ = make();
};

TEST(JsonText, EscapesCharactersThatJsonCannotContain) {
  EXPECT_EQ(json_text("a\"b\\c\n\x1f ü"), "\"a\\\"b\\\\c\\u000a\\u001f ü\"");
}

TEST_F(BrowserSessionTest, SendsItsIdentityInHello) {
  const farm::FromWorker message = message_of(good(bandsaw_session_hello(session_)));
  EXPECT_EQ(message.hello().instance(), std::string(32, 'a'));
  EXPECT_EQ(message.hello().name(), "tab");
  EXPECT_EQ(message.hello().build(), "test");
  EXPECT_EQ(message.hello().threads(), 4U);
  EXPECT_EQ(message.hello().memory_bytes(), 3'000'000'000U);
  EXPECT_EQ(message.hello().pixel_version(), kPixelVersion);
  EXPECT_EQ(message.hello().canary(), canary());
}

TEST_F(BrowserSessionTest, SendsTheOfferedCoresAndMemoryInTheNextHello) {
  EXPECT_EQ(good(bandsaw_session_offer(session_, 2, 1e9)), "");
  const farm::FromWorker message = message_of(good(bandsaw_session_hello(session_)));
  EXPECT_EQ(message.hello().threads(), 2U);
  EXPECT_EQ(message.hello().memory_bytes(), 1'000'000'000U);
}

TEST_F(BrowserSessionTest, HandsOutALeaseAndSendsItsBand) {
  receive(welcome("e1"));
  EXPECT_EQ(field(state(), "name").string_value(), "tab-2");
  EXPECT_EQ(field(state(), "heartbeat_ms").number_value(), 500);
  const Struct orders = receive(lease(10, 2));
  const Value& started = field(orders, "start");
  EXPECT_EQ(field(started, "job").number_value(), 7);
  EXPECT_EQ(field(started, "manifest").string_value(), wire::Digest().hex());
  EXPECT_EQ(field(started, "width").number_value(), 8);
  EXPECT_EQ(field(started, "height").number_value(), 80);
  EXPECT_EQ(field(started, "first").number_value(), 2);
  EXPECT_EQ(field(started, "last").number_value(), 4);
  EXPECT_EQ(field(started, "samples").number_value(), 8 * 2 * 16);
  std::string bytes;
  ASSERT_TRUE(absl::Base64Unescape(field(started, "lease").string_value(), &bytes));
  EXPECT_EQ(bytes, lease(10, 2).lease().SerializeAsString());
  const auto task = static_cast<std::uint32_t>(field(started, "task").number_value());

  EXPECT_EQ(good(bandsaw_session_preparing(session_, task, 1000)), "");
  farm::FromWorker beat = message_of(good(bandsaw_session_heartbeat(session_)));
  EXPECT_EQ(beat.heartbeat().lease(0).prepared(), 1000U);
  // Rows may be rendered in any order. The session reports the bad sample whose row comes first in
  // the band, here that of row 2.
  render(task, 1, {.rays = 5, .bad_samples = 1, .bad_x = 1, .bad_y = 3, .bad_sample = 4});
  render(task, 2, {.rays = 7, .bad_samples = 1, .bad_x = 6, .bad_y = 2, .bad_sample = 9});
  beat = message_of(good(bandsaw_session_heartbeat(session_)));
  EXPECT_EQ(beat.heartbeat().lease(0).rows_done(), 2U);
  EXPECT_EQ(beat.heartbeat().doing(), "rendering");
  EXPECT_EQ(good(bandsaw_session_finished(session_, task)), "true");

  const std::string prefix = good(header(task));
  const auto length = static_cast<unsigned char>(prefix[0]);
  ASSERT_EQ(prefix.size(), 4U + length);
  EXPECT_EQ(prefix.substr(1, 3), std::string(3, '\0'));
  farm::BandHeader sent;
  ASSERT_TRUE(sent.ParseFromString(prefix.substr(4)));
  EXPECT_EQ(sent.job(), 7U);
  EXPECT_EQ(sent.lease(), 10U);
  EXPECT_EQ(sent.epoch(), "e1");
  EXPECT_EQ(sent.instance(), std::string(32, 'a'));
  EXPECT_EQ(sent.size(), 384U);
  EXPECT_EQ(sent.sha256(), wire::sha256("sums").raw());
  EXPECT_EQ(band_of(sent.band()), (Band{{0, 16}, {2, 4}}));
  EXPECT_NE(sent.work(), 0U);
  EXPECT_EQ(counters_of(sent.counters()),
            (Counters{.rays = 12, .bad_samples = 2, .bad_x = 6, .bad_y = 2, .bad_sample = 9}));
  EXPECT_EQ(sent.counters().render_s(), 2);
  EXPECT_EQ(sent.counters().cpu_s(), 3);

  EXPECT_EQ(good(reply(task, farm::PutBandReply::OUTCOME_STORED)), "stored");
  EXPECT_EQ(message_of(good(bandsaw_session_hello(session_))).hello().held_size(), 0);
  EXPECT_THAT(error_of(header(task)), HasSubstr("not held"));
}

TEST_F(BrowserSessionTest, ReportsTheOutcomeOfABand) {
  receive(welcome("e1"));
  EXPECT_EQ(good(reply(start(1, 0), farm::PutBandReply::OUTCOME_DUPLICATE)), "duplicate");
  EXPECT_EQ(good(reply(start(2, 2), farm::PutBandReply::OUTCOME_UNWANTED)), "unwanted");
}

TEST_F(BrowserSessionTest, KeepsItsBandsOverAReconnect) {
  receive(welcome("e1"));
  const std::uint32_t task = start(10, 0);
  render(task, 2, {.rays = 5});
  good(bandsaw_session_finished(session_, task));
  good(bandsaw_session_disconnected(session_));
  EXPECT_FALSE(field(state(), "connected").bool_value());
  EXPECT_THAT(error_of(header(task)), HasSubstr("not connected"));
  const farm::FromWorker hello = message_of(good(bandsaw_session_hello(session_)));
  ASSERT_EQ(hello.hello().held_size(), 1);
  EXPECT_TRUE(hello.hello().held(0).finished());
  receive(welcome("e2"));
  EXPECT_TRUE(field(receive(lease(3, 0)), "start").has_null_value())
      << "the band is rendered already, so it must not start again";
  farm::BandHeader sent;
  ASSERT_TRUE(sent.ParseFromString(good(header(task)).substr(4)));
  EXPECT_EQ(sent.lease(), 3U);
  EXPECT_EQ(sent.epoch(), "e2");
  EXPECT_EQ(sent.counters().rays(), 5U);
}

TEST_F(BrowserSessionTest, StopsABandThatIsRevoked) {
  receive(welcome("e1"));
  const std::uint32_t task = start(10, 0);
  const Struct orders = receive(revoke(10));
  ASSERT_EQ(field(orders, "stop").list_value().values_size(), 1);
  EXPECT_EQ(field(orders, "stop").list_value().values(0).number_value(), task);
  render(task, 1, {});  // these rows had been begun before the order to stop
  EXPECT_EQ(good(bandsaw_session_finished(session_, task)), "false");
  EXPECT_EQ(failed(task, "why", ""), "");
}

TEST_F(BrowserSessionTest, ReportsAFailureWithItsReasonAndLog) {
  receive(welcome("e1"));
  const farm::FromWorker message =
      message_of(failed(start(10, 0), "not enough\nmemory", "one\n\ntwo\n"));
  EXPECT_EQ(message.failed().lease(), 10U);
  EXPECT_EQ(message.failed().reason(), "not enough memory");
  EXPECT_THAT(message.failed().log(), ElementsAre("one", "two"));
}

TEST_F(BrowserSessionTest, RefusesAnInvalidLease) {
  receive(welcome("e1"));
  farm::ToWorker bad = lease(10, 0);
  bad.mutable_lease()->mutable_band()->set_last_row(81);
  const Struct orders = receive(bad);
  EXPECT_TRUE(field(orders, "start").has_null_value());
  std::string bytes;
  ASSERT_TRUE(
      absl::Base64Unescape(field(orders, "send").list_value().values(0).string_value(), &bytes));
  EXPECT_EQ(message_of(bytes).failed().lease(), 10U);
}

TEST_F(BrowserSessionTest, PassesOnADismissal) {
  receive(welcome("e1"));
  const std::uint32_t task = start(10, 0);
  farm::ToWorker bye;
  bye.mutable_bye()->set_reason("go \"home\"");
  bye.mutable_bye()->set_retry_after_ms(700);
  const Struct orders = receive(bye);
  EXPECT_EQ(field(orders, "stop").list_value().values(0).number_value(), task);
  EXPECT_EQ(field(field(orders, "dismissal"), "reason").string_value(), "go \"home\"");
  EXPECT_EQ(field(field(orders, "dismissal"), "wait_ms").number_value(), 700);
  EXPECT_FALSE(field(field(orders, "dismissal"), "for_ever").bool_value());
}

TEST_F(BrowserSessionTest, PausesAndResumes) {
  receive(welcome("e1"));
  const std::uint32_t task = start(10, 0);
  const farm::FromWorker message = message_of(good(bandsaw_session_drain(session_, "paused", 6)));
  EXPECT_EQ(message.draining().reason(), "paused");
  EXPECT_FALSE(field(state(), "drained").bool_value());
  good(bandsaw_session_finished(session_, task));
  good(reply(task, farm::PutBandReply::OUTCOME_STORED));
  EXPECT_TRUE(field(state(), "drained").bool_value());
  good(bandsaw_session_disconnected(session_));
  good(bandsaw_session_resume(session_));
  EXPECT_FALSE(field(state(), "drained").bool_value());
  EXPECT_THAT(field(receive(welcome("e1")), "send").list_value().values(), IsEmpty());
  EXPECT_GT(start(11, 2), task);
}

TEST_F(BrowserSessionTest, SendsNoMoreLinesThanAMessageHolds) {
  std::string lines;
  for (int i = 0; i < 100; ++i) {
    lines += "line\n";
  }
  const farm::FromWorker message =
      message_of(good(bandsaw_session_log(session_, lines.data(), lines.size())));
  EXPECT_EQ(static_cast<std::size_t>(message.log().line_size()), wire::kLogLines);
}

TEST_F(BrowserSessionTest, HashesBytes) {
  EXPECT_EQ(good(bandsaw_session_sha256(session_, "sums", 4)), wire::sha256("sums").raw());
}

TEST(BrowserSession, RefusesWrongArguments) {
  const std::string id(32, 'a');
  const std::pair<BandsawSession*, std::string> sessions[] = {
      {make("short"), "instance"},
      {make(std::string(32, 'x')), "instance"},
      {make(id, ""), "name"},
      {make(id, std::string(65, 'n')), "name"},
      {make(id, "n", "\x01"), "build"},
      {make(id, "n", "b", 0), "cores"},
      {make(id, "n", "b", 5000), "cores"}};
  for (const auto& [session, argument] : sessions) {
    EXPECT_THAT(error_of(bandsaw_session_answer(session)), HasSubstr(argument));
    EXPECT_THAT(error_of(bandsaw_session_hello(session)), HasSubstr(argument));
    bandsaw_session_delete(session);
  }
}

TEST_F(BrowserSessionTest, ReportsBytesThatAreNoMessage) {
  const std::string nonsense(20, '\xff');
  EXPECT_THAT(error_of(bandsaw_session_receive(session_, nonsense.data(), nonsense.size())),
              HasSubstr("not a message"));
  receive(welcome("e1"));
  const std::uint32_t task = start(10, 0);
  error_of(bandsaw_session_rendering(session_, task, 1, nonsense.data(), nonsense.size()));
  error_of(bandsaw_session_band_reply(session_, task, nonsense.data(), nonsense.size()));
  EXPECT_THAT(error_of(bandsaw_session_band_header(session_, task, "abc", 3, 0, 0, 0)),
              HasSubstr("32 bytes"));
  EXPECT_EQ(message_of(good(bandsaw_session_hello(session_))).hello().held_size(), 1);
}

// A message has a wrong byte, or its end is missing. The answer is orders in JSON, or an error.
TEST_F(BrowserSessionTest, AnswersDamagedMessages) {
  receive(welcome("e1"));
  const std::string valid = lease(10, 0).SerializeAsString();
  std::mt19937 random(1);
  for (int i = 0; i < 5000; ++i) {
    std::string damaged = valid.substr(0, random() % (valid.size() + 1));
    if (!damaged.empty()) {
      damaged[random() % damaged.size()] = static_cast<char>(random());
    }
    const BandsawAnswer* answer = bandsaw_session_receive(session_, damaged.data(), damaged.size());
    if (answer->failed == 0) {
      json_of(text_of(answer));
    }
    farm::ToWorker bye;
    bye.mutable_bye();
    receive(bye);
  }
}

}  // namespace
}  // namespace bandsaw::worker
