// Tests the parsing of the command line: options, defaults, help, and the error for each wrong use.
// A stop rule is one of the options --samples, --error and --time, which tell when a render ends.

#include "coordinator/cli/command_line.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "absl/strings/str_split.h"
#include "renderlib/render/kernel.h"

namespace bandsaw::coordinator {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

absl::StatusOr<Command> parse(const std::string& line) {
  return parse_command_line(absl::StrSplit(line, ' ', absl::SkipEmpty()));
}

/// Returns the options that the command line gives. Expects that the line is valid and that its
/// options have the type T.
template <class T>
T parsed(const std::string& line) {
  const auto command = parse(line);
  EXPECT_TRUE(command.ok()) << line << ": " << command.status();
  EXPECT_TRUE(command.ok() && std::holds_alternative<T>(*command)) << line;
  return command.ok() && std::holds_alternative<T>(*command) ? std::get<T>(*command) : T();
}

/// Expects that the command line is refused. The error must be a single line of text that contains
/// `says`.
void expect_wrong(const std::string& line, const std::string& says) {
  const auto command = parse(line);
  ASSERT_FALSE(command.ok()) << line;
  EXPECT_EQ(command.status().code(), absl::StatusCode::kInvalidArgument) << line;
  EXPECT_THAT(std::string(command.status().message()), HasSubstr(says)) << line;
  EXPECT_EQ(command.status().message().find('\n'), absl::string_view::npos) << line;
}

TEST(CommandLine, SubmitTakesItsOptions) {
  const auto options = parsed<SubmitOptions>(
      "submit cornell.textproto -o a.png -o b.pfm --error 1% --seed 7 --width 320 --depth 5 --farm "
      "/x/farm --quiet");
  EXPECT_EQ(options.scene, "cornell.textproto");
  EXPECT_THAT(options.outputs, ElementsAre("a.png", "b.pfm"));
  EXPECT_EQ(std::get<StopAtError>(options.image.stop).relative_rmse, 0.01);
  EXPECT_EQ(options.image.seed, 7u);
  EXPECT_EQ(options.image.width, 320u);
  EXPECT_EQ(options.image.height, std::nullopt);
  EXPECT_EQ(options.image.depth, 5u);
  EXPECT_EQ(options.farm.farm, "/x/farm");
  EXPECT_TRUE(options.verbosity.quiet);
  EXPECT_FALSE(options.detach);
}

TEST(CommandLine, EnvironmentAndCameraOverrideTheScene) {
  const SceneChoices chosen =
      parsed<SubmitOptions>("submit a.glb --camera plan --environment e.hdr").image.choices;
  EXPECT_EQ(chosen.camera, "plan");
  EXPECT_EQ(chosen.environment, "e.hdr");
  EXPECT_EQ(parsed<RenderOptions>("render a.glb --camera plan").image.choices.camera, "plan");
  EXPECT_EQ(parsed<RenderOptions>("render a.glb").image.choices.camera, "");
}

TEST(CommandLine, AFrameNumberSetsTheTimeAndTheFileNames) {
  const auto options = parsed<RenderOptions>(
      "render a.glb --frame 7 --fps 30 --shutter 0.5 --animation walk -o out/w.####.exr -o w#.png "
      "-o w.pfm");
  EXPECT_EQ(options.image.choices.frame, 7);
  EXPECT_EQ(options.image.choices.fps, 30);
  EXPECT_EQ(options.image.choices.shutter, 0.5);
  EXPECT_EQ(options.image.choices.animation, "walk");
  EXPECT_THAT(options.outputs, ElementsAre("out/w.0007.exr", "w7.png", "w.pfm"));
  EXPECT_THAT(parsed<SubmitOptions>("submit a.glb --frame -12 -o w.###.png").outputs,
              ElementsAre("w.-012.png"));
  EXPECT_THAT(parsed<SubmitOptions>("submit a.glb --frame 12345 -o #.png").outputs,
              ElementsAre("12345.png"));
  EXPECT_EQ(parsed<RenderOptions>("render a.glb --frame 7 --report r.##.json").report.file,
            "r.07.json");
  EXPECT_EQ(parsed<SubmitOptions>("submit a.glb --frame 7 --report #.json").report.file, "7.json");
  EXPECT_EQ(parsed<SubmitOptions>("submit a.glb --frames 1-2 --report #.json").report.file,
            "#.json");
  expect_wrong("render a.glb --frame 1.5", "--frame: must be a whole number");
  expect_wrong("render a.glb --frame 2000000000", "in [-1000000000, 1000000000], is '2000000000'");
  expect_wrong("render a.glb --frame -9223372036854775808", "in [-1000000000, 1000000000]");
  expect_wrong("render a.glb --fps 25", "--fps needs --frame");
  expect_wrong("render a.glb --frame 1 --shutter 2", "--shutter: must be a number in [0, 1]");
}

TEST(CommandLine, FramesAreOneJob) {
  const auto options = parsed<SubmitOptions>(
      "submit a.glb --frames 1:9:4,3-4 --fps 30 -o w.####.exr --fixed-seed --video w.mp4 "
      "--contact-sheet s.png --then ./send.sh");
  EXPECT_THAT(options.frames, ElementsAre(1, 3, 4, 5, 9));
  EXPECT_THAT(options.outputs, ElementsAre("w.####.exr"));
  EXPECT_TRUE(options.image.fixed_seed);
  EXPECT_EQ(options.image.choices.fps, 30);
  EXPECT_EQ(options.after.video, "w.mp4");
  EXPECT_EQ(options.after.video_fps, 30);
  EXPECT_EQ(options.after.contact_sheet, "s.png");
  EXPECT_EQ(options.after.command, "./send.sh");
  EXPECT_EQ(parsed<SubmitOptions>("submit a.glb --frames 1-3 --continue 7").continued, 7u);
  EXPECT_THAT(parsed<SubmitOptions>("submit a.glb --frames -3:-2").frames, ElementsAre(-3, -2));
  EXPECT_EQ(parsed<WatchOptions>("watch 7 --video w.webm --fps 12.5").after.video_fps, 12.5);
  EXPECT_EQ(parsed<MissingOptions>("missing 7").job, 7u);
  EXPECT_THAT(parsed<RetryOptions>("retry 7 --frames 12,14").frames, ElementsAre(12, 14));
  EXPECT_THAT(parsed<RetryOptions>("retry 7").frames, testing::IsEmpty());
  expect_wrong("submit a.glb --frames 1-9 -o w.exr", "put #### where its number");
  expect_wrong("submit a.glb --frames 9-1", "--frames: '9-1' runs backwards");
  expect_wrong("submit a.glb --frames 1-9 --frame 2", "exclude each other");
  expect_wrong("submit a.glb --video w.mp4", "add --frames");
  expect_wrong("submit a.glb --frames 1-9 --video w.avi", "--video: must end in .mp4");
  expect_wrong("submit a.glb --frames 1-9 --detach --then x", "--detach does not wait");
  expect_wrong("submit a.glb --continue 7", "--continue needs --frames");
  EXPECT_EQ(parsed<SubmitOptions>("submit a.glb --frames 1-9 --denoise -o w.#.exr").denoise,
            Denoiser::kRegression);
  expect_wrong("submit a.glb --frames 1-9 --layers depth -o w.#.exr",
               "--layers, --tev and --preview are for a single image: omit --frames");
  expect_wrong("render a.glb --frames 1-9 --denoise", "'--frames'; did you mean --frame?");
  expect_wrong("render a.glb --fixed-seed", "--fixed-seed needs --frame");
}

TEST(CommandLine, AdaptiveSamplingNeedsAnErrorRule) {
  const auto adaptive = [](const StopRule& stop) { return std::get<StopAtError>(stop).adaptive; };
  EXPECT_TRUE(adaptive(parsed<RenderOptions>("render a.glb --error 1% --adaptive").image.stop));
  EXPECT_TRUE(adaptive(parsed<SubmitOptions>("submit a.glb --error 1% --adaptive").image.stop));
  EXPECT_FALSE(adaptive(parsed<RenderOptions>("render a.glb --error 1%").image.stop));
  expect_wrong("render a.glb --samples 64 --adaptive", "--adaptive needs --error");
  expect_wrong("submit a.glb --time 5s --adaptive", "--adaptive needs --error");
}

TEST(CommandLine, TakesIntegratorAndDisplayOptions) {
  const auto options = parsed<RenderOptions>(
      "render a.textproto --integrator ambient_occlusion --exposure -1.5 --tone filmic --half "
      "-o a.exr -o a.hdr");
  EXPECT_EQ(options.image.integrator, Integrator::kAmbientOcclusion);
  EXPECT_EQ(options.display.over({}),
            (Display{.exposure = -1.5, .tone = Tone::kFilmic, .half = true}));
  const Display scene{.exposure = 2, .tone = Tone::kFilmic};
  EXPECT_EQ(parsed<SubmitOptions>("submit a.textproto --exposure 3").display.over(scene),
            (Display{.exposure = 3, .tone = Tone::kFilmic}));
  EXPECT_EQ(parsed<WatchOptions>("watch 3 -o a.png --tone none").display.tone, Tone::kNone);
  expect_wrong("render a.textproto --integrator paths", "ambient_occlusion");
  expect_wrong("render a.textproto --exposure bright", "--exposure");
  expect_wrong("render a.textproto --exposure nan", "--exposure");
  expect_wrong("stitch a.band -o a.png --tone aces", "--tone");
}

TEST(CommandLine, TheReportIsAFileOrNone) {
  EXPECT_EQ(parsed<RenderOptions>("render a.glb").report.file, "");
  EXPECT_EQ(parsed<SubmitOptions>("submit a.glb --report r.json").report.file, "r.json");
  EXPECT_EQ(parsed<WatchOptions>("watch 7 -o a.png --report none").report.file, "none");
  expect_wrong("render a.glb --report r.txt", ".json");
  expect_wrong("watch 7 --report r.json", "-o");
  expect_wrong("submit a.glb --detach --report r.json", "-o");
}

TEST(CommandLine, StudyTakesScenesAndFiles) {
  const auto options = parsed<StudyOptions>("study a.glb b.textproto --samples 256 --seeds 2");
  EXPECT_THAT(options.scenes, ElementsAre("a.glb", "b.textproto"));
  EXPECT_THAT(options.outputs, ElementsAre("study.csv", "study.svg"));
  EXPECT_EQ(options.samples, 256u);
  EXPECT_EQ(options.reference, 4096u);
  EXPECT_THAT(parsed<StudyOptions>("study a.glb -o x.svg").outputs, ElementsAre("x.svg"));
  expect_wrong("study", "missing");
  expect_wrong("study a.glb -o x.png", ".svg");
  expect_wrong("study a.glb --samples 2", "--samples");
  expect_wrong("study a.glb --samples 64 --reference 65", "--reference");
}

TEST(CommandLine, AnImageCanBeDisplayedWhileItIsRendered) {
  const auto options = parsed<SubmitOptions>("submit a.glb --preview --tev 127.0.0.1:14158");
  EXPECT_TRUE(options.verbosity.preview);
  EXPECT_EQ(options.tev, "127.0.0.1:14158");
  EXPECT_TRUE(parsed<WatchOptions>("watch 7 --preview").verbosity.preview);
  EXPECT_EQ(parsed<RenderOptions>("render a.glb --tev host:1").tev, "host:1");
  expect_wrong("submit a.glb --preview --json", "--preview");
  expect_wrong("submit a.glb --preview --detach", "--preview");
  expect_wrong("submit a.glb --tev h", "as in 127.0.0.1:14158");
  expect_wrong("submit a.glb --tev h:1 --detach", "--tev");
  expect_wrong("render a.glb --samples 1 --rows 0:1 --tev h:1", "--rows");
  expect_wrong("render a.glb --samples 1 --rows 0:1 --preview", "--rows excludes it");
  expect_wrong("render a.glb --tev 14158", "HOST:PORT");
}

TEST(CommandLine, InfoTakesOneFile) {
  EXPECT_EQ(parsed<InfoOptions>("info model.glb").scene, "model.glb");
  EXPECT_TRUE(parsed<InfoOptions>("info model.glb --json").verbosity.json);
  expect_wrong("info", "missing");
}

TEST(CommandLine, TheSceneMayComeLastAndOptionsMayBeJoinedWithEquals) {
  const auto options =
      parsed<RenderOptions>("render -o a.png --samples=100 --threads=3 cornell.textproto");
  EXPECT_EQ(options.scene, "cornell.textproto");
  EXPECT_THAT(options.outputs, ElementsAre("a.png"));
  EXPECT_EQ(std::get<StopAtSamples>(options.image.stop).samples, 100u);
  EXPECT_EQ(options.threads, 3);
}

TEST(CommandLine, ArgumentsAfterTwoDashesAreNoOptions) {
  EXPECT_EQ(parsed<RenderOptions>("render -- -a.glb").scene, "-a.glb");
  EXPECT_EQ(parsed<RenderOptions>("render a.glb --").scene, "a.glb");
  EXPECT_THAT(parsed<StitchOptions>("stitch -o c.png -- -a.band b.band").parts,
              ElementsAre("-a.band", "b.band"));
  expect_wrong("render a.glb -- b.glb", "one argument too many, 'b.glb'");
  expect_wrong("render -- a.glb b.glb", "one argument too many, 'b.glb'");
}

TEST(CommandLine, WithoutAStopRuleThereAre64Samples) {
  EXPECT_EQ(parsed<RenderOptions>("render a.glb").image.stop, StopRule(StopAtSamples{64}));
}

TEST(CommandLine, ServeTakesItsOptions) {
  const auto options = parsed<ServeOptions>("serve --data /d --listen [::]:0 --insecure");
  EXPECT_EQ(options.data, "/d");
  EXPECT_EQ(options.listen, "[::]:0");
  EXPECT_TRUE(options.insecure);
  EXPECT_EQ(parsed<ServeOptions>("serve").listen, "0.0.0.0:7878");
  EXPECT_EQ(parsed<ServeOptions>("serve").web, "");
  EXPECT_EQ(parsed<ServeOptions>("serve --web none").web, "none");
  EXPECT_EQ(parsed<ServeOptions>("serve --web 127.0.0.1:0").web, "127.0.0.1:0");
  EXPECT_EQ(parsed<ServeOptions>("serve --keep-days 2").keep_days, 2);
  EXPECT_EQ(parsed<ServeOptions>("serve --keep-size 0.5").keep_gb, 0.5);
  EXPECT_EQ(parsed<ServeOptions>("serve --keep-jobs 50").keep_jobs, 50u);
  EXPECT_EQ(parsed<ServeOptions>("serve --audit 0%").audit_share, 0);
  EXPECT_EQ(parsed<ServeOptions>("serve").browser_audit_share, 0.1);
  EXPECT_EQ(parsed<ServeOptions>("serve --browser-audit 0%").browser_audit_share, 0);
  EXPECT_EQ(parsed<ServeOptions>("serve --browser-audit 100%").browser_audit_share, 1);
  EXPECT_EQ(parsed<ServeOptions>("serve").browsers, Browsers::kAlso);
  EXPECT_EQ(parsed<ServeOptions>("serve --browsers none").browsers, Browsers::kNone);
  EXPECT_EQ(parsed<ServeOptions>("serve --browsers also").browsers, Browsers::kAlso);
  EXPECT_EQ(parsed<ServeOptions>("serve --browsers only").browsers, Browsers::kOnly);
}

TEST(CommandLine, TheOtherCommandsTakeTheirOptions) {
  EXPECT_EQ(parsed<WatchOptions>("watch 7 -o a.png").job, 7u);
  EXPECT_EQ(parsed<CancelOptions>("cancel 12").job, 12u);
  EXPECT_EQ(parsed<PauseOptions>("pause 3").job, 3u);
  EXPECT_EQ(parsed<ResumeOptions>("resume 3 --farm x").farm.farm, "x");
  EXPECT_EQ(parsed<PriorityOptions>("priority 3 10").priority, 10);
  EXPECT_EQ(parsed<PriorityOptions>("priority 3 -10").priority, -10);
  EXPECT_EQ(parsed<SubmitOptions>("submit a.glb --priority -3").priority, -3);
  EXPECT_TRUE(parsed<WhyOptions>("why 3 --json").verbosity.json);
  EXPECT_EQ(parsed<LogsOptions>("logs desk").worker, "desk");
  EXPECT_EQ(parsed<DoctorOptions>("doctor --data /d --listen [::]:1").listen, "[::]:1");
  EXPECT_EQ(parsed<RotateOptions>("secret rotate farm --data /d").role, link::Role::kFarm);
  EXPECT_TRUE(parsed<JobsOptions>("jobs --json").verbosity.json);
  EXPECT_EQ(parsed<WorkersOptions>("workers --farm x").farm.farm, "x");
  EXPECT_THAT(parsed<StitchOptions>("stitch a.band b.band -o c.png").parts,
              ElementsAre("a.band", "b.band"));
  EXPECT_THAT(parsed<StitchOptions>("stitch -o c.png a.band b.band").parts,
              ElementsAre("a.band", "b.band"));
  EXPECT_EQ(parsed<CompareOptions>("compare a.png b.png").reference, "b.png");
  EXPECT_EQ(parsed<RenderOptions>("render a.glb --rows 3:9").rows, (RowRange{3, 9}));
}

TEST(CommandLine, ALinkForBrowsersIsShownMadeOrRevoked) {
  EXPECT_FALSE(parsed<LinkOptions>("link").seconds);
  EXPECT_FALSE(parsed<LinkOptions>("link").revoke);
  EXPECT_EQ(*parsed<LinkOptions>("link --for 90m").seconds, 5400);
  EXPECT_TRUE(parsed<LinkOptions>("link --revoke --json").revoke);
}

TEST(CommandLine, TheFarmMayComeFromStandardInput) {
  EXPECT_EQ(parsed<JobsOptions>("jobs --farm -").farm.farm, "-");
}

TEST(CommandLine, HelpAndVersionAreTexts) {
  EXPECT_THAT(parsed<ShowText>("--help").text, HasSubstr("submit"));
  EXPECT_THAT(parsed<ShowText>("submit --help").text, HasSubstr("--error"));
  EXPECT_THAT(parsed<ShowText>("pause --help").text, HasSubstr("Example: bandsaw pause 7"));
  EXPECT_THAT(parsed<ShowText>("--version").text, HasSubstr("bandsaw 0."));
}

TEST(CommandLine, AnErrorIsOneLineThatNamesTheWrongWord) {
  expect_wrong("", "no command");
  expect_wrong("rendr a.textproto", "'rendr'; did you mean render?");
  expect_wrong("xyzzy", "bandsaw --help");
  expect_wrong("--quiet jobs", "--quiet");
  expect_wrong("render a.textproto --sample 4", "'--sample'; did you mean --samples?");
  expect_wrong("render a.textproto --bogus=4", "'--bogus'");
  expect_wrong("render a.textproto b.textproto", "b.textproto");
  expect_wrong("render", "scene");
  expect_wrong("submit", "scene");
  expect_wrong("render a.textproto --samples", "samples");
  expect_wrong("watch", "number");
  expect_wrong("watch seven", "'seven'");
  expect_wrong("cancel 0", "'0'");
  expect_wrong("serve --keep-days 0", "--keep-days");
  expect_wrong("serve --keep-size much", "--keep-size");
  expect_wrong("serve --keep-jobs 0", "--keep-jobs");
  expect_wrong("serve --browser-audit 101%", "--browser-audit");
  expect_wrong("serve --browsers all", "--browsers: must be none, also or only");
  expect_wrong("pause", "number");
  expect_wrong("logs", "name");
  expect_wrong("doctor --listen 7878", "HOST:PORT");
  expect_wrong("secret", "rotate");
  expect_wrong("secret rotate", "worker or farm");
  expect_wrong("link --for 0.5s", "at least one second");
  expect_wrong("link --for 31d", "--for");
  expect_wrong("link --for 1h --revoke", "exclude each other");
  expect_wrong("secret rotate everybody", "worker or farm");
  expect_wrong("priority 3", "value");
  expect_wrong("priority 3 1001", "1000");
  expect_wrong("priority 3 high", "'high'");
  expect_wrong("submit a.glb --priority 1e9", "--priority");
  expect_wrong("stitch -o a.png", "parts");
  expect_wrong("stitch a.band", "output");
  expect_wrong("compare a.png", "two images");
  expect_wrong("serve --listen 7878", "HOST:PORT");
  expect_wrong("serve --web 8787", "--web: must be HOST:PORT");
  expect_wrong("serve --listen localhost:70000", "70000");
}

TEST(CommandLine, ValuesOutOfRangeAreWrong) {
  expect_wrong("render a.textproto --samples 0", "--samples");
  expect_wrong("render a.textproto --samples 1.5", "--samples");
  expect_wrong("render a.textproto --samples -4", "samples");
  expect_wrong("render a.textproto --samples 99999999999999999999", "--samples");
  expect_wrong("render a.textproto --error 0.01", "--error");
  expect_wrong("render a.textproto --error 0%", "--error");
  expect_wrong("render a.textproto --error 101%", "--error");
  expect_wrong("render a.textproto --time soon", "--time");
  expect_wrong("render a.textproto --time 0s", "--time");
  expect_wrong("render a.textproto --width 0", "--width");
  expect_wrong("render a.textproto --height 70000", "--height");
  expect_wrong("render a.textproto --depth 1025", "--depth");
  expect_wrong("render a.textproto --threads 0", "--threads");
  expect_wrong("render a.textproto --rows 9:2", "--rows");
  expect_wrong("render a.textproto --rows 9", "--rows");
}

TEST(CommandLine, OptionsThatExcludeEachOtherAreWrong) {
  expect_wrong("render a.textproto --samples 4 --error 1%", "exclude");
  expect_wrong("render a.textproto --samples 4 --samples 5", "samples");
  expect_wrong("submit a.textproto --time 5s --error 1%", "exclude");
  expect_wrong("submit a.textproto --quiet --json", "exclude");
  expect_wrong("submit a.textproto --denoise --detach", "bandsaw watch JOB");
  expect_wrong("watch 3 --denoise", "add -o FILE");
  expect_wrong("render a.textproto --denoise --rows 0:4 -o a.band", "omit --rows");
  expect_wrong("study a.textproto --denoise --every-object", "exclude");
  expect_wrong("submit a.textproto --detach -o a.png", "--detach");
  expect_wrong("render a.textproto --rows 0:4 --time 5s", "--samples");
}

TEST(CommandLine, OutputsHaveAKnownSuffix) {
  expect_wrong("render a.textproto -o a.jpeg", "pfm");
  expect_wrong("submit a.textproto -o a", "pfm");
  expect_wrong("submit a.textproto -o a.band", "--rows");
  expect_wrong("render a.textproto -o a.band", "--rows");
  EXPECT_TRUE(parse("render a.textproto --rows 0:4 -o a.band").ok());
}

TEST(CommandLine, TheHelpOfEachCommandHasAnExampleAndTheExitCodes) {
  const std::string all = parsed<ShowText>("help").text;
  for (const char* command : {"serve", "submit", "watch", "jobs", "workers", "cancel", "pause",
                              "resume", "priority", "why", "logs", "doctor", "secret", "render",
                              "info", "stitch", "compare", "study", "completion"}) {
    EXPECT_THAT(all, HasSubstr(std::string("  ") + command)) << command;
    const std::string help = parsed<ShowText>(std::string("help ") + command).text;
    EXPECT_EQ(help, parsed<ShowText>(std::string(command) + " --help").text);
    EXPECT_THAT(help, HasSubstr("Example: ")) << command;
    EXPECT_THAT(help, HasSubstr(std::string("bandsaw ") + command)) << command;
    EXPECT_THAT(help, HasSubstr("Exit status: 0 done")) << command;
  }
}

TEST(CommandLine, RenderTakesEachKernelOfThisMachine) {
  EXPECT_EQ(parsed<RenderOptions>("render a.glb").kernel, nullptr);
  for (const Kernel* kernel : kernels()) {
    EXPECT_EQ(parsed<RenderOptions>(std::string("render a.glb --kernel ") + kernel->name).kernel,
              kernel);
  }
}

TEST(CommandLine, AnErrorNamesTheNearestKnownWord) {
  expect_wrong("rendr a.glb", "did you mean render?");
  expect_wrong("render a.glb --sample 4", "did you mean --samples?");
  expect_wrong("render a.glb --integrator pth", "did you mean path?");
  expect_wrong("render a.glb --tone flimic", "must be none or filmic, is 'flimic'; did you mean");
  expect_wrong("render a.glb --kernel sse2", "--kernel: must be ");
  expect_wrong("render a.glb -o a.exr --layers albedo,normals", "did you mean normal?");
  expect_wrong("render a.glb -o a.exr --layers depth,depth", "depth twice");
  expect_wrong("secret rotate wroker", "did you mean worker?");
  expect_wrong("completion zsh", "must be bash");
}

}  // namespace
}  // namespace bandsaw::coordinator
