// A worker's side of its session with the coordinator, as a pure state machine: leases, heartbeats,
// reconnection, and draining (the worker finishes its bands and takes no more). An epoch, such as
// "e1", is one run of the coordinator.

#include "worker/session/session.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "proto/wire/limits.h"
#include "proto/wire/versions.h"
#include "tests/support/session_messages.h"
#include "worker/executor/backoff.h"

namespace bandsaw::worker {
namespace {

// lease(id, first_row) assigns two rows of a job to the worker, and revoke(id) cancels the lease.
using test::lease;
using test::revoke;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

WorkerInfo worker_info() {
  return {.instance = std::string(32, 'a'),
          .name = "desk",
          .build = "test",
          .threads = 4,
          .max_bands = 3,
          .pixel_version = 7,
          .canary = 99};
}

farm::ToWorker welcome(const std::string& epoch) {
  farm::ToWorker message;
  message.mutable_welcome()->set_name("desk-2");
  message.mutable_welcome()->set_heartbeat_ms(500);
  message.mutable_welcome()->set_epoch(epoch);
  return message;
}

TEST(LogMessage, HasCleanLinesOfBoundedLength) {
  const farm::FromWorker message =
      log_message({"a\tb\x1b[2J\n", std::string(wire::kLogLineBytes + 9, 'x')});
  EXPECT_THAT(message.log().line(), ElementsAre("a b [2J", std::string(wire::kLogLineBytes, 'x')));
}

TEST(Session, SendsItsIdentityInHello) {
  const farm::FromWorker message = Session(worker_info()).hello();
  const farm::Hello& hello = message.hello();
  EXPECT_EQ(hello.protocol(), wire::kProtocol);
  EXPECT_EQ(hello.pixel_version(), 7U);
  EXPECT_EQ(hello.canary(), 99U);
  EXPECT_EQ(hello.instance(), std::string(32, 'a'));
  EXPECT_EQ(hello.name(), "desk");
  EXPECT_EQ(hello.threads(), 4U);
  EXPECT_EQ(hello.max_bands(), 3U);
  EXPECT_EQ(hello.held_size(), 0);
}

TEST(Session, TakesItsNameAndHeartbeatFromTheWelcome) {
  Session session(worker_info());
  EXPECT_FALSE(session.connected());
  EXPECT_FALSE(session.was_welcomed());
  session.receive(welcome("e1"));
  EXPECT_TRUE(session.connected());
  EXPECT_EQ(session.name(), "desk-2");
  EXPECT_EQ(session.heartbeat_interval(), std::chrono::milliseconds(500));
  session.disconnected();
  EXPECT_FALSE(session.connected());
  EXPECT_TRUE(session.was_welcomed());
}

TEST(Session, StartsLeasesAndReportsTheirRows) {
  Session session(worker_info());
  session.receive(welcome("e1"));
  const SessionEffects first = session.receive(lease(10, 0));
  const SessionEffects second = session.receive(lease(11, 2));
  ASSERT_EQ(first.start.size(), 1U);
  ASSERT_EQ(second.start.size(), 1U);
  EXPECT_NE(first.start[0].id, second.start[0].id);
  EXPECT_EQ(second.start[0].band.rows, (RowRange{2, 4}));
  session.preparing(first.start[0].id, 1000);
  session.rendering(second.start[0].id, 2);
  session.rendering(second.start[0].id, 1);  // an older report that was overtaken
  const farm::FromWorker message = session.heartbeat();
  const farm::Heartbeat& beat = message.heartbeat();
  ASSERT_EQ(beat.lease_size(), 2);
  EXPECT_EQ(beat.lease(0).lease(), 10U);
  EXPECT_EQ(beat.lease(0).prepared(), 1000U);
  EXPECT_EQ(beat.lease(1).rows_done(), 2U);
  EXPECT_EQ(beat.doing(), "rendering");
}

// Before its first row, a band may need a preparation that takes longer than the progress timeout.
// Each of its steps counts as progress, so the lease is not revoked.
TEST(Session, StepsOfThePreparationBeforeTheFirstRowAreProgress) {
  Session session(worker_info());
  session.receive(welcome("e1"));
  const TaskId task = session.receive(lease(10, 0)).start.at(0).id;
  session.preparing(task, 1000);
  EXPECT_TRUE(session.rendering(task, 0));
  const std::uint64_t begun = session.heartbeat().heartbeat().lease(0).prepared();
  EXPECT_FALSE(session.rendering(task, 0));
  EXPECT_GT(session.heartbeat().heartbeat().lease(0).prepared(), begun);
  EXPECT_FALSE(session.rendering(task, 1));
  EXPECT_FALSE(session.rendering(task + 1, 0));  // not held
}

// In an adaptive job, the samples differ between half tiles. A half tile is half of the pixels of a
// tile of 16 x 16 pixels. A lease has two numbers for each half tile: the first sample and the
// number of samples.
TEST(Session, ATaskHasTheSamplesOfItsHalfTiles) {
  Session session(worker_info());
  session.receive(welcome("e1"));
  farm::ToWorker message = lease(10, 2);
  TileSamples tiles(/*width=*/8, /*rows=*/{2, 4});
  tiles.set(1, {64, 128});
  for (const std::uint32_t number : tiles.numbers()) {
    message.mutable_lease()->add_tile_samples(number);
  }
  const SessionEffects effects = session.receive(message);
  ASSERT_EQ(effects.start.size(), 1U);
  EXPECT_EQ(effects.start[0].tiles, tiles);
  EXPECT_TRUE(session.receive(lease(11, 4)).start[0].tiles.whole());
}

TEST(Session, RefusesAnInvalidLease) {
  Session session(worker_info());
  session.receive(welcome("e1"));
  farm::ToWorker bad = lease(10, 0);
  bad.mutable_lease()->mutable_band()->set_last_row(81);  // the image has 80 rows
  farm::ToWorker worse = lease(11, 0);
  worse.mutable_lease()->set_manifest_sha256("short");
  // The second half tile has the samples [16, 48). They are no node of the tree in which samples
  // are summed, because 32 samples must begin at a multiple of 32.
  farm::ToWorker no_node = lease(12, 0);
  for (const std::uint32_t number : {16u, 16u, 16u, 32u}) {
    no_node.mutable_lease()->add_tile_samples(number);
  }
  farm::ToWorker too_few = lease(13, 0);
  too_few.mutable_lease()->add_tile_samples(16);
  for (const farm::ToWorker& message : {bad, worse, no_node, too_few}) {
    const SessionEffects effects = session.receive(message);
    EXPECT_THAT(effects.start, IsEmpty());
    ASSERT_EQ(effects.send.size(), 1U);
    EXPECT_EQ(effects.send[0].failed().lease(), message.lease().lease());
    EXPECT_FALSE(effects.send[0].failed().reason().empty());
  }
}

TEST(Session, HoldsNoMoreThanTheLimit) {
  Session session(worker_info());
  session.receive(welcome("e1"));
  for (std::uint32_t i = 0; i < wire::kBandsPerWorker; ++i) {
    EXPECT_EQ(session.receive(lease(i, 2 * i)).start.size(), 1U);
  }
  const SessionEffects effects = session.receive(lease(100, 70));
  EXPECT_THAT(effects.start, IsEmpty());
  ASSERT_EQ(effects.send.size(), 1U);
  EXPECT_EQ(effects.send[0].failed().lease(), 100U);
}

TEST(Session, ListsHeldBandsAfterAReconnect) {
  Session session(worker_info());
  session.receive(welcome("e1"));
  const TaskId finished = session.receive(lease(10, 0)).start[0].id;
  session.receive(lease(11, 2));
  EXPECT_TRUE(session.finished(finished));
  session.disconnected();
  const farm::FromWorker message = session.hello();
  const farm::Hello& hello = message.hello();
  ASSERT_EQ(hello.held_size(), 2);
  EXPECT_EQ(hello.held(0).lease(), 10U);
  EXPECT_EQ(hello.held(0).epoch(), "e1");
  EXPECT_TRUE(hello.held(0).finished());
  EXPECT_FALSE(hello.held(1).finished());
  EXPECT_EQ(hello.held(1).band().first_row(), 2U);
  EXPECT_NE(hello.held(0).work(), 0U);
  EXPECT_EQ(hello.held(0).work(), hello.held(1).work()) << "both bands belong to one job";
}

// The coordinator was restarted with a new data folder. In the new folder, another job has the
// same id, and a band of the same rows. The worker must stop the old band and start the new one.
TEST(Session, ABandOfAnotherJobWithTheSameIdIsDifferent) {
  Session session(worker_info());
  session.receive(welcome("e1"));
  const TaskId old = session.receive(lease(10, 0)).start[0].id;
  session.disconnected();
  session.receive(welcome("e2"));
  farm::ToWorker again = lease(1, 0);
  again.mutable_lease()->mutable_settings()->set_seed(99);
  const SessionEffects effects = session.receive(again);
  EXPECT_THAT(effects.stop, ElementsAre(old));
  ASSERT_EQ(effects.start.size(), 1U);
  EXPECT_EQ(effects.start[0].settings.seed, 99U);
}

TEST(Session, KeepsAHeldBandUnderItsNewLease) {
  Session session(worker_info());
  session.receive(welcome("e1"));
  const TaskId task = session.receive(lease(10, 0)).start[0].id;
  session.disconnected();
  session.receive(welcome("e2"));
  EXPECT_EQ(session.heartbeat().heartbeat().lease_size(), 0) << "e2 has not leased the band yet";
  EXPECT_THAT(session.receive(lease(3, 0)).start, IsEmpty())
      << "the band must not be started again";
  EXPECT_EQ(session.lease_of(task)->lease, 3U);
  EXPECT_EQ(session.lease_of(task)->epoch, "e2");
  EXPECT_EQ(session.heartbeat().heartbeat().lease(0).lease(), 3U);
}

// Lease ids are unique only within an epoch. So the worker holds two leases with the id 10.
TEST(Session, ARevokeAppliesToThePresentEpochFirst) {
  Session session(worker_info());
  session.receive(welcome("e1"));
  const TaskId old = session.receive(lease(10, 0)).start[0].id;
  session.disconnected();
  session.receive(welcome("e2"));
  const TaskId young = session.receive(lease(10, 20)).start[0].id;
  EXPECT_THAT(session.receive(revoke(10)).stop, ElementsAre(young));
  EXPECT_THAT(session.receive(revoke(10)).stop, ElementsAre(old));
  EXPECT_THAT(session.receive(revoke(10)).stop, IsEmpty());
}

TEST(Session, DiscardsABandRevokedWhileItRendered) {
  Session session(worker_info());
  session.receive(welcome("e1"));
  const TaskId task = session.receive(lease(10, 0)).start[0].id;
  EXPECT_THAT(session.receive(revoke(10)).stop, ElementsAre(task));
  EXPECT_FALSE(session.finished(task));
  EXPECT_FALSE(session.failed(task, "why", {}).has_value());
}

TEST(Session, ReportsAFailureWithinTheLimitsOfTheMessage) {
  Session session(worker_info());
  session.receive(welcome("e1"));
  const TaskId task = session.receive(lease(10, 0)).start[0].id;
  const std::vector<std::string> log(200, std::string(1000, 'x') + "\n");
  const auto message = session.failed(task, "two\nlines" + std::string(5000, 'y'), log);
  ASSERT_TRUE(message.has_value());
  EXPECT_EQ(message->failed().lease(), 10U);
  EXPECT_EQ(message->failed().reason().size(), wire::kReasonBytes);
  EXPECT_THAT(message->failed().reason(), HasSubstr("two lines"));
  EXPECT_EQ(static_cast<std::size_t>(message->failed().log_size()), wire::kLogLines);
  EXPECT_EQ(message->failed().log(0).size(), wire::kLogLineBytes);
  EXPECT_EQ(session.hello().hello().held_size(), 0);
}

TEST(Session, ReportsAFailureByNotListingTheBandAfterAReconnect) {
  Session session(worker_info());
  session.receive(welcome("e1"));
  const TaskId task = session.receive(lease(10, 0)).start[0].id;
  session.disconnected();
  EXPECT_FALSE(session.failed(task, "why", {}).has_value());
  EXPECT_EQ(session.hello().hello().held_size(), 0);
}

TEST(Session, IsDrainedWhenAllBandsAreAcknowledged) {
  Session session(worker_info());
  session.receive(welcome("e1"));
  const TaskId task = session.receive(lease(10, 0)).start[0].id;
  const auto message = session.drain("SIGTERM");
  ASSERT_TRUE(message.has_value());
  EXPECT_EQ(message->draining().reason(), "SIGTERM");
  EXPECT_FALSE(session.drained());
  EXPECT_TRUE(session.finished(task));
  EXPECT_FALSE(session.drained()) << "its pixels are not acknowledged yet";
  session.settled(task);
  EXPECT_TRUE(session.drained());
}

TEST(Session, RepeatsDrainingOnALaterStream) {
  Session session(worker_info());
  session.receive(welcome("e1"));
  session.receive(lease(10, 0));
  session.disconnected();
  EXPECT_FALSE(session.drain("SIGTERM").has_value());
  const SessionEffects effects = session.receive(welcome("e2"));
  ASSERT_EQ(effects.send.size(), 1U);
  EXPECT_TRUE(effects.send[0].has_draining());
}

TEST(Session, KeepsBandsWhenRefusedAndDropsThemAtBye) {
  Session session(worker_info());
  session.receive(welcome("e1"));
  const TaskId task = session.receive(lease(10, 0)).start[0].id;
  farm::ToWorker refused;
  refused.mutable_refused()->set_reason("other pixels");
  refused.mutable_refused()->set_retry_after_ms(700);
  const SessionEffects first = session.receive(refused);
  EXPECT_THAT(first.stop, IsEmpty());
  ASSERT_TRUE(first.dismissal.has_value());
  EXPECT_EQ(first.dismissal->reason, "other pixels");
  EXPECT_EQ(first.dismissal->wait, std::chrono::milliseconds(700));
  EXPECT_FALSE(first.dismissal->for_ever);
  farm::ToWorker bye;
  bye.mutable_bye()->set_reason("go home");
  const SessionEffects second = session.receive(bye);
  EXPECT_THAT(second.stop, ElementsAre(task));
  EXPECT_TRUE(second.dismissal->for_ever);
}

// The waiting time before a retry, in milliseconds, is random between half of a cap and the cap.
// The cap doubles from 200 to 5000.
TEST(Backoff, StaysBetweenHalfOfItsGrowingCapAndTheCap) {
  Backoff backoff(1);
  std::int64_t cap = 200;
  for (int i = 0; i < 20; ++i) {
    const auto wait = backoff.next().count();
    EXPECT_GE(wait, cap / 2);
    EXPECT_LE(wait, cap);
    cap = std::min<std::int64_t>(cap * 2, 5000);
  }
  backoff.reset();
  EXPECT_LE(backoff.next().count(), 200);
}

}  // namespace
}  // namespace bandsaw::worker
