#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/sessions/session/blind_run.h"
#include "felt/led_hand.h"
#include "sealed/session_export.h"
#include "sealed/trials/trial_counts.h"
#include "sealed/trials/trial_quality.h"
#include "session/device_check.h"
#include "support/allocation_counter.h"
#include "support/example_laws.h"

namespace kerf::bench {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr double guided_period_s = 1e-3;

GuidedMotion felt_guide(double limit = 0.4) {
  return {.kind = GuideKind::strokes,
          .from = 0.0,
          .to = -0.2,
          .stroke_s = 0.5,
          .pause_s = 0.1,
          .felt = FeltGuide{.stiffness = 5.0, .damping = 0.0, .limit = limit},
          .position_unit = "rad",
          .force_unit = "N"};
}

LawRendering stiff_spring(double stiffness) {
  const std::array values{stiffness, 1e-9, 1e-9};
  return {models::Law::make("kelvin", values), {.position = 0.0, .direction = -1.0}, {0}};
}

TrialRendering led_trial_of(double first, double second) {
  TrialRendering trial{.laws = {stiff_spring(first), stiff_spring(second)},
                       .gains = {1.0, 1.0},
                       .led_axis = 0,
                       .slots = 2,
                       .law_of = {0, 1}};
  trial.trace.resize(20'000);
  return trial;
}

/// The guide's part of the force in each tick with a tool that rests 0.1 rad deep in the law.
std::vector<double> guide_forces(BlindRendering& rendering, const TrialRendering& trial, int ticks) {
  drivers::Sample sample;
  sample.position[0] = -0.1;
  std::vector<double> forces;
  for (int i = 0; i < ticks; ++i) {
    const Command command = rendering(sample, guided_period_s);
    rendering.record({.position = sample.position, .force_commanded = command.force});
    forces.push_back(trial.trace[trial.rows - 1].row.channels[2]);
  }
  return forces;
}

TEST(GuidedTrials, FeelTheSameGuideWhateverPlays) {
  std::vector<std::vector<double>> felt;
  for (const std::size_t slot : {0U, 1U}) {
    BlindRendering rendering(0.1, SwitchKind::blend, felt_guide());
    TrialRendering trial = led_trial_of(10.0, 30.0);
    rendering.begin(trial);
    (void)guide_forces(rendering, trial, 50);
    EXPECT_EQ(trial.trace[49].row.channels[2], 0.0) << "before anything plays";
    rendering.play(slot);
    felt.push_back(guide_forces(rendering, trial, 1500));
    for (std::size_t i = 150; i < trial.rows; ++i) {
      const schema::Row& row = trial.trace[i].row;
      ASSERT_NEAR(row.force_commanded[0] - row.channels[2], slot == 0 ? 1.0 : 3.0, 1e-9)
          << "the law's force is what is left";
    }
  }
  EXPECT_EQ(felt[0], felt[1]);
  EXPECT_NEAR(*std::ranges::max_element(felt[0]), 0.4, 1e-12) << "the limit";
  EXPECT_NEAR(*std::ranges::min_element(felt[0]), -0.4, 1e-12);
}

TEST(GuidedTrials, TakeTheGuideInAndOutSoftly) {
  BlindRendering rendering(0.1, SwitchKind::blend, felt_guide());
  TrialRendering trial = led_trial_of(10.0, 30.0);
  rendering.begin(trial);
  rendering.play(0);
  std::vector<double> forces = guide_forces(rendering, trial, 300);
  rendering.play(std::nullopt);
  rendering.let_go();
  const std::vector<double> out = guide_forces(rendering, trial, 150);
  forces.insert(forces.end(), out.begin(), out.end());
  double largest_step = 0.0;
  for (std::size_t i = 1; i < forces.size(); ++i)
    largest_step = std::max(largest_step, std::abs(forces[i] - forces[i - 1]));
  EXPECT_LE(largest_step, 0.4 / 100.0 + 5.0 * 0.2 * 1.875 / 0.5 * 1e-3 + 1e-9)
      << "no step but ramp and stroke";
  EXPECT_EQ(out.back(), 0.0);
  EXPECT_FALSE(rendering.idle());
  rendering.end();
  drivers::Sample sample;
  (void)rendering(sample, guided_period_s);
  rendering.record({});
  EXPECT_TRUE(rendering.idle());
}

TEST(GuidedTrials, EndOnlyWhenTheGuideIsGone) {
  BlindRendering rendering(0.1, SwitchKind::blend, felt_guide());
  TrialRendering trial = led_trial_of(10.0, 30.0);
  rendering.begin(trial);
  rendering.play(0);
  (void)guide_forces(rendering, trial, 200);
  rendering.play(std::nullopt);  // as in the gap of a sequence: the guide leads on
  EXPECT_NE(guide_forces(rendering, trial, 200).back(), 0.0);
  rendering.end();
  drivers::Sample sample;
  int ticks = 0;
  for (; ticks < 300 && !rendering.idle(); ++ticks) {
    (void)rendering(sample, guided_period_s);
    rendering.record({});
  }
  EXPECT_NEAR(ticks, 100, 1);
}

TEST(GuidedTrials, AllocateNothingInTheTick) {
  BlindRendering rendering(0.1, SwitchKind::through_zero, felt_guide());
  TrialRendering trial = led_trial_of(10.0, 30.0);
  rendering.begin(trial);
  rendering.play(1);
  drivers::Sample sample;
  const test::NoAllocation guard;
  for (int i = 0; i < 2000; ++i) {
    sample.position[0] = -0.1 - 1e-5 * i;
    const Command command = rendering(sample, guided_period_s);
    rendering.record({.force_commanded = command.force});
  }
}

constexpr auto by_strokes = R"([guide]
kind = "target"
from = { value = 32, unit = "deg" }
to = { value = 12, unit = "deg" }
stroke = { value = 600, unit = "ms" }
pause = { value = 150, unit = "ms" }
)";
constexpr auto felt_softly =
    "felt = { stiffness = { value = 6, unit = \"N/rad\" }, limit = { value = 0.5, unit = \"N\" } }\n";
constexpr double guided_cycle_s = 1.5;

Protocol guided(const std::string& more,
                const std::string& top = "design = \"abx\"\ntrials = 4\npractice = 1\n") {
  return test::protocol_from(test::protocol_text(top, more));
}

SessionRunOptions with_led_hand(const Protocol& protocol) {
  SessionRunOptions options;
  options.loop.device_uri = led_hand("sim:scissors", protocol);
  return options;
}

TEST(GuidedTrials, OfAHandThatFollowsAreNearTheTargetAndBeginWithItsCycle) {
  const Protocol protocol = guided(std::string(by_strokes) + felt_softly);
  test::BlindRun session(protocol);
  test::WatchingSubject subject(3);
  ASSERT_EQ(session.run(subject, with_led_hand(protocol)).end, SessionEnd::finished);
  EXPECT_THAT(subject.seen, Contains(HasSubstr("The next trial | It begins in a moment.")));
  const SessionStore store = session.read();
  ASSERT_EQ(store.trials().size(), 5U);
  for (std::size_t i = 0; i < store.trials().size(); ++i) {
    const RecordedTrial trial = store.trial(i);
    ASSERT_EQ(trial.channels.size(), led_channels);
    EXPECT_EQ(trial.channels[1].name, "theta_target");
    const double begun_s = std::fmod(trial.trace.front().row.channels[0], guided_cycle_s);
    EXPECT_LT(begun_s, 0.01) << "a trial begins with the guide's cycle";
    const TrialQuality quality = *quality_of(trial, store.protocol());
    for (const SlotFelt& slot : quality.slots) {
      EXPECT_GT(slot.off_target, 1e-3) << "the law pushes the hand aside";
      EXPECT_LT(slot.off_target, 0.06);
      EXPECT_LE(slot.guide_peak_n, 0.5);
      EXPECT_GT(slot.guide_rms_n, 0.0);
    }
  }
}

TEST(GuidedTrials, OfAHandThatDoesAsItLikesAreVoidAndComeAgain) {
  const Protocol protocol =
      guided(std::string(by_strokes) +
             "[trial]\nvoid = { off_target = { value = 4, unit = \"deg\" } }\nrepeats = 1\n");
  test::BlindRun led(protocol);
  RehearsalSubject follows(1);
  (void)led.run(follows, with_led_hand(protocol));
  EXPECT_EQ(counts_of(led.read()).voided, 0U);
  test::BlindRun astray(protocol);
  test::WatchingSubject wanders(1);
  EXPECT_EQ(astray.run(wanders).end, SessionEnd::finished);
  const TrialCounts counts = counts_of(astray.read());
  EXPECT_GT(counts.voided, 0U);
  EXPECT_EQ(counts.by_reason[static_cast<std::size_t>(VoidReason::off_target)], counts.voided);
  EXPECT_THAT(in_words(counts), HasSubstr("off-target"));
  EXPECT_THAT(wanders.seen, Contains(HasSubstr("the tool was too far from the target")));
}

TEST(GuidedTrials, AreLedOnlyWhenTheProtocolSaysSo) {
  const Protocol protocol = guided(std::string(by_strokes) + "when = \"practice\"\n");
  test::BlindRun session(protocol);
  std::vector<bool> guided_practice, guided_trials;
  RehearsalSubject inner(1);
  SubjectView seen;
  test::ScriptedSubject subject([&](const SubjectView& view) {
    if (!(view == seen)) inner.show(view);
    seen = view;
    if (view.stage == SessionStage::trial && view.playing)
      (view.practice ? guided_practice : guided_trials).push_back(view.guided);
    return inner.next();
  });
  ASSERT_EQ(session.run(subject, with_led_hand(protocol)).end, SessionEnd::finished);
  EXPECT_TRUE(std::ranges::all_of(guided_practice, [](bool it) { return it; }));
  EXPECT_TRUE(std::ranges::none_of(guided_trials, [](bool it) { return it; }));
  const SessionStore store = session.read();
  EXPECT_TRUE(led_axis_of(store.trial(0)));
  EXPECT_FALSE(led_axis_of(store.trial(1)));
  EXPECT_TRUE(std::isnan(quality_of(store.trial(1), store.protocol())->slots[0].off_target));
}

TEST(GuidedTrials, AreAnalysedByTheLawsForcesAndByWhatTheHandDid) {
  const Protocol protocol = guided(std::string(by_strokes) + felt_softly);
  test::BlindRun session(protocol);
  RehearsalSubject subject(3);
  (void)session.run(subject, with_led_hand(protocol));
  const SessionStore store = session.read();
  const Study study = study_of({&store});
  ASSERT_EQ(study.explored.size(), 4U * 3U);
  EXPECT_TRUE(std::ranges::all_of(study.explored, [](const ExploredSlot& slot) {
    return slot.hand.off_target > 0.0 && slot.hand.peak_speed_m_s > slot.hand.speed_m_s;
  }));
  const test::TemporaryFolder folder;
  export_session(store, folder / "out", false);
  const std::string slots = test::read_text(folder / "out" / "slots.csv");
  EXPECT_THAT(slots,
              HasSubstr("strokes,strokes_per_s,peak_speed_m_s,off_target,lag_s,guide_rms_N,guide_peak_N"));
  const schema::Recording trial = schema::read_recording(folder / "out" / "trial-001.h5");
  ASSERT_EQ(trial.channels.size(), 3U);
  EXPECT_EQ(trial.channels[2].name, "theta_guide_force");
}

TEST(GuidedTrials, AskForNoStifferGuideThanTheDeviceRendersPassively) {
  const auto checked = [](const std::string& felt) {
    const std::atomic<bool> stop{false};
    return check_samples(guided(std::string(by_strokes) + felt), "sim:scissors", stop);
  };
  EXPECT_NO_THROW((void)checked(felt_softly));
  // b > K T / 2 of 0.2 N·s/m at a lever of 0.28 / 7.58 m and 1 kHz: 14.78 N/rad.
  EXPECT_THAT(
      [&] {
        (void)checked(
            "felt = { stiffness = { value = 15, unit = \"N/rad\" }, limit = { value = 1, unit = \"N\" } }\n");
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("up to 14.78 N/rad at 1000 Hz; lower 'stiffness'")));
  EXPECT_NO_THROW((void)checked(
      "felt = { stiffness = { value = 14, unit = \"N/rad\" }, limit = { value = 1, unit = \"N\" } }\n"));
  EXPECT_THAT(
      [&] {
        (void)checked(
            "felt = { stiffness = { value = 5, unit = \"N/rad\" }, limit = { value = 5, unit = \"N\" } }\n");
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("expected at most half of that")));
}

TEST(GuidedTrials, OfASequenceAreFeltAlongOneWayOrItIsSaid) {
  const std::atomic<bool> stop{false};
  const auto remarks = [&](const char* gap) {
    return check_samples(
        guided(by_strokes,
               fmt::format("design = \"2ifc\"\nsignal = \"stiff\"\ninterval = {{ value = 2.5, unit = "
                           "\"s\" }}\ngap = {{ value = {}, unit = \"s\" }}\n",
                           gap)),
        "sim:scissors", stop);
  };
  EXPECT_THAT(remarks("0.6"), Contains(HasSubstr("other parts of the [guide]'s way")));
  EXPECT_THAT(remarks("0.5"), testing::Not(Contains(HasSubstr("[guide]"))));
}

TEST(GuidedTrials, ShowTheRunningLoopToWhoeverLooks) {
  const Protocol protocol = guided(by_strokes);
  test::BlindRun session(protocol);
  LiveGuide live;
  EXPECT_TRUE(std::isnan(live.look().time_s)) << "nothing runs yet";
  RehearsalSubject subject(1);
  SessionRunOptions options = with_led_hand(protocol);
  options.live_guide = &live;
  double farthest = 0.0;
  double last_s = 0.0;
  options.loop.each_row = [&](const schema::Row& row) {
    const GuideLook now = live.look();
    farthest = std::max(farthest, std::abs(now.position - row.position[0]));
    EXPECT_GE(now.time_s, last_s);
    last_s = now.time_s;
  };
  (void)session.run(subject, options);
  EXPECT_EQ(farthest, 0.0);
  EXPECT_GT(last_s, 5.0);
}

}  // namespace
}  // namespace kerf::bench
