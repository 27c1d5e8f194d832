#include "protocol/protocol.h"

#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/sessions/protocol/written_protocol.h"
#include "protocol/judgement.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

using psychophysics::Decision;
using test::level_text;
using test::protocol_from;
using test::protocol_text;
using testing::AllOf;
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

TEST(SessionProtocol, ShowsSubjectsATitleThatTellsNothingUnlessItSaysOne) {
  EXPECT_EQ(protocol_from(everything).title, "Comparison");
  EXPECT_EQ(protocol_from("title = \"Cutting liver\"\n" + std::string(everything)).title, "Cutting liver");
}

// With "blend" a switch from X to the sample that X is changes nothing: that would be noticing a change.
TEST(SessionProtocol, SwitchesAbxThroughZeroUnlessItSaysOtherwise) {
  const auto of = [](const std::string& design) {
    return protocol_from(protocol_text("design = " + design)).switching;
  };
  EXPECT_EQ(of("\"abx\""), SwitchKind::through_zero);
  EXPECT_EQ(of("\"abx\"\nswitching = \"blend\""), SwitchKind::blend);
  EXPECT_EQ(of("\"preference\""), SwitchKind::blend);
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
  const auto strokes = std::get<StrokesToAndFro>(protocol.motion->axes.at(0).script);
  EXPECT_NEAR(strokes.from, 0.523599, 1e-6);
  EXPECT_EQ(strokes.to, 0.1);
  EXPECT_EQ(strokes.stroke_s, 0.5);
  EXPECT_EQ(strokes.pause_s, 0.0);
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

TEST(SessionProtocol, OfYesNoAsksHowSureSomebodyIs) {
  const auto yes_no = [](const std::string& more) {
    return protocol_from(protocol_text("design = \"yes-no\"\nsignal = \"soft\"\n" + more));
  };
  const Protocol protocol = yes_no("confidence = [\"unsure\", \"sure\"]");
  EXPECT_EQ(slots_of(protocol.design), 1U);
  EXPECT_EQ(choices_of(protocol), 4U);
  EXPECT_THAT(choice_labels_of(protocol),
              testing::ElementsAre("no, sure", "no, unsure", "yes, unsure", "yes, sure"));
  for (std::size_t choice = 0; choice < 4; ++choice)
    EXPECT_EQ(answer_of_choice(protocol, choice), choice < 2 ? 0U : 1U);
  EXPECT_EQ(confidence_of_choice(protocol, 0), 2U);
  EXPECT_EQ(confidence_of_choice(protocol, 2), 1U);
  EXPECT_THAT(choice_labels_of(yes_no("confidence = []")), testing::ElementsAre("no", "yes"));
  EXPECT_EQ(choices_of(yes_no("")), 6U);
  const auto refused = [&](const std::string& more, const std::string& message) {
    EXPECT_THAT([&] { (void)yes_no(more); }, ThrowsMessage<std::invalid_argument>(HasSubstr(message)));
  };
  refused("confidence = [\"sure\"]", "array of 2 to 4 words");
  refused("confidence = [\"sure\", \"sure\"]", "'sure' is there twice");
  refused("confidence = [\"\", \"sure\"]", "is no word");
  refused("strategy = \"differencing\"", "'strategy' is for the designs \"abx\" and \"same-different\"");
  EXPECT_THAT([&] { (void)protocol_from(protocol_text("design = \"yes-no\"")); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("needs 'signal'")));
  EXPECT_THAT([&] { (void)protocol_from(protocol_text("design = \"abx\"\nconfidence = []")); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("'confidence' is for the design \"yes-no\"")));
}

TEST(SessionProtocol, OfSameDifferentHasTwoWordsForAnswers) {
  const Protocol protocol =
      protocol_from(protocol_text("design = \"same-different\"\nstrategy = \"differencing\""));
  EXPECT_THAT(choice_labels_of(protocol), testing::ElementsAre("same", "different"));
  EXPECT_EQ(task_of(protocol).decision, psychophysics::Decision::same_different_differencing);
  EXPECT_EQ(protocol.switching, SwitchKind::through_zero);
}

TEST(SessionProtocol, HasExamplesOfAdaptiveMethods) {
  for (const std::string name : test::adaptive_examples)
    EXPECT_TRUE(is_adaptive(test::example_protocol(name).design)) << name;
  EXPECT_EQ(test::example_protocol("interleaved").scale.staircases().size(), 2U);
  EXPECT_TRUE(test::example_protocol("psi-marginal").scale.quest.nuisance.any());
}

}  // namespace
}  // namespace kerf::bench
