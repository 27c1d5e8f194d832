#include "inspect/inspection.h"

#include <limits>
#include <map>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "import/import.h"
#include "inspect/inspection_text.h"
#include "support/measured_data.h"
#include "support/program.h"
#include "support/recordings.h"

namespace kerf::bench {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

Inspection inspected(const schema::Recording& recording, double felt = 0.05) {
  return inspect(schema::RowsInMemory(recording), {.felt = felt});
}

const InspectedSignal& signal_of(const Inspection& inspection, const std::string& name) {
  for (const InspectedSignal& signal : inspection.signals) {
    if (signal.name == name) return signal;
  }
  throw std::out_of_range(name);
}

TEST(Inspection, OfASoundRecordingHasNothingToSay) {
  test::Tissue tissue;
  tissue.noise_n = 0.01;
  const Inspection inspection = inspected(test::punch(tissue));
  const InspectedSignal& force = signal_of(inspection, "force_measured");
  EXPECT_NEAR(force.facts.noise.value(), 0.01, 0.001);
  EXPECT_EQ(force.facts.outliers, 0U);
  EXPECT_EQ(force.facts.quantum, std::nullopt);
  EXPECT_THAT(warnings_of(inspection), Not(Contains(HasSubstr("clipped"))));
}

TEST(Inspection, FindsASensorAtItsEndAndRowsThatReadRubbish) {
  test::Tissue tissue;
  tissue.limit_n = 1.0;
  tissue.bad_every = 500;
  tissue.bad_force_n = -6.0;
  const Inspection inspection = inspected(test::punch(tissue));
  const InspectedSignal& force = signal_of(inspection, "force_measured");
  EXPECT_EQ(force.ends.most.value, 1.0);
  EXPECT_EQ(force.ends.most.is_clipped, true);
  EXPECT_EQ(force.facts.outliers, 7U) << "the eighth is the last row, which has one neighbour";
  EXPECT_THAT(warnings_of(inspection), Contains(HasSubstr("at its largest value, 1 N")));
}

TEST(Inspection, SaysThatABiasLeavesNoRowIdle) {
  schema::Recording recording = test::punch();
  for (double& force : recording.force_measured) force += 3.0;
  const Inspection inspection = inspected(recording);
  EXPECT_THAT(warnings_of(inspection), Contains(HasSubstr("no row is idle")));
  EXPECT_FALSE(signal_of(inspection, "force_measured").drift);
}

TEST(Inspection, KnowsNothingOfContactWithoutAForce) {
  schema::Recording recording = test::punch();
  recording.force_measured.clear();
  const Inspection inspection = inspected(recording);
  EXPECT_FALSE(inspection.contact);
  const auto json = inspection_as_json(inspection);
  EXPECT_TRUE(json["contact"].is_null());
  EXPECT_TRUE(json["lag"].is_null());
  EXPECT_THAT(warnings_of(inspection), Contains(HasSubstr("there is no force")));
}

TEST(Inspection, OfRowsThatAreNotFiniteAndOfNone) {
  schema::Recording recording = test::punch();
  recording.force_measured[100] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(warnings_of(inspected(recording)), Contains(HasSubstr("is not finite in 1 rows")));
  const schema::Recording empty = test::punch({.seconds = 0.0});
  const auto json = inspection_as_json(inspected(empty));
  EXPECT_EQ(json["rows"], 0);
  EXPECT_TRUE(json["sampling"]["true_rate_hz"].is_null());
  EXPECT_TRUE(json["signals"].empty());
  EXPECT_TRUE(json["contact"].is_null());
}

TEST(Inspection, HoldsAVelocityThatWasRecordedAgainstThePosition) {
  schema::Recording recording = test::punch({});
  recording.header.velocity_derived.clear();
  EXPECT_THAT(warnings_of(inspected(recording)), Not(Contains(HasSubstr("dx/dt"))));
  for (double& velocity : recording.velocity) velocity = -velocity;
  EXPECT_THAT(warnings_of(inspected(recording)), Contains(HasSubstr("of dx/dt: turned sign")));
  recording.header.velocity_derived = "from the position";
  EXPECT_THAT(warnings_of(inspected(recording)), Not(Contains(HasSubstr("dx/dt"))))
      << "nobody has recorded it";
}

TEST(Inspection, CallsTheWorkOfACycleAnEnergyOnlyWhereItIsOne) {
  schema::Recording recording = test::punch({.seconds = 8.0});
  EXPECT_EQ(inspection_as_json(inspected(recording))["cycles"]["work_unit"], "J");
  EXPECT_THAT(inspection_lines(inspected(recording)), Contains(HasSubstr("work J")));
  recording.axes[0].position_unit = "rad";
  EXPECT_EQ(inspection_as_json(inspected(recording))["cycles"]["work_unit"], "N·rad");
  EXPECT_THAT(inspection_lines(inspected(recording)), Contains(HasSubstr("work N·rad")));
}

TEST(InspectVerb, PrintsOneJsonObjectOrATable) {
  const test::TemporaryFolder folder;
  const std::string file = (folder / "r.h5").string();
  schema::write_recording(file, test::punch());
  const auto outcome = test::run_kerf({"inspect", file, "--json"});
  ASSERT_EQ(outcome.exit_status, 0) << outcome.errors;
  const auto json = nlohmann::json::parse(outcome.output);
  EXPECT_EQ(json["axis"], "z");
  EXPECT_EQ(json["contact"]["felt"], 0.05);
  EXPECT_TRUE(json["signals"]["force_measured"]["quantum"].is_null());
  const auto table = test::run_kerf({"inspect", file});
  EXPECT_THAT(table.output, HasSubstr("force_measured"));
  EXPECT_THAT(table.output, HasSubstr("4000 rows over 3.999 s at 1000 Hz"));
  const auto wrong = test::run_kerf({"inspect", file, "--axis", "q"});
  EXPECT_EQ(wrong.exit_status, 2);
  EXPECT_THAT(wrong.errors, HasSubstr("no axis 'q'"));
}

// Numbers of NumPy on the same files: counts by hand, noise by the residuals of a cubic over seven rows.

class InspectedPunch : public testing::Test {
 protected:
  static Inspection of(const std::string& name) {
    return inspected(import_text(test::measured_file("meniscus/" + name + ".txt"),
                                 {.map = parse_map("time=5[ms],position=4[deg],force=2[gf]")})
                         .recording);
  }
};

TEST_F(InspectedPunch, HasItsClippedRowsAndItsDeadZone) {  // finding L3
  KERF_NEEDS_DATA("meniscus/14_quadriceps_tendon_fast_1853.txt");
  const Inspection punch = of("14_quadriceps_tendon_fast_1853");
  const InspectedSignal& force = signal_of(punch, "force_measured");
  EXPECT_NEAR(force.ends.most.value, 7.355, 5e-4);
  EXPECT_EQ(force.ends.most.is_clipped, true);
  EXPECT_EQ(force.ends.most.rows, 99U);
  ASSERT_EQ(force.ends.most.first_runs.size(), 1U);
  EXPECT_EQ(force.ends.most.first_runs[0].begin, 14'576U);
  EXPECT_EQ(force.ends.most.first_runs[0].end, 14'675U);
  EXPECT_EQ(force.facts.zeros, 8'469U);
  EXPECT_TRUE(force.is_blind_at_zero());
  EXPECT_EQ(force.noise_idle, std::nullopt) << "in a dead zone";
  EXPECT_EQ(force.facts.largest_outliers[0].row, 14'571U);
  EXPECT_THAT(warnings_of(punch), Contains(HasSubstr("(rows 14576 to 14674): it is clipped")));
  EXPECT_THAT(warnings_of(punch), Contains(HasSubstr("exactly 0 in 37.6 % of its rows and never less")));
}

TEST_F(InspectedPunch, IsClippedInNoOtherRecording) {
  const std::map<std::string, std::uint64_t> zeros{{"7_blank_slow_1819", 6'763},
                                                   {"8_blank_fast_1821", 4'716},
                                                   {"9_meniscus_slow_1824", 4'713},
                                                   {"11_meniscus_fast_1826", 9'413},
                                                   {"15_skin_knee_lateral_slow_1900", 7'786},
                                                   {"16_skin_knee_lateral_fast_1904", 6'355}};
  for (const auto& [name, count] : zeros) {
    KERF_NEEDS_DATA("meniscus/" + name + ".txt");
    const Inspection punch = of(name);
    const InspectedSignal& force = signal_of(punch, "force_measured");
    EXPECT_EQ(force.ends.most.is_clipped, false) << name;
    EXPECT_EQ(force.facts.zeros, count) << name;
    EXPECT_TRUE(force.is_blind_at_zero()) << name;
    // A sensor with steps of 7 mN that are not all alike.
    EXPECT_NEAR(force.facts.quantum.value(), 0.0068, 0.0006) << name;
    EXPECT_NEAR(signal_of(punch, "position").facts.noise.value(), 0.00313, 0.0002) << name;
    EXPECT_NEAR(punch.sampling.resolution_s.value(), 1e-3, 1e-9) << name;
    EXPECT_LT(punch.contact->rows, punch.sampling.rows / 2) << name << ": finding L1";
  }
}

}  // namespace
}  // namespace kerf::bench
