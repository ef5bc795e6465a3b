// Browsers that join the farm as workers by a link, and that may be malicious. The tests cover how
// browsers are shown, which jobs and bands they get, how their bands are audited (rendered again by
// another worker and compared), and what the holder of a link cannot do. A tab is a browser that
// has joined as a worker. A native worker is any worker that is no browser.

#include <cmath>
#include <map>

#include "absl/strings/str_cat.h"
#include "coordinator/scheduler/api/worker_process.h"
#include "farm_driver.h"
#include "proto/wire/limits.h"

namespace bandsaw::coordinator {
namespace {

/// Each band has one row. All bands of browsers are audited. Bands of native workers are not
/// audited.
SchedulerOptions browsers_audited() {
  SchedulerOptions options = slow();
  options.browser_audit_share = 1;
  return options;
}

struct BrowserFarm : FarmDriver {
  explicit BrowserFarm(SchedulerOptions options = browsers_audited())
      : FarmDriver(std::move(options)) {}

  WorkerView worker(const std::string& name) const {
    for (const WorkerView& one : scheduler.workers(now)) {
      if (one.name == name) {
        return one;
      }
    }
    return {};
  }

  /// Returns how many leases of audits, or of other bands, the session got.
  std::size_t leases(SessionId session, bool audit = false) const {
    const auto all_leases = all<action::Lease>();
    return static_cast<std::size_t>(
        std::count_if(all_leases.begin(), all_leases.end(), [&](const action::Lease& lease) {
          return lease.session == session && lease.audit == audit;
        }));
  }

  /// Returns the newest lease of a session.
  action::Lease lease(SessionId session) const {
    action::Lease found;
    for (const auto& lease : all<action::Lease>()) {
      found = lease.session == session ? lease : found;
    }
    EXPECT_NE(found.lease, 0u) << "session " << session;
    return found;
  }

  /// Sends the result of a lease. `lie`: added to the digest of its first row; 0: right pixels.
  /// `written`: false for a band whose rows are stored already, so that it is only compared.
  Step result(const action::Lease& lease, const std::string& instance, std::uint64_t lie = 0,
              bool written = true) {
    input::BandStored in;
    in.job = lease.job;
    in.band = lease.band;
    in.row_digests = honest_digests(lease.band);
    in.row_digests[0] += lie;
    in.instance = instance;
    in.render_s = 0.1;
    in.written = written && !lease.audit;
    return send(in);
  }

  std::string why(JobId id) const {
    std::string text;
    for (const std::string& line : scheduler.why(id, now)) {
      absl::StrAppend(&text, line, "\n");
    }
    return text;
  }
};

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

JobSpec one_row(const std::string& request = "r1") {
  return test_job(request, StopAtSamples{8}, 8, 1);
}

JobSpec of_size(std::uint64_t package_bytes) {
  JobSpec spec = one_row();
  spec.package_bytes = package_bytes;
  return spec;
}

TEST(Browser, IsShownAsABrowser) {
  BrowserFarm farm;
  farm.hello(1, "a");
  farm.hello_tab(2, "b");
  farm.hello_tab(3, "c");
  WorkerHello old = test_worker("d");
  old.browser = true;
  old.pixel_version = 1;
  farm.send(input::Hello{4, old});
  std::map<std::string, bool> browsers;
  for (const WorkerView& worker : farm.scheduler.workers(farm.now)) {
    browsers[worker.name] = worker.browser;
  }
  EXPECT_EQ(browsers, (std::map<std::string, bool>{{"tab@browser", true},
                                                   {"tab@browser-2", true},
                                                   {"worker-a", false},
                                                   {"worker-d@browser", true}}));
  EXPECT_EQ(farm.all<action::Welcome>()[2].name, "tab@browser-2");
}

TEST(Browser, CannotTakeTheNameOrTheInstanceOfANativeWorker) {
  BrowserFarm farm;
  farm.hello(1, "a");
  WorkerHello thief = test_worker("a");
  thief.browser = true;
  const auto refused = in<action::Refuse>(farm.send(input::Hello{2, thief}));
  ASSERT_EQ(refused.size(), 1u);
  EXPECT_TRUE(farm.all<action::Close>().empty()) << "the native worker stays";
  thief.instance = "b";
  farm.send(input::Hello{3, thief});
  EXPECT_FALSE(farm.worker("worker-a").browser);
  EXPECT_TRUE(farm.worker("worker-a@browser").browser);
  farm.send(input::Quarantine{"worker-a@browser"});
  EXPECT_EQ(farm.worker("worker-a").state, "idle");
}

// ---- memory ----

// A scene needs about four times the bytes of its package.
TEST(Browser, GetsOnlyScenesThatFitIntoItsMemory) {
  for (const std::uint64_t memory : {399'999'999, 400'000'000}) {
    BrowserFarm farm;
    const JobId job = farm.submit(of_size(100'000'000));
    farm.hello_tab(1, "a", memory);
    EXPECT_EQ(farm.leases(1), memory == 400'000'000 ? 1u : 0u);
    if (memory < 400'000'000) {
      EXPECT_TRUE(contains(farm.why(job),
                           "tab@browser gets no bands of it: its scene needs about "
                           "400 MB of memory, it has 400 MB"))
          << farm.why(job);
      EXPECT_TRUE(contains(farm.why(job), "start a native worker")) << farm.why(job);
      EXPECT_TRUE(contains(farm.worker("tab@browser").reason, "gets no bands of job 1"));
      farm.pass_time(60, {1});
      EXPECT_EQ(farm.job(job).state, JobState::kRunning) << "it waits for another worker";
      farm.hello(2, "b", 1);
      EXPECT_EQ(farm.leases(2), 1u);
    }
  }
}

TEST(Browser, GetsNoSceneOfUnknownSizeIfItsMemoryIsLimited) {
  BrowserFarm farm;
  farm.submit(of_size(0));
  farm.hello_tab(1, "a", 1'000'000'000'000);
  EXPECT_EQ(farm.leases(1), 0u);
  farm.hello_tab(2, "b");
  EXPECT_EQ(farm.leases(2), 1u);
}

TEST(Browser, TakesALaterJobThatFits) {
  BrowserFarm farm;
  farm.submit(of_size(1'000'000'000));
  JobSpec small = one_row("r2");
  small.package_bytes = 1'000;
  const JobId job = farm.submit(small);
  farm.hello_tab(1, "a", 1'000'000);
  EXPECT_EQ(farm.lease(1).job, job);
}

TEST(Browser, GetsOnlyFramesThatFit) {
  BrowserFarm farm;
  SequenceSpec spec;
  spec.request_id = "sequence";
  spec.settings.width = spec.settings.height = 8;
  spec.stop = StopAtSamples{8};
  spec.frames = {1, 2};
  const JobId sequence = farm.send(input::SubmitSequence{spec}).job;
  farm.send(input::AddFrames{
      sequence, {{1, std::string(64, 'a'), 1'000'000}, {2, std::string(64, 'b'), 10}}});
  farm.hello_tab(1, "a", 1'000);
  EXPECT_EQ(farm.lease(1).manifest, std::string(64, 'b'));
  BrowserFarm again;
  for (const Record& record : farm.scheduler.snapshot()) {
    again.scheduler.replay(record);
  }
  again.take(again.scheduler.replayed(again.now));
  again.pass_time(10);
  again.hello_tab(1, "a", 1'000);
  EXPECT_EQ(again.lease(1).manifest, std::string(64, 'b')) << "the sizes are journalled";
}

TEST(Browser, TheSameRequestWithAPackageSizeIsTheSameJob) {
  BrowserFarm farm;
  const JobId job = farm.submit(of_size(0));
  const Step again = farm.send(input::Submit{of_size(5)});
  EXPECT_TRUE(again.status.ok()) << "an earlier version journalled the job without a size";
  EXPECT_EQ(again.job, job);
}

// ---- the option --browsers ----

TEST(Browser, IsRefusedIfNoneAreWanted) {
  SchedulerOptions options = browsers_audited();
  options.browsers = Browsers::kNone;
  BrowserFarm farm(options);
  const auto refused = in<action::Refuse>(farm.hello_tab(1, "a"));
  ASSERT_EQ(refused.size(), 1u);
  EXPECT_TRUE(contains(refused[0].reason, "--browsers none")) << refused[0].reason;
  EXPECT_EQ(farm.worker("tab@browser").state, "refused");
}

TEST(Browser, NativeWorkersOnlyCompareIfOnlyBrowsersAreWanted) {
  SchedulerOptions options = browsers_audited();
  options.browsers = Browsers::kOnly;
  BrowserFarm farm(options);
  const JobId job = farm.submit(one_row());
  farm.hello(1, "a");
  farm.pass_time(60, {1});
  EXPECT_EQ(farm.leases(1), 0u);
  EXPECT_EQ(farm.job(job).state, JobState::kRunning);
  EXPECT_TRUE(contains(farm.why(job), "no browser is connected")) << farm.why(job);
  EXPECT_TRUE(contains(farm.worker("worker-a").reason, "this worker only checks their results"));
  farm.hello_tab(2, "b");
  farm.result(farm.lease(2), "b");
  EXPECT_EQ(farm.leases(1, true), 1u);
  farm.result(farm.lease(1), "a");
  EXPECT_EQ(farm.job(job).state, JobState::kFinishing);
}

TEST(Browser, LeavesPlacesToNativeWorkers) {
  Scheduler farm(test_options());
  SessionId session = 0;
  std::size_t refused = 0;
  for (std::size_t i = 0; i <= wire::kWorkers / 2; ++i) {
    WorkerHello tab = test_worker(absl::StrCat(i));
    tab.browser = true;
    refused += in<action::Refuse>(farm.step(input::Hello{++session, tab}, 0)).size();
  }
  EXPECT_EQ(refused, 1u);
  EXPECT_EQ(in<action::Welcome>(farm.step(input::Hello{++session, test_worker("n")}, 0)).size(),
            1u);
}

// ---- audits ----

TEST(Browser, NativeWorkersAuditItsBandsAtASeparateRate) {
  BrowserFarm farm;
  farm.submit(one_row());
  farm.hello_tab(1, "t");
  farm.hello(2, "a", 1);
  farm.hello_tab(3, "u");
  farm.result(farm.lease(1), "t");
  EXPECT_EQ(farm.leases(2, true), 1u);
  EXPECT_EQ(farm.leases(3, true), 0u);
  EXPECT_EQ(farm.job(1).state, JobState::kRunning);
  farm.result(farm.lease(2), "a");
  EXPECT_EQ(farm.job(1).state, JobState::kFinishing);
  // A band of a native worker is not audited.
  farm.submit(one_row("r2"));
  const action::Lease native = farm.all<action::Lease>().back();
  farm.result(native, "a");
  EXPECT_EQ(farm.job(2).state, JobState::kFinishing);
}

/// A job of one row. The tab t has returned wrong pixels of the row. The native worker a has
/// audited the row, that is, rendered it again, and has returned right pixels.
BrowserFarm lie_found() {
  BrowserFarm farm;
  farm.submit(one_row());
  farm.hello_tab(1, "t");
  farm.hello(2, "a", 1);
  farm.result(farm.lease(1), "t", 7);
  farm.result(farm.lease(2), "a");
  return farm;
}

TEST(Browser, ABrowserThatLiesIsFoundByASingleNativeWorker) {
  BrowserFarm farm = lie_found();
  EXPECT_EQ(farm.leases(2, true), 2u)
      << "the native worker may be wrong itself, so it renders again";
  const Step step = farm.result(farm.lease(2), "a");
  EXPECT_EQ(farm.worker("tab@browser").state, "quarantined");
  ASSERT_EQ(in<action::Retract>(step).size(), 1u);
  EXPECT_EQ(in<action::Retract>(step)[0].process, worker_process_id("t"));
  EXPECT_TRUE(contains(farm.worker("tab@browser").reason, "take the link back"))
      << farm.worker("tab@browser").reason;
  farm.result(farm.lease(2), "a");
  EXPECT_EQ(farm.job(1).state, JobState::kFinishing);
  // Only the process is refused. Another tab with its name is admitted, because anybody may have
  // chosen this name.
  EXPECT_EQ(in<action::Refuse>(farm.hello_tab(3, "t")).size(), 1u);
  EXPECT_EQ(in<action::Welcome>(farm.hello_tab(4, "v")).size(), 1u);
  EXPECT_TRUE(farm.send(input::LiftQuarantine{"tab@browser"}).status.ok());
}

TEST(Browser, ANativeWorkerThatContradictsItselfDoesNotAccuseABrowser) {
  BrowserFarm farm = lie_found();
  farm.result(farm.lease(2), "a", 9);
  EXPECT_EQ(farm.worker("worker-a").state, "quarantined");
  EXPECT_NE(farm.worker("tab@browser").state, "quarantined");
}

TEST(Browser, AnyNumberOfBrowsersDoNotOutvoteANativeWorker) {
  BrowserFarm farm = lie_found();
  for (int i = 0; i < 5; ++i) {
    farm.hello_tab(static_cast<SessionId>(10 + i), absl::StrCat("u", i));
    farm.result(farm.lease(1), absl::StrCat("u", i), 7, false);
  }
  EXPECT_TRUE(farm.all_records<record::WorkerQuarantined>().empty());
  EXPECT_TRUE(farm.all_records<record::BandAudited>().empty());
  farm.result(farm.lease(2), "a");
  EXPECT_EQ(farm.all_records<record::WorkerQuarantined>().size(), 6u)
      << "all except the native worker";
  EXPECT_EQ(farm.worker("worker-a").state, "rendering");
}

TEST(Browser, ASecondBrowserDoesNotConfirmALie) {
  BrowserFarm farm;
  farm.submit(one_row());
  farm.hello(1, "a", 1);
  farm.hello_tab(2, "t");
  farm.hello_tab(3, "u");
  const action::Lease native = farm.lease(1);
  farm.result(native, "t", 7);
  farm.result(native, "u", 7, false);
  EXPECT_TRUE(farm.all_records<record::BandAudited>().empty());
  EXPECT_EQ(farm.job(1).state, JobState::kRunning);
}

TEST(Browser, DoesNotHoldUpPixelsOfANativeWorkerThatHasLeft) {
  BrowserFarm farm;
  farm.submit(test_job("r1", StopAtSamples{8}, 8, 2));
  farm.hello(1, "a", 1);
  farm.hello_tab(2, "t");
  const action::Lease native = farm.lease(1);
  farm.result(native, "a");
  farm.send(input::SessionEnded{1, "switched off"});
  farm.result(native, "t", 7, false);
  farm.render_all(2, "t");
  EXPECT_EQ(farm.job(1).state, JobState::kFinishing) << farm.why(1);
  EXPECT_TRUE(farm.all_records<record::WorkerQuarantined>().empty());
}

TEST(Browser, AuditsAnotherBrowserOnlyIfNoNativeWorkerIsThere) {
  BrowserFarm farm;
  farm.hello(1, "a", 1);
  farm.pass_time(1, {1});
  farm.send(input::SessionEnded{1, "restarts"});
  farm.hello_tab(2, "t");
  farm.hello_tab(3, "u");
  farm.submit(test_job("r1", StopAtSamples{8}, 8, 40));
  farm.result(farm.lease(2), "t");
  EXPECT_EQ(farm.leases(3, true), 0u) << "a native worker may be back soon";
  farm.pass_time(61, {2, 3});  // native workers are waited for 60 s
  farm.result(farm.lease(2), "t");
  farm.result(farm.lease(3), "u");
  EXPECT_GT(farm.leases(2, true) + farm.leases(3, true), 0u);
}

TEST(Browser, AThirdBrowserDecidesIfTwoDisagreeWithoutANativeWorker) {
  BrowserFarm farm;
  farm.pass_time(61);  // no native worker is waited for any more
  farm.submit(one_row());
  farm.hello_tab(1, "t");
  farm.hello_tab(2, "u");
  farm.hello_tab(3, "v");
  farm.result(farm.lease(1), "t", 7);
  const SessionId second = farm.all<action::Lease>().back().session;
  farm.result(farm.lease(second), second == 2 ? "u" : "v");
  farm.result(farm.lease(5 - second), second == 2 ? "v" : "u");
  ASSERT_EQ(farm.all_records<record::WorkerQuarantined>().size(), 1u);
  EXPECT_EQ(farm.all_records<record::WorkerQuarantined>()[0].process, worker_process_id("t"));
}

// The rows that a browser stored are on disk. The coordinator must still know after a restart that
// a browser rendered them.
TEST(Browser, ItsStoredBandsAreStillAuditedAfterARestart) {
  for (const bool compacted : {false, true}) {
    BrowserFarm farm;
    farm.submit(one_row());
    farm.hello_tab(1, "t");
    farm.hello(2, "a", 1);
    const action::Lease lease = farm.lease(1);
    farm.result(lease, "t", 7);
    farm.send(input::SessionEnded{1, "closed"});
    BrowserFarm next;
    for (const Record& record : compacted ? farm.scheduler.snapshot() : farm.records) {
      next.scheduler.replay(record);
    }
    input::BandStored old;
    old.job = 1;
    old.band = lease.band;
    old.row_digests = {honest_digest(lease.band.samples, 0) + 7};
    old.process = worker_process_id("t");
    next.scheduler.replay(old);
    next.take(next.scheduler.replayed(next.now));
    next.hello(2, "a", 1);
    ASSERT_EQ(next.leases(2, true), 1u) << compacted;
    next.result(next.lease(2), "a");
    next.result(next.lease(2), "a");
    EXPECT_EQ(next.all<action::Retract>().size(), 1u);
    EXPECT_TRUE(next.scheduler.is_browser("t"));
  }
}

TEST(Browser, IsForgottenWhenNoJobHasBandsOfIt) {
  BrowserFarm farm;
  const JobId job = farm.submit(one_row());
  farm.hello_tab(1, "t");
  farm.hello_tab(2, "u");
  farm.send(input::SessionEnded{1, "closed"});
  EXPECT_TRUE(farm.scheduler.is_browser("t"));
  farm.send(input::Cancel{job});
  EXPECT_FALSE(farm.scheduler.is_browser("t"));
  EXPECT_TRUE(farm.scheduler.is_browser("u")) << "it is connected";
}

// A tab that lies in k bands is found with probability 1 − (1 − p)^k, whatever else happens,
// because each band is selected with probability p by an independent hash that the tab cannot know.
TEST(Browser, BrowsersThatLieAreFoundWithTheExpectedProbability) {
  constexpr double kShare = 0.1;
  constexpr int kTabs = 400;
  SchedulerOptions options = slow();
  options.browsers = Browsers::kOnly;
  options.browser_audit_share = kShare;
  double expected = 0;
  double variance = 0;
  int found = 0;
  for (int i = 0; i < kTabs; ++i) {
    BrowserFarm farm(options);
    const JobSpec spec = test_job(absl::StrCat("request ", i), StopAtSamples{8}, 8, 6);
    farm.submit(spec);
    farm.hello(1, "a", 1);
    farm.hello(2, "b", 1);
    farm.hello_tab(3, "liar");
    int lies = 0;
    bool selected = false;
    for (std::size_t at = 0; at < farm.actions.size(); ++at) {
      const auto* lease = std::get_if<action::Lease>(&farm.actions[at]);
      if (lease != nullptr && lease->session == 3) {
        ++lies;
        selected = selected || is_audited(spec, lease->band, kShare);
        farm.result(action::Lease(*lease), "liar", 7);
      }
    }
    for (std::size_t at = 0; at < farm.actions.size(); ++at) {
      const auto* lease = std::get_if<action::Lease>(&farm.actions[at]);
      if (lease != nullptr && lease->session < 3) {
        farm.result(action::Lease(*lease), lease->session == 1 ? "a" : "b");
      }
    }
    const bool is_found = farm.worker("tab@browser").state == "quarantined";
    EXPECT_EQ(is_found, selected);
    EXPECT_EQ(farm.all<action::Retract>().size(), is_found ? 1u : 0u);
    found += is_found ? 1 : 0;
    const double probability = 1 - std::pow(1 - kShare, lies);
    expected += probability;
    variance += probability * (1 - probability);
  }
  EXPECT_GT(expected, 0.2 * kTabs);  // otherwise the next comparison would prove little
  EXPECT_NEAR(found, expected, 4 * std::sqrt(variance));
}

// At most kMaxAudits audits of a job can be open. When half as many are open, browsers get no
// bands. They get one again when a native worker has done one of the audits. Checking the
// invariants after each of thousands of steps would be slow, so this test uses no FarmDriver.
TEST(Browser, GetsNoBandsThatWouldNotBeAudited) {
  SchedulerOptions options = browsers_audited();
  options.browsers = Browsers::kOnly;
  Scheduler farm(options);
  farm.step(input::Submit{test_job("r1", StopAtSamples{8}, 8, 4'000)}, 0);
  farm.step(input::Hello{1, test_worker("a", 1)}, 0);
  WorkerHello tab = test_worker("t", 1);
  tab.browser = true;
  std::vector<action::Lease> leases = in<action::Lease>(farm.step(input::Hello{2, tab}, 0));
  action::Lease audit;
  std::size_t stored = 0;
  while (!leases.empty()) {
    input::BandStored band;
    band.job = 1;
    band.band = leases.front().band;
    band.row_digests = honest_digests(band.band);
    band.instance = "t";
    band.render_s = 0.1;
    ++stored;
    leases.clear();
    for (const action::Lease& lease : in<action::Lease>(farm.step(band, 0))) {
      if (lease.session == 2) {
        leases.push_back(lease);
      } else {
        audit = lease;
      }
    }
  }
  EXPECT_EQ(stored, Job::kMaxAudits / 2);
  EXPECT_TRUE(contains(farm.why(1, 0).back(), "native workers must first compare"));
  input::BandStored compared;
  compared.job = 1;
  compared.band = audit.band;
  compared.row_digests = honest_digests(audit.band);
  compared.instance = "a";
  compared.written = false;
  const auto next = in<action::Lease>(farm.step(compared, 0));
  EXPECT_EQ(std::count_if(next.begin(), next.end(), [](const auto& l) { return l.session == 2; }),
            1);
}

// ---- what a holder of the link cannot do ----

TEST(Browser, FailuresOfAnyNumberOfBrowsersDoNotFailAJob) {
  BrowserFarm farm;
  const JobId job = farm.submit(one_row());
  for (SessionId session = 1; session <= 30; ++session) {
    farm.hello_tab(session, absl::StrCat("t", session));
    for (int i = 0; i < 3; ++i) {
      farm.send(input::BandFailed{session, farm.lease(session).lease, "no", {}});
    }
  }
  farm.pass_time(5, {30});
  for (int i = 0; i < 60; ++i) {
    farm.pass_time(1, {30});
  }
  EXPECT_EQ(farm.job(job).state, JobState::kRunning);
  EXPECT_TRUE(contains(farm.why(job), "no connected worker can render it")) << farm.why(job);
  farm.hello(100, "a", 1);
  farm.result(farm.lease(100), "a");
  EXPECT_EQ(farm.job(job).state, JobState::kFinishing);
}

// A band at which many native workers are lost fails the job. A browser may be closed at any time,
// so the loss of a browser does not count.
TEST(Browser, DisconnectionsOfAnyNumberOfBrowsersDoNotFailAJob) {
  BrowserFarm farm;
  const JobId job = farm.submit(one_row());
  for (SessionId session = 1; session <= 60; ++session) {
    farm.hello_tab(session, absl::StrCat("t", session));
    EXPECT_EQ(farm.leases(session), 1u);
    farm.send(input::SessionEnded{session, "closed"});
  }
  EXPECT_EQ(farm.job(job).state, JobState::kRunning);
  farm.hello(100, "a", 1);
  farm.result(farm.lease(100), "a");
  EXPECT_EQ(farm.job(job).state, JobState::kFinishing);
}

/// Opens tabs and quarantines each of them, until one is refused or there are 2,000. The sessions
/// are numbered from `first` on, and the instances begin with `prefix`. Returns the number of tabs
/// that were admitted.
int flood(BrowserFarm& farm, SessionId first, const std::string& prefix) {
  for (int i = 0; i < 2'000; ++i) {
    const auto welcomed = in<action::Welcome>(
        farm.hello_tab(first + static_cast<SessionId>(i), absl::StrCat(prefix, i)));
    if (welcomed.empty()) {
      return i;
    }
    farm.send(input::Quarantine{welcomed[0].name});
  }
  return 2'000;
}

TEST(Browser, BrowsersThatLieDisplaceNobodyFromTheQuarantine) {
  // Returns an instance whose process has a very low id. The native worker and the tab get such
  // instances, because a full list would lose the lowest ids first.
  const auto lowest = [](const std::string& prefix) {
    std::string found = prefix + "0";
    for (int i = 1; i < 20'000; ++i) {
      const std::string next = absl::StrCat(prefix, i);
      found = worker_process_id(next) < worker_process_id(found) ? next : found;
    }
    return found;
  };
  const std::string native = lowest("n");
  const std::string tab = lowest("t");
  BrowserFarm farm;
  farm.submit(one_row());
  farm.hello(1, native, 1);
  farm.send(input::Quarantine{"worker-" + native});
  farm.hello_tab(2, tab);
  const action::Lease lease = farm.lease(2);
  farm.result(lease, tab, 7);
  farm.send(input::Quarantine{"tab@browser"});

  EXPECT_LT(flood(farm, 10, "u"), 300);  // the list of quarantined browsers has 256 places
  EXPECT_EQ(in<action::Refuse>(farm.hello(6, native, 1)).size(), 1u);
  // A restart does not take the tab's pixels from the disk again.
  BrowserFarm next;
  for (const Record& record : farm.scheduler.snapshot()) {
    next.scheduler.replay(record);
  }
  input::BandStored old;
  old.job = 1;
  old.band = lease.band;
  old.row_digests = {honest_digest(lease.band.samples, 0) + 7};
  old.process = worker_process_id(tab);
  next.scheduler.replay(old);
  EXPECT_EQ(next.scheduler.wanted(1, lease.band), std::vector<RowRange>{lease.band.rows});
  next.take(next.scheduler.replayed(next.now));
  EXPECT_EQ(in<action::Refuse>(next.hello(7, native, 1)).size(), 1u);
  const auto refused = in<action::Refuse>(next.hello_tab(8, "w"));
  ASSERT_EQ(refused.size(), 1u);
  EXPECT_TRUE(contains(refused[0].reason, "take the link back")) << refused[0].reason;
}

TEST(Browser, IsAdmittedAgainOnceNoJobHasBandsOfTheQuarantinedBrowsers) {
  BrowserFarm farm;
  const JobId job = farm.submit(one_row());
  flood(farm, 10, "u");
  EXPECT_EQ(in<action::Refuse>(farm.hello_tab(5, "w")).size(), 1u);
  farm.send(input::Cancel{job});
  EXPECT_EQ(in<action::Welcome>(farm.hello_tab(6, "w")).size(), 1u);
  farm.submit(one_row("r2"));
  EXPECT_EQ(farm.leases(6), 1u);
}

TEST(Browser, CannotPredictWhichBandsOfAFrameAreAudited) {
  BrowserFarm farm;
  SequenceSpec spec;
  spec.request_id = "known to its submitter only";
  spec.settings.width = spec.settings.height = 8;
  spec.stop = StopAtSamples{8};
  spec.frames = {1};
  const JobId sequence = farm.send(input::SubmitSequence{spec}).job;
  farm.send(input::AddFrames{sequence, {{1, std::string(64, 'a')}}});
  const auto added = farm.all_records<record::JobAdded>();
  ASSERT_EQ(added.size(), 1u);
  EXPECT_TRUE(contains(added[0].spec.request_id, spec.request_id))
      << "the choice of bands is a hash of this id";
}

}  // namespace
}  // namespace bandsaw::coordinator
