#include "session/protocol.h"

#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/session/written_protocol.h"
#include "session/judgement.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

using psychophysics::Decision;
using test::level_text;
using test::protocol_from;
using test::protocol_text;
using testing::AllOf;
using testing::Combine;
using testing::DoubleEq;
using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;
using testing::ThrowsMessage;

void expect_refused(const std::string& text, const std::string& message) {
  EXPECT_THAT([&] { (void)protocol_from(text); },
              ThrowsMessage<std::invalid_argument>(AllOf(HasSubstr("p.protocol.toml:"), HasSubstr(message))))
      << text;
}

constexpr auto everything = R"(name = "liver: recording against model"
design = "preference"
question = "Which felt more like cutting liver?"
instructions = """
Cut slowly.
Switch as you like."""
consent = "I take part of my own free will."
trials = 14
practice = 2
presentation = "sequence"
interval = { value = 3, unit = "s" }
gap = { value = 200, unit = "ms" }
longest = { value = 2, unit = "min" }
device = "sim:scissors"
rate = { value = 2000, unit = "Hz" }
loudness = "peak"
switching = "through-zero"
ramp = { value = 100, unit = "ms" }
break = { every = 20, at_least = { value = 1, unit = "min" } }
[[sample]]
name = "recording"
law = "soft.law.toml"
[[sample]]
name = "model"
law = "stiff.law.toml"
[[sample]]
name = "third"
law = "third.law.toml"
[[tissue]]
name = "liver"
samples = ["model", "recording"]
[[tissue]]
name = "skin"
samples = ["recording", "model", "third"]
[motion]
from = { value = 30, unit = "deg" }
to = { value = 0.1, unit = "rad" }
stroke = { value = 500, unit = "ms" }
pause = { value = 0, unit = "s" }
seconds = { value = 2, unit = "s" }
)";

TEST(SessionProtocol, SaysEverythingOfASession) {
  const Protocol protocol = protocol_from(everything);
  EXPECT_EQ(protocol.name, "liver: recording against model");
  EXPECT_EQ(protocol.design, Design::preference);
  EXPECT_EQ(protocol.question, "Which felt more like cutting liver?");
  EXPECT_EQ(protocol.instructions, "Cut slowly.\nSwitch as you like.");
  EXPECT_EQ(protocol.consent, "I take part of my own free will.");
  EXPECT_EQ(protocol.trials, 14U);
  EXPECT_EQ(protocol.practice, 2U);
  EXPECT_EQ(protocol.break_every, 20U);
  EXPECT_EQ(protocol.break_s, 60.0);
  EXPECT_EQ(protocol.toml, everything);
}

TEST(SessionProtocol, SaysHowSamplesAreRendered) {
  const Protocol protocol = protocol_from(everything);
  EXPECT_EQ(protocol.presentation, Presentation::sequence);
  EXPECT_EQ(protocol.interval_s, 3.0);
  EXPECT_EQ(protocol.gap_s, 0.2);
  EXPECT_EQ(protocol.longest_s, 120.0);
  EXPECT_EQ(protocol.device_uri, "sim:scissors");
  EXPECT_EQ(protocol.rate_hz, 2000.0);
  EXPECT_EQ(protocol.loudness, Loudness::peak);
  EXPECT_EQ(protocol.switching, SwitchKind::through_zero);
  EXPECT_EQ(protocol.ramp_s, 0.1);
  ASSERT_TRUE(protocol.motion);
  EXPECT_NEAR(protocol.motion->from, 0.523599, 1e-6);
  EXPECT_EQ(protocol.motion->to, 0.1);
  EXPECT_EQ(protocol.motion->stroke_s, 0.5);
  EXPECT_EQ(protocol.motion->pause_s, 0.0);
  EXPECT_EQ(protocol.motion->seconds, 2.0);
}

TEST(SessionProtocol, KeepsItsSamplesWithTheirLawsAndTissues) {
  const Protocol protocol = protocol_from(everything);
  ASSERT_THAT(protocol.samples, SizeIs(3));
  EXPECT_EQ(protocol.samples[1].name, "model");
  EXPECT_EQ(protocol.samples[1].law_toml, test::law_called("stiff.law.toml"));
  EXPECT_EQ(protocol.samples[1].law.law.values()[0], 8.0);
  EXPECT_EQ(protocol.samples[1].gain, 1.0);
  ASSERT_THAT(protocol.tissues, SizeIs(2));
  EXPECT_EQ(protocol.tissues[0].name, "liver");
  EXPECT_THAT(protocol.tissues[0].samples, ElementsAre(1, 0));
  EXPECT_THAT(pairs_of(protocol, 1), ElementsAre(ElementsAre(0, 1), ElementsAre(0, 2), ElementsAre(1, 2)));
}

TEST(SessionProtocol, WithoutTissuesComparesAllSamples) {
  const Protocol protocol = protocol_from(protocol_text("design = \"abx\""));
  ASSERT_THAT(protocol.tissues, SizeIs(1));
  EXPECT_EQ(protocol.tissues[0].name, "");
  EXPECT_THAT(protocol.tissues[0].samples, ElementsAre(0, 1));
}

TEST(SessionProtocol, LeavesTheSubjectFreeWherePreferencesOrAbxAreAsked) {
  EXPECT_EQ(protocol_from(protocol_text("design = \"preference\"")).presentation, Presentation::free);
  EXPECT_EQ(protocol_from(protocol_text("design = \"abx\"")).presentation, Presentation::free);
  EXPECT_EQ(protocol_from(protocol_text("design = \"2ifc\"\nsignal = \"stiff\"")).presentation,
            Presentation::sequence);
  EXPECT_EQ(
      protocol_from(level_text("design = \"constant\"", "vary = \"force\"\nlevels = [0.1]")).presentation,
      Presentation::sequence);
}

TEST(SessionProtocol, NeedsNoQuestionWhereThereIsOnlyOne) {
  const auto without = [](std::string text) {
    text.erase(text.find("question"), text.find('\n', text.find("question")) - text.find("question"));
    return text;
  };
  EXPECT_EQ(protocol_from(without(protocol_text("design = \"abx\""))).question, "Which one is X?");
  EXPECT_EQ(protocol_from(without(protocol_text("design = \"3ifc\"\nodd_one_out = true"))).question,
            "Which one is different from the other two?");
  expect_refused(without(protocol_text("design = \"preference\"")), "needs a 'question'");
}

TEST(SessionProtocol, GivesASequenceTheTimeThatItTakes) {
  const Protocol protocol = protocol_from(
      protocol_text("design = \"3ifc\"\nodd_one_out = true\ninterval = { value = 30, unit = \"s\" }"));
  EXPECT_DOUBLE_EQ(protocol.longest_s, 3 * 30.0 + 2 * 0.5);
  expect_refused(
      protocol_text("design = \"2ifc\"\nsignal = \"stiff\"\nlongest = { value = 8, unit = \"s\" }"),
      "the 2 intervals of a trial last 8.5 s");
}

TEST(SessionProtocol, ComparesTheSignalWithEachOtherSample) {
  const Protocol protocol = protocol_from(protocol_text("design = \"2ifc\"\nsignal = \"stiff\"",
                                                        "[[sample]]\nname = \"third\"\nlaw = "
                                                        "\"third.law.toml\"\n"));
  EXPECT_EQ(protocol.signal, 1U);
  EXPECT_THAT(pairs_of(protocol, 0), ElementsAre(ElementsAre(0, 1), ElementsAre(2, 1)));
}

TEST(SessionProtocol, TellsWhichTaskTheAnswersCameFrom) {
  const auto task = [](const std::string& top) { return task_of(protocol_from(protocol_text(top))); };
  EXPECT_EQ(task("design = \"abx\"").decision, Decision::abx_independent);
  EXPECT_EQ(task("design = \"abx\"\nstrategy = \"differencing\"").decision, Decision::abx_differencing);
  EXPECT_EQ(task("design = \"3ifc\"\nodd_one_out = true").decision, Decision::oddity);
  EXPECT_EQ(task("design = \"3ifc\"\nsignal = \"soft\"").decision, Decision::forced_choice);
  EXPECT_EQ(task("design = \"3ifc\"\nsignal = \"soft\"").intervals, 3);
  EXPECT_EQ(task("design = \"2ifc\"\nsignal = \"soft\"").intervals, 2);
  EXPECT_EQ(task_of(protocol_from(level_text("design = \"constant\"", "vary = \"force\"\nlevels = [0.1]")))
                .intervals,
            2);
}

TEST(SessionProtocol, HasNoTaskWhereNoAnswerIsRight) {
  const Protocol preference = protocol_from(protocol_text("design = \"preference\""));
  const Protocol two_sided =
      protocol_from(level_text("design = \"constant\"", "vary = \"force\"\nlevels = [-0.1, 0.1]"));
  EXPECT_THAT([&] { (void)task_of(preference); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("no answer is right")));
  EXPECT_THAT([&] { (void)task_of(two_sided); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("both sides of the standard")));
  EXPECT_FALSE(study_of(preference).task);
  EXPECT_FALSE(study_of(two_sided).task);
}

TEST(SessionProtocol, IsTheStudyThatItsAnswersBelongTo) {
  const Study study = study_of(protocol_from(protocol_text("design = \"abx\"")));
  EXPECT_EQ(study.name, "two laws");
  EXPECT_EQ(study.design, Design::abx);
  EXPECT_THAT(study.samples, ElementsAre("soft", "stiff"));
  ASSERT_TRUE(study.task);
  EXPECT_EQ(study.task->decision, Decision::abx_independent);
  EXPECT_THAT(study.judgements, SizeIs(0));
}

TEST(SessionProtocol, NamesItsSlots) {
  EXPECT_EQ(slots_of(Design::abx), 3U);
  EXPECT_EQ(answers_of(Design::abx), 2U);
  EXPECT_EQ(label_of(Design::abx, 2), "X");
  EXPECT_EQ(label_of(Design::preference, 1), "B");
  EXPECT_EQ(slots_of(Design::preference), 2U);
  EXPECT_EQ(answers_of(Design::three_interval), 3U);
  EXPECT_EQ(label_of(Design::three_interval, 2), "3");
  EXPECT_EQ(label_of(Design::staircase, 0), "1");
  EXPECT_EQ(label_of(Design::staircase, 2), "");
}

TEST(SessionProtocol, TakesTextsThatDriveNoTerminal) {
  const auto with = [](const std::string& key, const std::string& value) {
    return protocol_text(fmt::format("design = \"abx\"\n{} = \"{}\"", key, value));
  };
  expect_refused(with("instructions", "go \\u001b[2J"), "U+001B");
  expect_refused(with("consent", "go \\u009b2J"), "U+009B");
  expect_refused(with("instructions", "\\u0000"), "control character");
  expect_refused(with("device", "sim:scissors\\n"), "on one line");
  expect_refused(with("consent", "\\u007f"), "U+007F");
  EXPECT_EQ(protocol_from(with("consent", "oui, \\u00e0 la fin\\r\\nnon")).consent, "oui, à la fin\nnon");
}

TEST(SessionProtocol, TakesNamesOfSixtyCharacters) {
  const auto named = [](const std::string& name) {
    std::string text = protocol_text("design = \"abx\"");
    return text.replace(text.find("two laws"), 8, name);
  };
  std::string sixty;
  for (int i = 0; i < 60; ++i) sixty += "é";
  EXPECT_EQ(protocol_from(named(sixty)).name, sixty);
  expect_refused(named(sixty + "e"), "at most 60 characters");
  expect_refused(named(""), "needs a 'name'");
  expect_refused(named(" x"), "no space at the ends");
  expect_refused(named("x\\ty"), "U+0009");
}

struct BadProtocol {
  const char* name;
  std::string text;
  const char* message;
};
class BadProtocols : public testing::TestWithParam<BadProtocol> {};

TEST_P(BadProtocols, AreRefusedWithTheLine) { expect_refused(GetParam().text, GetParam().message); }

std::string of(const std::string& design, const std::string& more = "", const std::string& tables = "") {
  return protocol_text(fmt::format("design = \"{}\"\n{}", design, more), tables);
}

const BadProtocol bad_top[] = {
    {"Key", of("abx", "colour = 1"), ":4: unknown key 'colour' in a protocol"},
    {"NoDesign", protocol_text(""), "needs a 'design'"},
    {"Design", of("duo-trio"), "'design' is \"duo-trio\", expected one of \"preference\", \"abx\""},
    {"NoTrials", of("abx", "trials = 0"), "'trials' is 0, expected a number from 1 to 10000"},
    {"TooManyTrials", of("abx", "trials = 10001"), "'trials' is 10001"},
    {"HalfATrial", of("abx", "trials = 1.5"), "expected a whole number"},
    {"TrialsInText", of("abx", "trials = \"12\""), "must be a number"},
    {"Practice", of("abx", "practice = -1"), "'practice' is -1"},
    {"Interval", of("abx", "interval = 4"), "must be written { value = ..., unit = \"s\" }"},
    {"IntervalUnit", of("abx", "interval = { value = 4, unit = \"N\" }"), "expected s or a multiple"},
    {"IntervalRange", of("abx", "interval = { value = 0, unit = \"s\" }"), "from 0.1 to 600 s"},
    {"Ramp", of("2ifc", "signal = \"soft\"\nramp = { value = 4, unit = \"s\" }"), "less than the interval"},
    {"Presentation", of("abx", "presentation = \"mixed\""), "expected one of \"free\", \"sequence\""},
    {"Switching", of("abx", "switching = \"hard\""), "\"blend\", \"through-zero\""},
    {"Loudness", of("abx", "loudness = \"sone\""), "\"none\", \"peak\", \"rms\""},
    {"LoudnessWithoutMotion", of("abx", "loudness = \"rms\""), "needs a table [motion]"},
    {"Rate", of("abx", "rate = { value = 0, unit = \"Hz\" }"), "from 10 to 100000 Hz"},
    {"Break", of("abx", "break = { every = 0 }"), "'every' is 0"},
    {"BreakWithoutEvery", of("abx", "break = { at_least = { value = 3, unit = \"s\" } }"), "needs 'every'"},
    {"Feedback", of("preference", "practice = 1\nfeedback = true"), "no answer of a preference is right"},
    {"FeedbackOfNothing", of("abx", "feedback = true"), "expected 'practice' above 0"},
    {"Strategy", of("2ifc", "signal = \"soft\"\nstrategy = \"differencing\""), "for the design \"abx\""},
    {"NoSignal", of("2ifc"), "needs 'signal'"},
    {"NoSignalNorOdd", of("3ifc"), "or odd_one_out = true"},
    {"UnknownSignal", of("2ifc", "signal = \"loud\""),
     "no sample \"loud\"; the samples are \"soft\", \"stiff\""},
    {"SignalInAbx", of("abx", "signal = \"soft\""), "for the designs \"2ifc\" and \"3ifc\""},
    {"SignalAndOdd", of("3ifc", "signal = \"soft\"\nodd_one_out = true"), "leave 'signal' out"},
    {"OddOfTwo", of("2ifc", "odd_one_out = true"), "for the design \"3ifc\""},
    {"Scale", of("abx", "", "[scale]\nvary = \"force\"\n"), "[scale] is for the designs of levels"},
};
const BadProtocol bad_samples[] = {
    {"None", "name = \"x\"\ndesign = \"abx\"\n", "needs its samples"},
    {"Table", "name = \"x\"\ndesign = \"abx\"\n[sample]\nname = \"y\"\n", "expected one [[sample]]"},
    {"Key", of("abx", "", "[[sample]]\nname = \"x\"\nfile = \"y\"\n"), "unknown key 'file' in a [[sample]]"},
    {"WithoutLaw", of("abx", "", "[[sample]]\nname = \"x\"\n"), "sample 'x' needs a 'law'"},
    {"NoSuchLaw", of("abx", "", "[[sample]]\nname = \"x\"\nlaw = \"no.toml\"\n"),
     ":13: there is no file no.toml"},
    {"Twice", of("abx", "", "[[sample]]\nname = \"soft\"\nlaw = \"soft.law.toml\"\n"),
     "there are two samples named 'soft'"},
    {"OtherAxis", of("abx", "", "[[sample]]\nname = \"x\"\nlaw = \"linear.law.toml\"\n"),
     "samples 'soft' and 'x' cannot be compared"},
    {"Spatial", of("abx", "", "[[sample]]\nname = \"x\"\nlaw = \"spatial.law.toml\"\n"),
     "cannot be compared"},
    {"TissueOfOne", of("abx", "", "[[tissue]]\nname = \"t\"\nsamples = [\"soft\"]\n"),
     "tissue 't' has one sample; expected two or more"},
    {"TissueOfUnknown", of("abx", "", "[[tissue]]\nname = \"t\"\nsamples = [\"soft\", \"x\"]\n"),
     ":13: there is no sample \"x\""},
    {"TissueOfTwins", of("abx", "", "[[tissue]]\nname = \"t\"\nsamples = [\"soft\", \"soft\"]\n"),
     "has sample 'soft' twice"},
    {"TissueWithoutSamples", of("abx", "", "[[tissue]]\nname = \"t\"\n"), "needs 'samples'"},
    {"TissuesOfOneName",
     of("abx", "",
        "[[tissue]]\nname = \"t\"\nsamples = [\"soft\", \"stiff\"]\n[[tissue]]\nname = \"t\"\nsamples = "
        "[\"soft\", \"stiff\"]\n"),
     ":15: there are two tissues named 't'"},
    {"Unused",
     of("abx", "",
        "[[sample]]\nname = \"x\"\nlaw = \"third.law.toml\"\n[[tissue]]\nname = \"t\"\nsamples = [\"soft\", "
        "\"stiff\"]\n"),
     "sample 'x' is in no [[tissue]]"},
    {"TissueWithoutSignal",
     of("2ifc", "signal = \"stiff\"",
        "[[sample]]\nname = \"x\"\nlaw = \"third.law.toml\"\n[[tissue]]\nname = \"t\"\nsamples = [\"soft\", "
        "\"x\"]\n[[tissue]]\nname = \"u\"\nsamples = [\"soft\", \"stiff\"]\n"),
     "tissue 't' is without the signal 'stiff'"},
    {"TooManyPairs", of("abx", "trials = 3000", test::two_tissues), "12000 trials a subject"},
};
const BadProtocol bad_motions[] = {
    {"Nothing", of("abx", "", "[motion]\n"), "'from' is missing"},
    {"Unit", of("abx", "", "[motion]\nfrom = { value = 1, unit = \"m\" }\n"), "expected rad or a multiple"},
    {"Still",
     of("abx", "", "[motion]\nfrom = { value = 1, unit = \"rad\" }\nto = { value = 1, unit = \"rad\" }\n"),
     "nothing moves"},
    {"SceneWithStrokes", of("abx", "", "[motion]\nscene = \"s\"\nfrom = { value = 1, unit = \"m\" }\n"),
     "unknown key 'from' in a [motion] of a scene"},
    {"SpatialStrokes",
     "name = \"x\"\ndesign = \"abx\"\n[[sample]]\nname = \"a\"\nlaw = \"spatial.law.toml\"\n[[sample]]\nname "
     "= \"b\"\nlaw = \"spatial.law.toml\"\n[motion]\nfrom = { value = 1, unit = \"rad\" }\n",
     "its [motion] is a 'scene'"},
};
const auto name_of_bad = [](const auto& tested) { return std::string(tested.param.name); };
INSTANTIATE_TEST_SUITE_P(AtTheTop, BadProtocols, testing::ValuesIn(bad_top), name_of_bad);
INSTANTIATE_TEST_SUITE_P(InSamples, BadProtocols, testing::ValuesIn(bad_samples), name_of_bad);
INSTANTIATE_TEST_SUITE_P(InMotion, BadProtocols, testing::ValuesIn(bad_motions), name_of_bad);

TEST(SessionProtocol, IsReadWithTheLawsBesideIt) {
  const test::TemporaryFolder folder;
  std::filesystem::create_directory(folder / "laws");
  for (const auto* law : {"soft.law.toml", "stiff.law.toml"})
    test::write_text(folder.path() / "laws" / law, test::law_called(law));
  std::string text = protocol_text("design = \"abx\"");
  for (const auto* law : {"soft.law", "stiff.law"}) text.replace(text.find(law), 0, "laws/");
  test::write_text(folder / "p.protocol.toml", text);
  EXPECT_EQ(read_protocol(folder / "p.protocol.toml").samples[1].law.law.values()[0], 8.0);
  std::filesystem::remove(folder.path() / "laws" / "stiff.law.toml");
  EXPECT_THAT([&] { (void)read_protocol(folder / "p.protocol.toml"); },
              ThrowsMessage<std::invalid_argument>(
                  AllOf(HasSubstr("p.protocol.toml:9: there is no file"), HasSubstr("laws/stiff.law.toml"))));
}

TEST(SessionProtocol, SaysWhereALawIsWrong) {
  const auto broken = [](const std::string&) { return std::string("model = \"kelvin\"\ncolour = 1\n"); };
  EXPECT_THAT([&] { (void)parse_protocol(protocol_text("design = \"abx\""), "p.protocol.toml", broken); },
              ThrowsMessage<std::invalid_argument>(
                  HasSubstr("p.protocol.toml:6: soft.law.toml:2: unknown key 'colour'")));
}

TEST(SessionProtocol, FindsTheSceneOfItsMotionBesideIt) {
  const test::TemporaryFolder folder;
  for (const auto* law : {"soft.law.toml", "stiff.law.toml"})
    test::write_text(folder / law, test::law_called(law));
  test::write_text(folder / "p.protocol.toml",
                   protocol_text("design = \"abx\"", "[motion]\nscene = \"s.scene.toml\"\n"));
  EXPECT_THAT([&] { (void)read_protocol(folder / "p.protocol.toml"); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("s.scene.toml")));
  test::write_text(folder / "s.scene.toml", "");
  EXPECT_EQ(read_protocol(folder / "p.protocol.toml").motion->scene, folder / "s.scene.toml");
}

TEST(SessionProtocol, HasAnExampleOfEveryDesign) {
  for (const std::string name : test::example_protocols) {
    const Protocol protocol = test::example_protocol(name);
    EXPECT_EQ(name_of(protocol.design), name);
    EXPECT_TRUE(protocol.motion) << name;
    EXPECT_EQ(protocol.device_uri, "sim:scissors") << name;
  }
}

}  // namespace
}  // namespace kerf::bench
