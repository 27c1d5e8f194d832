#include "choose/choose.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <limits>
#include <set>
#include <stdexcept>
#include <string>
#include <system_error>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "choose/choice_files.h"
#include "known_cuts.h"
#include "known_laws.h"

namespace kerf::bench {
namespace {

using test::cut_of;
using test::known_kelvin;
using test::known_line;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

const std::atomic<bool> go_on{false};

ChooseOptions small() {
  ChooseOptions options;
  options.candidates = {.max_segments = 2, .max_arms = 2};
  return options;
}

LawChoice choose(const schema::Recording& recording, const ChooseOptions& options = small()) {
  return choose_law(recording, options, go_on);
}

std::string taken_name(const LawChoice& choice) {
  return choice.taken ? choice.candidates.at(*choice.taken).law.name : "none";
}

const Candidate& candidate(const LawChoice& choice, const std::string& name) {
  for (const Candidate& one : choice.candidates) {
    if (one.law.name == name) return one;
  }
  throw std::logic_error("no candidate " + name);
}

Matter matter_of(const LawChoice& choice, Effect effect) {
  const auto found = std::ranges::find(choice.effects, effect, &EffectVerdict::effect);
  return found != choice.effects.end() ? found->matter : throw std::logic_error("no such effect");
}

std::vector<std::string> names(const std::vector<CandidateLaw>& laws) {
  std::vector<std::string> all;
  for (const CandidateLaw& law : laws) all.push_back(law.name);
  return all;
}

TEST(Candidates, FitTheUnitsOfTheAxis) {
  const auto angles = names(candidates_for({.position_unit = "rad", .force_unit = "N"}, true));
  const auto depths = names(candidates_for({.position_unit = "m", .force_unit = "N"}, true));
  EXPECT_THAT(angles, Contains("scissors_analytic"));
  EXPECT_THAT(angles, Not(Contains("fracture")));
  EXPECT_THAT(depths, Contains("fracture"));
  EXPECT_THAT(depths, Not(Contains("scissors_analytic")));
}

TEST(Candidates, AreEveryScalarLawUnlessItSaysWhyNot) {
  std::set<std::string> chosen;
  for (const char* unit : {"m", "rad"}) {
    std::set<std::string> names;
    for (const CandidateLaw& law : candidates_for({.position_unit = unit, .force_unit = "N"}, true)) {
      chosen.insert(law.model);
      EXPECT_TRUE(names.insert(law.name).second) << law.name;
      EXPECT_FALSE(law.effects.empty() && law.parameters > 2) << law.name << " is no straight line";
    }
  }
  for (const std::string_view law : fitting::fitted_laws())
    EXPECT_NE(chosen.contains(std::string(law)), !models::law_facts(law).not_a_candidate.empty()) << law;
}

TEST(Candidates, HaveABranchForEachWayOnlyWhereThereAreCycles) {
  const auto without = names(candidates_for({}, false));
  EXPECT_THAT(names(candidates_for({}, true)), Contains("piecewise-12-loop"));
  EXPECT_THAT(without, Contains("piecewise-12"));
  EXPECT_THAT(without, Not(Contains(HasSubstr("loop"))));
}

TEST(Candidates, HaveAsManyParametersAsTheirFitsSearch) {
  for (const char* unit : {"rad", "m"}) {
    const double depth = unit == std::string("m") ? 0.03 : 0.4;
    const LawChoice choice =
        choose(cut_of(known_kelvin(), {.depth = depth, .encoder_step = 1e-6, .position_unit = unit}));
    for (const Candidate& one : choice.candidates) {
      if (!one.fit) continue;
      EXPECT_EQ(one.fit->result.free_parameters, one.law.parameters) << one.law.name;
    }
  }
}

TEST(Choose, TakesTheSimplestWithinTheJnd) {
  const LawChoice choice = choose(cut_of(known_kelvin()));
  EXPECT_TRUE(choice.serves) << choice.why;
  EXPECT_EQ(taken_name(choice), "kelvin");
  EXPECT_THAT(candidate(choice, "maxwell-2").why, HasSubstr("5 parameters, where kelvin does with 3"));
  EXPECT_THAT(candidate(choice, "piecewise-1").why, HasSubstr("JND off"));
  EXPECT_EQ(choice.held_out, "6 cycles, held out in 5 folds");
}

TEST(Choose, GoesByFewestParametersFirst) {
  const LawChoice choice = choose(cut_of(known_line()));
  EXPECT_TRUE(
      std::ranges::is_sorted(choice.candidates, {}, [](const Candidate& one) { return one.law.parameters; }));
  EXPECT_EQ(taken_name(choice), "piecewise-1");
}

TEST(Choose, PassesOverALawThatMissesItsDeadlines) {
  ChooseOptions options = small();
  options.search.deadline = [](const LawFile& law) {
    const bool slow = law.law.model() == "kelvin";
    return Deadline{.held = !slow, .why = slow ? "your law is too slow" : ""};
  };
  const LawChoice choice = choose(cut_of(known_kelvin()), options);
  EXPECT_TRUE(choice.serves);
  EXPECT_EQ(taken_name(choice), "springpot");
  EXPECT_EQ(candidate(choice, "kelvin").why, "your law is too slow");
  EXPECT_FALSE(candidate(choice, "piecewise-1").deadline) << "a law beyond the JND is not run";
}

TEST(Choose, PassesOverALawThatIsNotStable) {
  ChooseOptions options = small();
  options.search.stability = [](const LawFile& law, const schema::Recording&) {
    return law.law.model() == "kelvin" ? not_stable("it chatters") : StabilityVerdict{Stable::yes, {}};
  };
  const LawChoice choice = choose(cut_of(known_kelvin()), options);
  EXPECT_EQ(candidate(choice, "kelvin").why, "it chatters");
  EXPECT_EQ(candidate(choice, "kelvin").stability.stable, Stable::no);
  EXPECT_EQ(candidate(choice, "springpot").stability.stable, Stable::yes);
  EXPECT_EQ(taken_name(choice), "springpot");
  EXPECT_THAT(choice.why, Not(HasSubstr("not judged")));
}

TEST(Choose, RecommendsAControllerForASimplerLawThatIsStableUnderItAlone) {
  ChooseOptions options = small();
  options.search.stability = [](const LawFile& law, const schema::Recording&) {
    return law.law.model() == "kelvin" ? not_stable("it chatters") : StabilityVerdict{Stable::yes, {}};
  };
  options.search.controlled = [](const LawFile& law) {
    EXPECT_EQ(law.law.model(), "kelvin") << "only what is not stable by itself needs one";
    return ControlledInHand{.verdict = {.stable = Stable::yes, .why = {}}, .added_n = 0.02};
  };
  const LawChoice choice = choose(cut_of(known_kelvin()), options);
  EXPECT_EQ(taken_name(choice), "springpot") << "it is advice, and takes nothing";
  EXPECT_THAT(choice.why, HasSubstr("(--passivity-control) kelvin with 3 parameters is stable too"));
  EXPECT_THAT(choice.why, HasSubstr("adds 0.02 N (rms)"));
  EXPECT_THAT(choice.why, HasSubstr("less than would be felt"));
  const auto advice = choice_as_json(choice).at("choice").at("controller");
  EXPECT_EQ(advice.at("law"), "kelvin");
  EXPECT_EQ(advice.at("controller"), "passivity");
  EXPECT_EQ(advice.at("added"), 0.02);

  options.search.controlled = [](const LawFile&) {
    return ControlledInHand{.verdict = not_stable("it chatters all the same")};
  };
  const LawChoice without = choose(cut_of(known_kelvin()), options);
  EXPECT_TRUE(choice_as_json(without).at("choice").at("controller").is_null());
  EXPECT_THAT(without.why, Not(HasSubstr("controller")));
}

TEST(Choose, TakesALawThatNobodyCouldJudgeAndSaysSo) {
  ChooseOptions options = small();
  options.search.stability = [](const LawFile&, const schema::Recording&) {
    return not_judged("on falcon:0, axis 'x' has no known mass and friction");
  };
  const LawChoice choice = choose(cut_of(known_kelvin()), options);
  EXPECT_TRUE(choice.serves) << "or nothing could be taken on any real device";
  EXPECT_EQ(taken_name(choice), "kelvin");
  EXPECT_THAT(choice.why, HasSubstr("The stability of kelvin was not judged: on falcon:0, axis 'x' has no"));
  const auto json = choice_as_json(choice);
  for (const auto& one : json.at("candidates")) {
    EXPECT_TRUE(one.at("stable").is_null()) << one;
    const bool is_taken = one.at("law") == "kelvin";
    EXPECT_THAT(one.at("why_not_judged").get<std::string>(),
                HasSubstr(is_taken ? "falcon:0" : "not tried in closed loop"));
  }
  EXPECT_THAT(choice_csv(choice), HasSubstr(",not judged,"));
  EXPECT_THAT(choice_csv(choice), Not(HasSubstr(",yes,\"\"")));
}

TEST(Choose, DoesNotHoldALateMachineAgainstALaw) {
  ChooseOptions options = small();
  options.search.deadline = [](const LawFile&) {
    return Deadline{.held = false, .machine_late = true, .why = "700 of 2000 deadlines missed"};
  };
  const LawChoice choice = choose(cut_of(known_kelvin()), options);
  EXPECT_EQ(taken_name(choice), "kelvin");
  EXPECT_TRUE(choice.in_doubt);
  EXPECT_FALSE(choice.serves);
  EXPECT_THAT(choice.why, HasSubstr("700 of 2000 deadlines missed"));
}

TEST(Choose, NamesNoneWhereNoneOfThoseWithinTheJndIsStable) {
  ChooseOptions options = small();
  options.search.stability = [](const LawFile&, const schema::Recording&) { return not_stable("no"); };
  const LawChoice choice = choose(cut_of(known_line()), options);
  EXPECT_FALSE(choice.serves);
  EXPECT_EQ(taken_name(choice), "none");
  EXPECT_THAT(choice.why, HasSubstr("holds its deadlines and is stable"));
}

TEST(Choose, NamesTheBestAndWhatNobodyWouldMissWhereNoneIsWithinTheJnd) {
  ChooseOptions options = small();
  options.fit.jnd = {.weber_fraction = 0.0, .threshold = 0.015};
  const LawChoice choice = choose(cut_of(known_kelvin()), options);
  EXPECT_FALSE(choice.serves);
  EXPECT_THAT(choice.why, HasSubstr("None is within the JND of 0.015 N"));
  const Candidate& best = choice.candidates.at(choice.taken.value());
  for (const Candidate& one : choice.candidates) EXPECT_GE(one.error_n, best.error_n) << one.law.name;
  EXPECT_EQ(choice.candidates.at(choice.as_good.value()).law.name, "kelvin");
  for (const Candidate& one : choice.candidates) {
    EXPECT_THAT(one.why, testing::AnyOf(HasSubstr("JND off"), HasSubstr("worse than the mean")))
        << one.law.name;
  }
}

TEST(Choose, IsTheSameForAnyNumberOfThreads) {
  const schema::Recording recording = cut_of(known_kelvin());
  ChooseOptions options = small();
  const LawChoice one = choose(recording, options);
  options.threads = 4;
  const LawChoice four = choose(recording, options);
  ASSERT_EQ(one.candidates.size(), four.candidates.size());
  for (std::size_t i = 0; i < one.candidates.size(); ++i) {
    EXPECT_EQ(one.candidates[i].law.name, four.candidates[i].law.name);
    EXPECT_EQ(one.candidates[i].error_n, four.candidates[i].error_n);
  }
}

TEST(Choose, FindsTheCurvesOfAllCountsAtOnceAsWellAsOneByOne) {
  const schema::Recording recording = cut_of(known_kelvin());
  ChooseOptions options = small();
  options.fit.jnd = {.weber_fraction = 0.0, .threshold = 1e-3};  // so that every law is fitted both ways
  const LawChoice at_once = choose(recording, options);
  options.richer_too = false;
  const LawChoice one_by_one = choose(recording, options);
  for (const char* name : {"piecewise-1", "piecewise-2", "piecewise-1-loop", "piecewise-2-loop"}) {
    const double error_n = candidate(one_by_one, name).error_n;
    EXPECT_NEAR(candidate(at_once, name).error_n, error_n, 1e-3 * error_n) << name;
  }
}

TEST(Choose, StopsWhereItIsToldTo) {
  const std::atomic<bool> stop{true};
  EXPECT_THROW((void)choose_law(cut_of(known_kelvin()), small(), stop), std::system_error);
}

TEST(Choose, HoldsOutBlocksOfTimeWhereThereAreNoCycles) {
  const LawChoice choice = choose(cut_of(known_kelvin(), {.with_cycles = false}));
  EXPECT_EQ(choice.held_out, "5 folds of blocks of time, held out by turns");
  EXPECT_THAT(choice.warnings, Contains(HasSubstr("kerf segment")));
  EXPECT_EQ(taken_name(choice), "kelvin");
}

TEST(Choose, RefusesWhatHasNoForceNoAxisOrNoFolds) {
  schema::Recording recording = cut_of(known_kelvin());
  const auto refusal = [&](const ChooseOptions& options) -> std::string {
    try {
      (void)choose(recording, options);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "none";
  };
  ChooseOptions options = small();
  options.axis = 1;
  EXPECT_THAT(refusal(options), HasSubstr("no such axis"));
  options = small();
  options.fit.folds = 1;
  EXPECT_THAT(refusal(options), HasSubstr("2 folds"));
  recording.force_measured.clear();
  EXPECT_THAT(refusal(small()), HasSubstr("no force"));
  recording.force_measured.assign(recording.rows(), 0.0);
  EXPECT_THAT(refusal(small()), HasSubstr("zero throughout"));
  for (std::size_t row = 0; row < recording.rows(); ++row)
    recording.force_measured[row] = 0.004 * std::sin(static_cast<double>(row));
  EXPECT_THAT(refusal(small()), HasSubstr("nothing to choose by")) << "a force of zero is within the JND too";
}

TEST(EffectsThatMatter, AreThoseOfTheLawThatIsKnown) {
  const LawChoice relaxing = choose(cut_of(known_kelvin()));
  EXPECT_EQ(matter_of(relaxing, Effect::relaxation), Matter::matters);
  EXPECT_EQ(matter_of(relaxing, Effect::stiffening), Matter::does_not);
  const LawChoice elastic = choose(cut_of(known_line()));
  for (const EffectVerdict& verdict : elastic.effects)
    EXPECT_EQ(verdict.matter, Matter::does_not) << name_of(verdict.effect);
  const LawChoice stiff =
      choose(cut_of(models::Law::make("exponential", std::array{0.2, 0.7, 0.3}, {{"thickness", 0.1}})));
  EXPECT_EQ(matter_of(stiff, Effect::stiffening), Matter::matters);
}

TEST(EffectsThatMatter, AreNotKnownWhereNoLawComesNear) {
  const auto candidate = [](const char* name, const Effects& effects, double error_jnd) {
    Candidate one{
        .law = {.name = name, .model = name, .law_options = {}, .parameters = 2, .effects = effects},
        .file = LawFile{.law = models::Law::make("kelvin", std::array{1.0, 1.0, 1.0}),
                        .contact = {},
                        .axis = "x",
                        .fit = {}}};
    one.converged = true;
    one.error_n = one.error_jnd = error_jnd;
    one.within_jnd = error_jnd <= 1.0;
    return one;
  };
  const auto verdict = [&](double without, double with) {
    const std::vector candidates{candidate("plain", {}, without), candidate("cuts", {Effect::cutting}, with)};
    return judge_effects(candidates, std::nullopt, 1.0).at(0).matter;
  };
  EXPECT_EQ(verdict(5.5, 10.0), Matter::not_known);
  EXPECT_EQ(verdict(5.5, 5.45), Matter::not_known);
  EXPECT_EQ(verdict(5.5, 0.9), Matter::matters);
  EXPECT_EQ(verdict(5.5, 2.0), Matter::matters) << "it mends more than a JND";
  EXPECT_EQ(verdict(0.9, 10.0), Matter::does_not);
}

TEST(EffectsThatMatter, AreAllInTheLawThatIsTaken) {
  for (const test::KnownLaw& known : test::known_laws()) {
    const LawChoice choice = choose(cut_of(known.law));
    if (!choice.serves) continue;
    const Effects& has = choice.candidates.at(*choice.taken).law.effects;
    for (const EffectVerdict& verdict : choice.effects) {
      if (verdict.matter == Matter::replaceable) continue;
      EXPECT_EQ(has.contains(verdict.effect), verdict.matter == Matter::matters) << known.name;
    }
  }
}

TEST(LeftOut, IsTheErrorThatABetterLawDoesNotMake) {
  EXPECT_DOUBLE_EQ(fitting::left_out(5.0, 3.0), 4.0);
  EXPECT_EQ(fitting::left_out(3.0, 5.0), 0.0);
  EXPECT_EQ(fitting::left_out(std::numeric_limits<double>::infinity(), 1.0),
            std::numeric_limits<double>::infinity());
}

TEST(ChoiceFiles, HoldEveryCandidate) {
  const LawChoice choice = choose(cut_of(known_kelvin()));
  const auto json = choice_as_json(choice);
  EXPECT_EQ(json.at("candidates").size(), choice.candidates.size());
  EXPECT_EQ(json.at("choice").at("law"), "kelvin");
  EXPECT_NEAR(json.at("choice").at("parameters").at("parallel_stiffness").at("value").get<double>(), 5.0,
              0.2);
  const std::string csv = choice_csv(choice);
  EXPECT_EQ(static_cast<std::size_t>(std::ranges::count(csv, '\n')), choice.candidates.size() + 1);
}

}  // namespace
}  // namespace kerf::bench
