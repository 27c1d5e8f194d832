#include "laws/placement.h"

#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "laws/law_file.h"
#include "support/example_laws.h"

namespace kerf::bench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const drivers::DeviceInfo scissors = drivers::open_device("sim:scissors")->info();
const drivers::DeviceInfo pose6 = drivers::open_device("sim:pose6")->info();

LawFile file_of(std::string_view model) {
  return {.law = test::example(model), .contact = {}, .axis = {}, .fit = {}};
}

TEST(AxisForALaw, IsTheOneItNamesOrTheFirstOfItsUnits) {
  LawFile law = file_of("kelvin");
  law.axis = "theta";
  law.position_unit = "rad";
  EXPECT_EQ(axis_for(law, scissors), 0U);
  law.axis = "";
  law.position_unit = "m";
  EXPECT_EQ(axis_for(law, scissors), 1U);
  law.force_unit = "N·m";
  EXPECT_THROW((void)axis_for(law, scissors), std::invalid_argument);
}

TEST(AxesForALaw, AreThoseOfItsNames) {
  EXPECT_THAT(axes_for(file_of("blade"), pose6), ElementsAre(0, 1, 2, 3, 4, 5));
  try {
    (void)axes_for(file_of("blade"), scissors);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr("law 'blade' acts on axis 'x'"));
  }
}

TEST(AxesForALawInTheHand, AreThoseItNamesInItsUnitsAndNoOthers) {
  LawFile law = file_of("kelvin");
  law.axis = "theta";
  law.position_unit = "rad";
  EXPECT_THAT(named_axes_for(law, scissors), ElementsAre(0));
  EXPECT_THAT(named_axes_for(file_of("blade"), pose6), ElementsAre(0, 1, 2, 3, 4, 5));
  const auto refusal = [&] {
    try {
      (void)named_axes_for(law, scissors);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  law.axis = "punch";
  law.position_unit = "m";
  EXPECT_EQ(axis_for(law, scissors), 1U) << "its units alone would fit";
  EXPECT_THAT(refusal(), HasSubstr("the law is for axis 'punch' (N over m)"));
  EXPECT_THAT(refusal(), HasSubstr("'theta' (N over rad), 'x_s' (N over m)"));
  law.axis = "";
  EXPECT_THAT(refusal(), HasSubstr("the law is for axis ''"));
  law.axis = "theta";
  EXPECT_THAT(refusal(), HasSubstr("the law gives N over m, but axis 'theta'"));
}

TEST(AxesForALaw, MustHaveItsUnits) {
  drivers::DeviceInfo metric = pose6;
  metric.axes[3].force_unit = "N";
  EXPECT_THROW((void)axes_for(file_of("blade"), metric), std::invalid_argument);
}

}  // namespace
}  // namespace kerf::bench
