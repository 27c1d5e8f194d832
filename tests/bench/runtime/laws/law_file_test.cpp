#include "laws/law_file.h"

#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/example_laws.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

using testing::HasSubstr;

const std::string liver = R"(model = "kelvin"
axis = "theta"
position_unit = "rad"

[contact]
position = { value = 30, unit = "deg" }
direction = "decreasing"

[parameters]
parallel_stiffness = { value = 8.0, unit = "N/rad" }
series_stiffness = { value = 7e3, unit = "mN/rad", std_error = 20 }
damping = { value = 130, unit = "N·s/rad" }
)";

std::string replaced(const std::string& from, const std::string& to) {
  std::string text = liver;
  return text.replace(text.find(from), from.size(), to);
}

std::string refusal(const std::string& text) {
  try {
    (void)parse_law_file(text, "liver.law.toml");
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(LawFile, IsReadIntoSi) {
  const LawFile file = parse_law_file(liver, "liver.law.toml");
  EXPECT_EQ(file.law.model(), "kelvin");
  EXPECT_THAT(file.law.values(), testing::ElementsAre(8.0, testing::DoubleEq(7.0), 130.0));
  EXPECT_DOUBLE_EQ(file.contact.position, 30.0 * std::numbers::pi / 180.0);
  EXPECT_EQ(file.contact.direction, -1.0);
  EXPECT_EQ(file.axis, "theta");
}

TEST(LawFile, RoundTripsEveryLawOfTheRegistry) {
  for (const models::LawInfo& info : models::registry()) {
    LawFile file{.law = test::example(info.name), .contact = {}, .axis = {}, .fit = {}};
    if (!info.position_unit.empty()) file.position_unit = info.position_unit;
    const std::string text = to_toml(file);
    const LawFile again = parse_law_file(text, "again.law.toml");
    EXPECT_EQ(again.law.model(), info.name);
    EXPECT_EQ(again.law.values(), file.law.values()) << text;
    EXPECT_EQ(again.law.options(), file.law.options()) << text;
    EXPECT_EQ(to_toml(again), text);
  }
}

TEST(LawFile, EveryLawHasAnExampleInTheRepository) {
  for (const models::LawInfo& info : models::registry()) {
    const std::string file =
        std::string(KERF_SOURCE_DIR) + "/examples/" + std::string(info.name) + ".law.toml";
    const LawFile read = read_law_file(file);
    EXPECT_EQ(read.law.model(), info.name);
    EXPECT_EQ(read.law.values(), test::example(info.name).values()) << file;
    EXPECT_EQ(read.law.options(), test::example(info.name).options()) << file;
  }
}

TEST(LawFile, OfALawWithUnitsOfItsOwnTakesNoOthers) {
  LawFile file{.law = test::example("scissors_analytic"), .contact = {}, .axis = {}, .fit = {}};
  file.position_unit = "m";
  EXPECT_THAT(refusal(to_toml(file)),
              HasSubstr("'position_unit' is \"m\", but law 'scissors_analytic' is one of rad"));
  file.position_unit = "rad";
  EXPECT_EQ(refusal(to_toml(file)), "accepted");
}

TEST(LawFile, AnErrorThatIsNoNumberIsRefusedInItsPlace) {
  EXPECT_THAT(refusal(liver + "[fit]\nrmse = { value = [], unit = \"N\" }\n"),
              HasSubstr("'rmse' must be one number"));
}

TEST(LawFile, OfAnEarlierVersionKnowsNoRangeOfItsFit) {
  const LawFile file = parse_law_file(liver + "[fit]\nrecording = \"0d7c\"\n", "liver.law.toml");
  EXPECT_EQ(file.fit.recording_uuid, "0d7c");
  EXPECT_FALSE(file.fit.range);
}

TEST(LawFile, HalfARangeOfItsFitIsRefused) {
  EXPECT_THAT(refusal(liver + "[fit]\npenetration = { value = [0, 1], unit = \"rad\" }\n"),
              HasSubstr("no 'speed'"));
  EXPECT_THAT(
      refusal(
          liver +
          "[fit]\npenetration = { value = [0], unit = \"rad\" }\nspeed = { value = 1, unit = \"rad/s\" }\n"),
      HasSubstr("'penetration' must be 2 finite numbers"));
}

TEST(LawFile, OfASpatialLawHasNoContact) {
  const LawFile file{.law = test::example("blade"), .contact = {}, .axis = {}, .fit = {}};
  const std::string text = to_toml(file);
  EXPECT_THAT(text, testing::Not(HasSubstr("[contact]")));
  EXPECT_THAT(refusal("axis = \"x\"\n" + text), HasSubstr("leave 'axis' out"));
}

TEST(LawFile, OfATorqueHasItsErrorInItsUnit) {
  LawFile file{.law = models::Law::make("kelvin", std::vector{1.0, 2.0, 0.1}),
               .contact = {},
               .axis = "angle",
               .position_unit = "rad",
               .force_unit = "N·m"};
  file.fit.recording_uuid = "0d7c";
  file.fit.rmse_n = 0.25;
  const std::string text = to_toml(file);
  EXPECT_THAT(text, HasSubstr("rmse = { value = 0.25, unit = \"N·m\" }"));
  EXPECT_EQ(parse_law_file(text, "x.law.toml").fit.rmse_n, 0.25);
  const auto at = text.find("unit = \"N·m\" }", text.find("rmse"));
  const std::string of_old = text.substr(0, at) + "unit = \"N\" }" + text.substr(text.find(" }", at) + 2);
  EXPECT_EQ(parse_law_file(of_old, "x.law.toml").fit.rmse_n, 0.25) << "as earlier versions wrote it";
}

TEST(LawFile, RoundTripsEveryKindOfParameterAndOption) {
  const LawFile file{
      .law = models::Law::make("piecewise", std::vector{0.0, 0.1, 1.0 / 3.0, 0.0, 2.0, 3.0, -0.5, -1.0, -0.1},
                               {{"segments", 2.0}, {"loop", true}, {"ramp_band", 0.05}}),
      .contact = {.position = 0.1234567890123456, .direction = -1.0},
      .axis = "angle of \"the\" blades",
      .position_unit = "rad",
      .force_unit = "N",
      .std_errors = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9},
      .fit = {.recording_uuid = "0d7c",
              .recording_sha256 = "ab",
              .rmse_n = 0.25,
              .date = "2026-11-20",
              .software = "kerf",
              .range = FittedRange{.least = -0.01, .most = 1.0 / 3.0, .fastest = 2.5}}};
  const test::TemporaryFolder folder;
  write_law_file(folder / "x.law.toml", file);
  const LawFile again = read_law_file(folder / "x.law.toml");
  EXPECT_EQ(again.law.values(), file.law.values());
  EXPECT_EQ(again.law.options(), file.law.options());
  EXPECT_EQ(again.std_errors, file.std_errors);
  EXPECT_EQ(again.contact.position, file.contact.position);
  EXPECT_EQ(again.contact.direction, file.contact.direction);
  EXPECT_EQ(again.axis, file.axis);
  EXPECT_EQ(again.position_unit, "rad");
  EXPECT_EQ(again.fit.recording_uuid, "0d7c");
  EXPECT_EQ(again.fit.rmse_n, 0.25);
  ASSERT_TRUE(again.fit.range);
  EXPECT_EQ(again.fit.range->least, -0.01);
  EXPECT_EQ(again.fit.range->most, 1.0 / 3.0);
  EXPECT_EQ(again.fit.range->fastest, 2.5);
  EXPECT_EQ(to_toml(again), to_toml(file));
}

TEST(LawFile, SaysWhatIsWrongAndWhere) {
  EXPECT_THAT(refusal(replaced("axis =", "axes =")), HasSubstr("liver.law.toml:2: unknown key 'axes'"));
  EXPECT_THAT(refusal(replaced("damping =", "dumping =")),
              HasSubstr("liver.law.toml:12: unknown parameter 'dumping'; the law takes parallel_stiffness"));
  EXPECT_THAT(refusal(replaced(", unit = \"N·s/rad\"", "")), HasSubstr(":12: 'damping' has no unit"));
  EXPECT_THAT(refusal(replaced("N·s/rad", "N·s/m")), HasSubstr("given in N·s/m, expected N·s/rad"));
  EXPECT_THAT(refusal(replaced("N·s/rad", "furlong")), HasSubstr("unknown unit 'furlong'"));
  EXPECT_THAT(refusal(replaced("value = 8.0", "value = -8.0")),
              HasSubstr(":10: parameter 'parallel_stiffness' is -8 in SI, expected a number from 1e-09"));
  EXPECT_THAT(refusal(replaced("value = 8.0", "value = nan")),
              HasSubstr(":10: parameter 'parallel_stiffness'"));
  EXPECT_THAT(refusal(replaced("value = 8.0", "value = \"8\"")), HasSubstr("must be a number"));
  EXPECT_THAT(refusal(replaced("value = 8.0", "value = [8.0, 9.0]")), HasSubstr("has 2 values, expected 1"));
  EXPECT_THAT(refusal(replaced("{ value = 8.0, unit = \"N/rad\" }", "8.0")), HasSubstr("must be written {"));
  EXPECT_THAT(refusal(replaced("\"decreasing\"", "\"down\"")), HasSubstr(":7: 'direction' is \"down\""));
  EXPECT_THAT(refusal(replaced("\"kelvin\"", "\"burgers\"")),
              testing::MatchesRegex(".*:1: unknown law 'burgers'; the laws are kelvin, .*; one of a plug-in "
                                    "is known with --plugin PATH/FILE.so"));
  EXPECT_THAT(refusal(replaced("model", "modle")), HasSubstr("unknown key 'modle'"));
  EXPECT_THAT(refusal(replaced("\"rad\"", "\"deg\"")),
              HasSubstr("'position_unit' is \"deg\", expected m or rad"));
  EXPECT_THAT(refusal(liver + "[fidelity]\nintegrator = \"magic\"\n"), HasSubstr("\"magic\""));
  EXPECT_THAT(refusal(liver + "[fidelity]\nspeed = 3\n"), HasSubstr("no option 'speed'"));
  EXPECT_THAT(refusal("model = "), HasSubstr("liver.law.toml:1: not TOML"));
  EXPECT_THAT(refusal("model = \"kelvin\"\n"), HasSubstr("expected a table [parameters]"));
}

}  // namespace
}  // namespace kerf::bench
