#include "clocks/marker_fit.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <kerf/schema/recording.h>

#include "support/program.h"

namespace kerf::bench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(Markers, AreWhereTheChannelRisesThroughTheLevel) {
  const ClockedSeries ramp{.time_s = {0, 1, 2, 3, 4, 5, 6}, .values = {0, 1, 4, 3.7, 4, 0, 3}};
  EXPECT_THAT(markers_of(ramp, {.channel = "x", .level = 1.75, .has_level = true}).time_s,
              ElementsAre(1.5, 5.5))
      << "steps of three of four: in the middle";
  const ClockedSeries slow{.time_s = {0, 1, 2, 3, 4}, .values = {0, 1, 2, 3, 4}};
  EXPECT_THAT(markers_of(slow, {.channel = "x", .level = 2.25, .has_level = true}).time_s, ElementsAre(2.25));
  const ClockedSeries trembling{.time_s = {0, 1, 2, 3, 4, 5}, .values = {0, 4, 1.9, 2.1, 1.8, 4}};
  EXPECT_EQ(markers_of(trembling, {.channel = "x"}).time_s.size(), 1U) << "it was not below by a tenth";
  EXPECT_THAT(
      [&] { (void)markers_of(slow, {.channel = "x", .level = 7.0, .has_level = true}); },
      ThrowsMessage<std::invalid_argument>(HasSubstr("'x' never rises through 7; it goes from 0 to 4")));
}

TEST(Markers, AreWhereTheChannelFallsIfThatIsAskedFor) {
  const ClockedSeries pulse{.time_s = {0, 1, 2, 3, 4, 5, 6, 7}, .values = {5, 5, 4, 1, 0, 5, 5, 2}};
  EXPECT_THAT(markers_of(pulse, {.channel = "x", .falls = true, .level = 4.5, .has_level = true}).time_s,
              ElementsAre(1.5, 6.5))
      << "on a line, and in the middle of a step of more than half";
  EXPECT_THAT(
      [&] { (void)markers_of(pulse, {.channel = "x", .falls = true, .level = -1.0, .has_level = true}); },
      ThrowsMessage<std::invalid_argument>(HasSubstr("'x' never falls through -1; it goes from 0 to 5")));
  EXPECT_TRUE(parse_markers("x<2.5")[0].falls);
  EXPECT_EQ(parse_markers("x<2.5,y>-1")[0].level, 2.5);
  EXPECT_FALSE(parse_markers("x<2.5,y>-1")[1].falls);
}

TEST(Markers, AreReadOfWords) {
  const auto rules = parse_markers("trigger > 2.5,sync");
  EXPECT_EQ(rules[0].channel, "trigger");
  EXPECT_EQ(rules[0].level, 2.5);
  EXPECT_EQ(rules[1].channel, "sync");
  EXPECT_FALSE(rules[1].has_level);
  EXPECT_EQ(parse_markers("sync").size(), 2U);
  for (const auto* bad : {"", "x>", "x<", "x>2V", ">2", "x>1,"})
    EXPECT_THROW((void)parse_markers(bad), std::invalid_argument) << bad;
}

TEST(MarkerFit, IsTheLineOfLeastSquares) {
  // numpy.polyfit(other, first, 1) gives 1.0005033922946445, 3.2015362248606714; residuals of 0.02 s and
  // less.
  const Markers first{.time_s = {4.2, 7.21, 13.20, 33.22, 52.225}, .period_s = 0.02};
  const Markers other{.time_s = {1.0, 4.0, 10.0, 30.0, 49.0}, .period_s = 0.02};
  const ClockFit fit = fit_markers(first, other);
  EXPECT_EQ(fit.markers, 5U);
  EXPECT_NEAR(fit.skew, 1.0005033922946445 - 1.0, 1e-12);
  EXPECT_NEAR(fit.shift_s, 3.2015362248606714, 1e-12);
  const double sigma = std::sqrt(2.0 * 0.02 * 0.02 / 12.0);
  EXPECT_NEAR(fit.skew_error, sigma / std::sqrt(1650.8000000000002), 1e-12)
      << "the steps say more than the residuals";
}

TEST(MarkerFit, CoversTheTruthInNineteenOfTwenty) {
  constexpr int times = 200;
  int shifts = 0;
  int skews = 0;
  std::mt19937 random(20261126);
  std::uniform_real_distribution<double> moment(0.0, 60.0);
  for (int i = 0; i < times; ++i) {
    std::vector<double> events;
    for (int k = 0; k < 6; ++k) events.push_back(moment(random));
    std::ranges::sort(events);
    Markers first{.time_s = {}, .period_s = 0.01};
    Markers other{.time_s = {}, .period_s = 0.004};
    for (const double t : events) {  // each clock tells the middle of the step in which it lies
      first.time_s.push_back((std::floor((t + 2.5) / 0.01) + 0.5) * 0.01);
      other.time_s.push_back((std::floor(t / 1.0003 / 0.004) + 0.5) * 0.004);
    }
    const ClockFit fit = fit_markers(first, other);
    shifts += std::abs(fit.shift_s - 2.5) < fit.t95 * fit.shift_error_s ? 1 : 0;
    skews += std::abs(fit.skew - 3e-4) < fit.t95 * fit.skew_error ? 1 : 0;
  }
  // Of 200 intervals of 95 % fewer than 180 hold the truth by chance once in 1,000 times.
  EXPECT_GE(shifts, 180) << "of " << times;
  EXPECT_GE(skews, 180) << "of " << times;
  EXPECT_LT(shifts, 200) << "else the intervals are too wide to tell";
}

TEST(MarkerFit, FindsWhereAShorterFileBegan) {
  const Markers whole{.time_s = {1.0, 3.5, 9.1, 11.0, 20.4, 31.2}, .period_s = 0.01};
  const Markers part{.time_s = {0.1, 2.0, 11.4}, .period_s = 0.01};
  EXPECT_NEAR(fit_markers(whole, part).shift_s, 9.0, 1e-9);
  EXPECT_NEAR(fit_markers(part, whole).shift_s, -9.0, 1e-9);
}

/// Twelve events, and what two clocks tell of them: each misses two, and has two that are none.
struct Missed {
  explicit Missed(std::mt19937& random) {
    std::uniform_real_distribution<double> moment(0.0, 60.0);
    std::vector<double> events(12);
    for (double& t : events) t = moment(random);
    std::ranges::shuffle(events, random);
    for (std::size_t k = 0; k < events.size(); ++k) {
      if (k != 0 && k != 1) first.time_s.push_back(by_first(events[k]));
      if (k != 2 && k != 3) other.time_s.push_back(by_other(events[k]));
    }
    for (int k = 0; k < 2; ++k) {
      first.time_s.push_back(by_first(moment(random)));
      other.time_s.push_back(by_other(moment(random)));
    }
    std::ranges::sort(first.time_s);
    std::ranges::sort(other.time_s);
  }
  static double by_first(double t) { return (std::floor((t + 2.5) / 0.01) + 0.5) * 0.01; }
  static double by_other(double t) { return (std::floor(t / 1.0003 / 0.004) + 0.5) * 0.004; }

  Markers first{.time_s = {}, .period_s = 0.01};
  Markers other{.time_s = {}, .period_s = 0.004};
};

TEST(MarkerFit, GoesByThoseThatBothHave) {
  std::mt19937 random(20261127);
  constexpr int times = 200;
  int found = 0;
  int shifts = 0;
  for (int i = 0; i < times; ++i) {
    const Missed drawn(random);
    try {
      const ClockFit fit = fit_markers(drawn.first, drawn.other);
      ++found;
      EXPECT_GE(fit.markers, 8U) << i;
      EXPECT_NEAR(fit.shift_s, 2.5, 0.02) << i << ": never another alignment than the true one";
      shifts += std::abs(fit.shift_s - 2.5) < fit.t95 * fit.shift_error_s ? 1 : 0;
    } catch (const std::invalid_argument&) {  // it may say that it does not know
    }
  }
  EXPECT_GE(found, 195) << "of " << times;
  // Of 195 intervals of 95 % fewer than 176 hold the truth by chance once in 1,000 times.
  EXPECT_GE(shifts, 176) << "of " << found;
}

TEST(MarkerFit, TellsNothingOfMarkersThatHaveNothingInCommon) {
  std::mt19937 random(20261128);
  std::uniform_real_distribution<double> moment(0.0, 60.0);
  int taken = 0;
  for (int i = 0; i < 200; ++i) {
    Markers first{.time_s = std::vector<double>(10), .period_s = 0.01};
    Markers other{.time_s = std::vector<double>(10), .period_s = 0.004};
    for (Markers* markers : {&first, &other}) {
      for (double& t : markers->time_s) t = moment(random);
      std::ranges::sort(markers->time_s);
    }
    try {
      (void)fit_markers(first, other);
      ++taken;
    } catch (const std::invalid_argument&) {
    }
  }
  EXPECT_EQ(taken, 0);
}

TEST(MarkerFit, NamesThoseThatOneFileHasAlone) {
  const Markers whole{.time_s = {1.0, 3.5, 9.1, 11.0, 20.4, 31.2}, .period_s = 0.01};
  const Markers missed{.time_s = {11.0, 13.5, 16.2, 21.0, 30.4, 41.2}, .period_s = 0.01};
  const ClockFit fit = fit_markers(whole, missed);
  EXPECT_EQ(fit.markers, 5U);
  EXPECT_NEAR(fit.shift_s, -10.0, 1e-9);
  EXPECT_THAT(fit.first_alone_s, ElementsAre(9.1));
  EXPECT_THAT(fit.other_alone_s, ElementsAre(16.2));
  const Markers part{.time_s = {0.1, 2.0, 11.4}, .period_s = 0.01};
  EXPECT_THAT(fit_markers(whole, part).first_alone_s, testing::IsEmpty()) << "they lie outside of the other";
}

TEST(MarkerFit, SaysHowManyThereAreAndWhichFitNone) {
  const Markers first{.time_s = {1, 2, 4, 8}, .period_s = 0.01};
  const Markers other{.time_s = {1, 3, 4, 8}, .period_s = 0.01};
  EXPECT_THAT(
      [&] { (void)fit_markers(first, other); },
      ThrowsMessage<std::invalid_argument>(HasSubstr(
          "4 markers in the first file and 4 in the other do not fit each other: 3 at most lie together to "
          "within 0.04 s, of the first not those at 2 s, of the other not those at 3 s, and 2 with another "
          "shift")));
}

TEST(MarkerFit, RefusesWhatDoesNotTell) {
  const auto refused = [](const std::vector<double>& a, const std::vector<double>& b, const char* why) {
    EXPECT_THAT([&] { (void)fit_markers({.time_s = a, .period_s = 0.01}, {.time_s = b, .period_s = 0.01}); },
                ThrowsMessage<std::invalid_argument>(HasSubstr(why)));
  };
  refused({1, 2, 3, 4}, {11, 12, 13}, "2 shifts serve alike");
  refused({1, 2, 3, 4}, {1}, "4 shifts serve alike");
  refused({1, 2, 4, 8}, {1, 3, 4, 8}, "do not fit each other");
  refused({1, 2}, {1, 3}, "do not fit each other");
}

TEST(JoinByMarker, BringsAForceToAMotion) {
  const test::TemporaryFolder folder;
  std::string motion = "t,x,sync\n";
  std::string forces = "t,F,trigger\n";
  const auto is_high = [](double t) { return (t > 2.0 && t < 2.2) || (t > 7.3 && t < 7.5) ? 5 : 0; };
  for (int i = 0; i < 1000; ++i) {
    const double t = 0.01 * i;
    motion += fmt::format("{},{},{}\n", 50.0 + t, t, is_high(t));
    const double of_both = 0.4 + 1.0002 * 0.005 * i;  // by the clock of the motion
    forces += fmt::format("{},{},{}\n", 0.005 * i, of_both, is_high(of_both));
  }
  for (int i = 1000; i < 1800; ++i) {
    const double of_both = 0.4 + 1.0002 * 0.005 * i;
    forces += fmt::format("{},{},{}\n", 0.005 * i, of_both, is_high(of_both));
  }
  test::write_text(folder / "motion.csv", motion);
  test::write_text(folder / "forces.csv", forces);
  const auto join = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{
        "import", (folder / "motion.csv").string(), "--map",      "time=t[s],position=x[mm],sync=sync[V]",
        "--join", (folder / "forces.csv").string(), "--join-map", "time=t[s],force=F[N],trigger=trigger[V]",
        "-o",     (folder / "r.h5").string(),       "--json",     "--force"};
    words.insert(words.end(), more.begin(), more.end());
    return test::run_kerf(words);
  };
  const auto outcome = join({"--join-marker", "sync>2.5,trigger>1"});
  ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
  const auto json = nlohmann::json::parse(outcome.output).at("join");
  EXPECT_EQ(json.at("markers"), 2);
  EXPECT_NEAR(json.at("shift_s").get<double>(), 0.4, 0.01);
  EXPECT_TRUE(json.at("correlation").is_null()) << "nothing was correlated";
  EXPECT_GT(json.at("skew_std_error").get<double>(), 1e-5);
  const auto recording = schema::read_recording(folder / "r.h5");
  EXPECT_NEAR(recording.force_measured[500], 5.0, 0.015);
  EXPECT_THAT(recording.header.history, HasSubstr("by 2 markers of sync"));

  // By the falls, the same to within a step.
  const auto falling = join({"--join-marker", "sync<2.5,trigger<1"});
  ASSERT_EQ(falling.exit_status, 0) << falling.errors;
  EXPECT_NEAR(nlohmann::json::parse(falling.output).at("join").at("shift_s").get<double>(), 0.4, 0.01);

  EXPECT_THAT(join({"--join-marker", "sync>9,trigger"}).errors,
              HasSubstr("--map: --join-marker: 'sync' never"));
  EXPECT_THAT(join({"--join-marker", "sync"}).errors, HasSubstr("names a channel that its map does not"));
  EXPECT_THAT(join({"--join-marker", "sync,trigger", "--join-on", "time"}).errors, HasSubstr("two ways"));
}

TEST(JoinByMarker, SaysWhichPulseOneFileHasAlone) {
  const test::TemporaryFolder folder;
  const std::vector<double> pulses{1.0, 2.7, 3.3, 6.1, 8.4, 9.0};
  const auto is_high = [&](double t, double missed) {
    return std::ranges::any_of(pulses, [&](double at) { return at != missed && t >= at && t < at + 0.1; })
               ? 5
               : 0;
  };
  std::string motion = "t,x,sync\n";
  std::string forces = "t,F,trigger\n";
  for (int i = 0; i < 1000; ++i) {
    const double t = 0.01 * i;
    motion += fmt::format("{:.2f},{:.2f},{}\n", t, t, is_high(t, 6.1));
    forces += fmt::format("{:.2f},{:.2f},{}\n", t + 20.0, t, is_high(t, 0.0));
  }
  test::write_text(folder / "motion.csv", motion);
  test::write_text(folder / "forces.csv", forces);
  const auto outcome = test::run_kerf(
      {"import", (folder / "motion.csv").string(), "--map", "time=t[s],position=x[mm],sync=sync[V]", "--join",
       (folder / "forces.csv").string(), "--join-map", "time=t[s],force=F[N],trigger=trigger[V]",
       "--join-marker", "sync>2.5,trigger>2.5", "-o", (folder / "r.h5").string(), "--json"});
  ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
  EXPECT_THAT(
      outcome.errors,
      HasSubstr("1 of the other file's markers, at 6.095 s after its first row, is not in the first"));
  const auto json = nlohmann::json::parse(outcome.output).at("join");
  EXPECT_EQ(json.at("markers"), 5);
  EXPECT_EQ(json.at("markers_of_other_alone_s").size(), 1U);
}

}  // namespace
}  // namespace kerf::bench
