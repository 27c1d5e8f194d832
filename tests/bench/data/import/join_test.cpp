#include "import/join.h"

#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "clocks/clock_fit.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// Numbers between -1 and 1 that look random (Knuth's MMIX).
class Noise {
 public:
  explicit Noise(std::uint64_t seed) : state_(seed) {}
  double operator()() {
    state_ = state_ * 6364136223846793005U + 1442695040888963407U;
    return static_cast<double>(state_ >> 11U) / 4503599627370496.0 - 1.0;
  }

 private:
  std::uint64_t state_;
};

/// A hand that wanders: sines whose periods have no common one.
double wandering(double t) {
  return std::sin(0.9 * t) + 0.7 * std::sin(2.3 * t + 1.0) + 0.5 * std::sin(std::numbers::pi * t + 2.0) +
         0.3 * std::sin(5.1 * t + 0.4);
}

ClockedSeries seen(double from_s, double rate_hz, std::size_t rows,
                   const std::function<double(double)>& motion) {
  ClockedSeries series;
  for (std::size_t i = 0; i < rows; ++i) {
    series.time_s.push_back(from_s + static_cast<double>(i) / rate_hz);
    series.values.push_back(motion(series.time_s.back()));
  }
  return series;
}

TEST(ClockFit, FindsShiftAndSkewOfACleanMotion) {
  const ClockFit fit = fit_clock(seen(0.0, 100.0, 3000, wandering), seen(0.0, 70.0, 1400, [](double t) {
                                   return 2.0 * wandering(4.321 + (1.0 - 7e-4) * t) - 5.0;
                                 }));
  EXPECT_NEAR(fit.shift_s, 4.321, 2e-5);
  EXPECT_NEAR(fit.skew, -7e-4, 2e-6);
  EXPECT_GT(fit.correlation, 0.99999);
}

TEST(ClockFit, CoversTheTruthInNineteenOfTwenty) {
  constexpr int times = 60;
  int shifts = 0;
  int skews = 0;
  for (int i = 0; i < times; ++i) {
    Noise noise(static_cast<std::uint64_t>(i) + 1);
    const double shift_s = 2.0 + 0.0137 * i;
    const auto noisy = [&](double value) { return value + 0.05 * (noise() + noise() + noise()); };
    const ClockedSeries first = seen(0.0, 50.0, 900, [&](double t) { return noisy(wandering(t)); });
    const ClockedSeries other =
        seen(0.0, 50.0, 600, [&](double t) { return noisy(wandering(shift_s + (1.0 + 3e-4) * t)); });
    const ClockFit fit = fit_clock(first, other);
    shifts += std::abs(fit.shift_s - shift_s) < clock_t95 * fit.shift_error_s ? 1 : 0;
    skews += std::abs(fit.skew - 3e-4) < clock_t95 * fit.skew_error ? 1 : 0;
    EXPECT_LT(fit.shift_error_s, 0.01);
  }
  // Of 60 intervals of 95 % fewer than 51 hold the truth by chance once in 2,000 times.
  EXPECT_GE(shifts, 51) << "of " << times;
  EXPECT_GE(skews, 51) << "of " << times;
  RecordProperty("shifts", shifts);
  RecordProperty("skews", skews);
}

TEST(ClockFit, RefusesWhatDoesNotTell) {
  const auto circling = [](double t) { return std::sin(2.0 * std::numbers::pi * t); };
  EXPECT_THAT([&] { (void)fit_clock(seen(0.0, 50.0, 1000, circling), seen(0.3, 50.0, 500, circling)); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("serve alike")));
  Noise one(1);
  Noise two(2);
  EXPECT_THAT(
      [&] {
        (void)fit_clock(seen(0.0, 50.0, 1000, [&](double) { return one(); }),
                        seen(0.0, 50.0, 1000, [&](double) { return two(); }));
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("nothing in common")));
  const auto still = [](double) { return 1.0; };
  EXPECT_THROW((void)fit_clock(seen(0.0, 50.0, 1000, still), seen(0.0, 50.0, 1000, wandering)),
               std::invalid_argument);
  EXPECT_THAT([&] { (void)fit_clock(seen(0.0, 50.0, 10, wandering), seen(0.0, 50.0, 1000, wandering)); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("expected 64 and more")));
}

std::filesystem::path made(const std::string& name) {
  return std::filesystem::path(KERF_SOURCE_DIR) / "tests/bench/data/clocks/files" / name;
}

TEST(Join, BringsTwoClocksTogetherAsSciPyDoes) {
  const ImportOptions options{.map = parse_map("time=t_s,position=x_mm")};
  Imported imported = import_text(made("motion.csv"), options);
  const Joined joined = join(
      imported,
      {.file = made("forces.csv"), .map = parse_map("time=t_s,position=wire_mm,force=F_N"), .on = "position"},
      options);
  // files/make.py: SciPy's least squares give 3.21711 +- 0.00029 s and 420.7 +- 32.0 ppm.
  EXPECT_NEAR(joined.clock.shift_s, 3.21711, 1.5e-4);
  EXPECT_NEAR(joined.clock.skew, 420.7e-6, 16e-6);
  EXPECT_NEAR(joined.clock.shift_s, 3.2174, clock_t95 * joined.clock.shift_error_s) << "the truth";
  EXPECT_NEAR(joined.clock.skew, 400e-6, clock_t95 * joined.clock.skew_error);
  EXPECT_LT(joined.clock.shift_error_s, 1e-3);
  const schema::Recording& recording = imported.recording;
  ASSERT_EQ(recording.force_measured.size(), 1200U);
  EXPECT_EQ(joined.rows_without, 450U) << "15 of 24 s";
  EXPECT_TRUE(std::isnan(recording.force_measured[100]));
  for (std::size_t row = 200; row < 800; ++row) {
    const double x = 1e3 * recording.position[row];
    EXPECT_NEAR(recording.force_measured[row], 0.4 + 0.15 * x + 0.02 * x * x, 0.12)
        << row;  // noise of x: 0.05 mm
  }
  EXPECT_THAT(recording.header.history, HasSubstr("join: force_measured of forces.csv, by position"));
  EXPECT_THAT(joined.warnings, testing::Contains(HasSubstr("450 of 1200 rows lie where it has nothing")));
}

class JoinProgram : public testing::Test {
 protected:
  JoinProgram() {
    test::write_text(folder_ / "a.csv", "t,x\n10,1\n11,2\n12,3\n13,4\n");
    test::write_text(folder_ / "b.csv", "t,F\n10.5,1\n11.5,2\n12.5,3\n");
  }
  test::Outcome join(const std::string& on, const std::string& map = "time=1[s],force=2[N],spare=2[1]",
                     const std::string& more = "--json") {
    return test::run_kerf({"import", (folder_ / "a.csv").string(), "--map", "time=1[s],position=2[mm]",
                           "--join", (folder_ / "b.csv").string(), "--join-map", map, "--join-on", on, "-o",
                           (folder_ / "r.h5").string(), more});
  }
  test::TemporaryFolder folder_;
};

TEST_F(JoinProgram, TakesASharedTimeAsItStands) {
  const auto outcome = join("time");
  ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
  const auto json = nlohmann::json::parse(outcome.output).at("join");
  EXPECT_EQ(json.at("shift_s"), 0.5);
  EXPECT_TRUE(json.at("shift_std_error_s").is_null()) << "nobody has measured it";
  EXPECT_EQ(json.at("rows_without"), 2);
  const auto recording = schema::read_recording(folder_ / "r.h5");
  EXPECT_THAT(recording.force_measured, ElementsAre(testing::IsNan(), 1.5, 2.5, testing::IsNan()));
  ASSERT_EQ(recording.channels.size(), 1U);
  EXPECT_EQ(recording.channels[0].values[1], 1.5);
}

TEST_F(JoinProgram, TakesTheOtherFileFromAPipeAndByAnImportFile) {
  test::write_text(folder_ / "b.csv",
                   "# a stretch that was a trial\n0,9\n1,9\n2,9\n3,9\n4,9\n5,9\n6,9\n7,9\n"
                   "8,9\n9,9\n10,9\n0,1\n1,2\n2,3\n3,4\n4,5\n5,6\n6,7\n7,8\n8,9\n9,9\n10,9\n");
  test::write_text(folder_ / "forces.import.toml", "map = \"time=1[s],force=2[N]\"\nstretch = 2\n");
  const auto piped = [&](const std::string& first, const std::string& how) {
    return test::run(
        {"/bin/bash", "-c",
         fmt::format("cat {} | {} import {} --map 'time=1[s],position=2[mm]' --join - --join-map {} "
                     "--join-on time -o {} --force",
                     (folder_ / "b.csv").string(), KERF_PROGRAM, first, how, (folder_ / "r.h5").string())});
  };
  test::write_text(folder_ / "motion.csv", "0,1\n1,2\n2,3\n");
  const std::string file = (folder_ / "forces.import.toml").string();
  const auto outcome = piped((folder_ / "motion.csv").string(), file);
  ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
  EXPECT_THAT(schema::read_recording(folder_ / "r.h5").force_measured, ElementsAre(1.0, 2.0, 3.0))
      << "the second stretch, as its file says";
  EXPECT_THAT(piped("-", file).errors, HasSubstr("standard input, which is read once"));
  EXPECT_THAT(piped((folder_ / "motion.csv").string(), "force").errors,
              HasSubstr("--join-map: 'force' has no '='"));
  EXPECT_THAT(
      test::run_kerf({"import", (folder_ / "motion.csv").string(), "--map", "time=1[s],position=2[mm]",
                      "--join-on", "time", "-o", (folder_ / "x.h5").string()})
          .errors,
      HasSubstr("expected --join FILE"));
}

TEST_F(JoinProgram, TakesStampsOfOneClock) {
  test::write_text(folder_ / "a.csv",
                   "2026-01-31T12:00:00Z,1\n2026-01-31T12:00:01Z,2\n2026-01-31T12:00:02Z,3\n");
  test::write_text(folder_ / "b.csv", "2026-01-31T13:59:59.5+02:00,1\n2026-01-31T14:00:01.5+02:00,5\n");
  const auto stamped = [&] {
    return test::run_kerf({"import", (folder_ / "a.csv").string(), "--map", "time=1,position=2[mm]", "--join",
                           (folder_ / "b.csv").string(), "--join-map", "time=1,force=2[N]", "--join-on",
                           "time", "-o", (folder_ / "r.h5").string(), "--force"});
  };
  ASSERT_EQ(stamped().exit_status, 0);
  EXPECT_THAT(schema::read_recording(folder_ / "r.h5").force_measured,
              ElementsAre(2.0, 4.0, testing::IsNan()));
  test::write_text(folder_ / "b.csv", "2026-01-31T13:59:59.5,1\n2026-01-31T14:00:01.5,5\n");
  const auto refused = stamped();
  EXPECT_EQ(refused.exit_status, 2);
  EXPECT_THAT(refused.errors, HasSubstr("expected times of one clock"));
}

TEST(Join, RefusesAxesInSpace) {
  ImportOptions options;
  options.rate_hz = 100.0;
  Imported imported;
  imported.spatial.emplace();
  EXPECT_THAT([&] { (void)join(imported, {.file = "forces.csv", .map = {}, .on = "position"}, options); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("axes in space")));
}

TEST_F(JoinProgram, RefusesWhatMakesNoSense) {
  EXPECT_THAT(join("").errors, HasSubstr("--join-on is needed"));
  EXPECT_THAT(join("spare").errors, HasSubstr("names a channel that its map does not"));
  EXPECT_THAT(join("time", "time=1[s],position=2[mm]").errors, HasSubstr("position is mapped in both files"));
  EXPECT_THAT(join("time", "time=1[s]").errors, HasSubstr("nothing but a time"));
  EXPECT_THAT(join("position", "time=1[s],position=2[mm]").errors, HasSubstr("expected 64 and more"));
  test::write_text(folder_ / "b.csv", "t,F\n100,1\n101,2\n");
  EXPECT_THAT(join("time").errors, HasSubstr("it has nothing at the times of the first file"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "r.h5"));
}

}  // namespace
}  // namespace kerf::bench
