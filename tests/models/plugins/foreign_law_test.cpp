// A law of a plug-in is a law like any other, and what its plug-in says of it is not believed.

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <kerf/models/foreign.h>

#include "support/allocation_counter.h"
#include "support/foreign_friction.h"

namespace kerf::models {
namespace {

using test::foreign_friction::described;
using testing::HasSubstr;

const std::vector<double> values{0.3, 4.0, -0.2, 0.5, 0.01};

kerf_law_v1 named(const char* name) { return described(name, false); }

std::string refusal(const kerf_law_v1& law) {
  try {
    ForeignLaw(law, {});
  } catch (const std::invalid_argument& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    return error.what();
  }
  return "";
}

/// Description of a law with one parameter changed.
std::string refusal_of(const kerf_law_parameter_v1& parameter) {
  kerf_law_v1 law = named("one_parameter");
  law.parameters = &parameter;
  law.parameter_count = 1;
  return refusal(law);
}

TEST(ForeignLaw, StepsAsTheSameLawOfTheHouseDoes) {
  register_law(named("steps_as_friction"), {.path = "./a.so", .name = "a.so", .sha256 = "a"});
  const Law own = Law::make("steps_as_friction", values);
  const Law house = Law::make("friction", values);
  EXPECT_EQ(own.model(), "steps_as_friction");
  Law::State own_state = own.initial_state();
  Law::State house_state = house.initial_state();
  for (int i = 0; i < 1000; ++i) {
    const Motion motion{.penetration = std::sin(0.02 * i), .velocity = 20.0 * std::cos(0.02 * i)};
    const Response response = own.step(own_state, motion, 1e-3);
    EXPECT_FALSE(response.fault);
    ASSERT_EQ(response.force, house.step(house_state, motion, 1e-3).force);
  }
}

TEST(ForeignLaw, IsFoundByItsNameWhereverLawsAre) {
  register_law(named("found_by_name"), {.path = "./b.so", .name = "b.so", .sha256 = "b"});
  EXPECT_EQ(law_info("found_by_name").equation, "F = F0 + k x + b v + Fc z");
  EXPECT_THAT(registry(), testing::Contains(testing::Field(&LawInfo::name, "found_by_name")));
  EXPECT_EQ(law_facts("found_by_name").search, Search::descent);
  const auto parameters = Law::parameters("found_by_name");
  EXPECT_EQ(unit_of(parameters[2].quantity, "N", "rad"), "N·s/rad");
  EXPECT_TRUE(Law::options("found_by_name").empty());
  EXPECT_TRUE(Law::axes("found_by_name").empty());
  EXPECT_THROW((void)Law::make("found_by_name", values, {{"arms", 2.0}}), std::invalid_argument);
  EXPECT_THROW((void)Law::make("found_by_name", std::vector{0.0, 0.0, 0.0, -1.0, 1.0}),
               std::invalid_argument);
}

TEST(ForeignLaw, TellsOfACutWhatItsBitsSay) {
  kerf_law_v1 law = named("tells");
  const auto effects = [&law](unsigned tells) {
    law.tells = tells;
    const KnownEffects known = ForeignLaw(law, {}).facts().variants.begin()->effects;
    return std::vector(known.begin(), known.end());
  };
  EXPECT_THAT(effects(0), testing::IsEmpty());
  EXPECT_THAT(effects(KERF_TELLS_CUTTING), testing::ElementsAre(Effect::cutting));
  EXPECT_THAT(effects(31), testing::ElementsAre(Effect::loop, Effect::relaxation, Effect::cutting,
                                                Effect::rate, Effect::stiffening));
}

TEST(ForeignLaw, ComesInOnceByOneContentAndNotByTwo) {
  const ForeignLaw& first = register_law(named("once"), {.path = "./c.so", .name = "c.so", .sha256 = "c"});
  EXPECT_EQ(&register_law(named("once"), {.path = "./d.so", .name = "d.so", .sha256 = "c"}), &first);
  EXPECT_THROW(register_law(named("once"), {.path = "./e.so", .name = "e.so", .sha256 = "e"}),
               std::invalid_argument);
}

TEST(ForeignLaw, CopiesItsStateAsAValue) {
  register_law(named("copied"), {.path = "./f.so", .name = "f.so", .sha256 = "f"});
  const Law law = Law::make("copied", values);
  Law::State state = law.initial_state();
  (void)law.step(state, Motion{.penetration = 0.0, .velocity = 1.0}, 1e-3);
  Law::State copy = state;
  const double there = law.step(state, Motion{.penetration = 0.02, .velocity = 1.0}, 1e-3).force;
  const test::NoAllocation none;
  EXPECT_EQ(law.step(copy, Motion{.penetration = 0.02, .velocity = 1.0}, 1e-3).force, there);
  copy = state;
  EXPECT_EQ(law.step(copy, Motion{.penetration = 0.01, .velocity = -1.0}, 1e-3).force,
            law.step(state, Motion{.penetration = 0.01, .velocity = -1.0}, 1e-3).force);
}

TEST(ForeignLaw, GivesZeroForceAndAFaultWhereItBreaks) {
  kerf_law_v1 law = named("throws");
  law.step = [](const double*, void*, const double*, const double*, double, double*) { throw 1; };
  register_law(law, {.path = "./g.so", .name = "g.so", .sha256 = "g"});
  law = named("gives_no_number");
  law.step = [](const double*, void*, const double*, const double*, double, double* force) {
    *force = std::numeric_limits<double>::quiet_NaN();
  };
  register_law(law, {.path = "./h.so", .name = "h.so", .sha256 = "h"});
  law = named("writes_behind");
  law.step = [](const double*, void* state, const double*, const double*, double, double* force) {
    static_cast<char*>(state)[sizeof(test::foreign_friction::State)] = 0;
    *force = 1.0;
  };
  register_law(law, {.path = "./i.so", .name = "i.so", .sha256 = "i"});
  for (const char* name : {"throws", "gives_no_number", "writes_behind"}) {
    const Law broken = Law::make(name, values);
    Law::State state = broken.initial_state();
    const Response response = broken.step(state, Motion{}, 1e-3);
    EXPECT_TRUE(response.fault) << name;
    EXPECT_EQ(response.force, 0.0) << name;
    EXPECT_EQ(running_foreign_law(), nullptr) << name;
  }
}

TEST(ForeignLaw, WithAxesOfItsOwnActsOnThem) {
  static const std::array axes{kerf_law_axis_v1{"x", "m", "N"}, kerf_law_axis_v1{"rz", "rad", "N*m"}};
  kerf_law_v1 law = named("with_axes");
  law.axes = axes.data();
  law.axis_count = 2;
  law.step = [](const double* p, void*, const double* x, const double*, double, double* force) {
    force[0] = -p[1] * x[0];
    force[1] = -p[3] * x[1];
  };
  register_law(law, {.path = "./j.so", .name = "j.so", .sha256 = "j"});
  const Law spatial = Law::make("with_axes", values);
  ASSERT_TRUE(spatial.is_spatial());
  EXPECT_EQ(spatial.axes()[1].force_unit, "N·m");
  Law::State state = spatial.initial_state();
  const SpatialResponse response = spatial.step(state, SpatialMotion{.position = {0.5, 0.2}}, 1e-3);
  EXPECT_FALSE(response.fault);
  EXPECT_THAT(response.force, testing::ElementsAre(-2.0, -0.1, 0.0, 0.0, 0.0, 0.0));
  EXPECT_TRUE(spatial.step(state, Motion{}, 1e-3).fault);
}

TEST(ForeignLaw, ThatSaysNothingOfItsAlignmentHasThatOfADouble) {
  kerf_law_v1 law = named("unaligned");
  law.state_alignment = 0;
  EXPECT_EQ(ForeignLaw(law, {}).description().state_alignment, alignof(double));
}

TEST(ForeignLaw, IsRefusedInOneLineForWhatItSaysOfItself) {
  kerf_law_v1 law = named("fine");
  EXPECT_EQ(refusal(law), "");
  law.abi = 2;
  EXPECT_THAT(refusal(law), HasSubstr("version 2 of kerf/law.h, and this program reads version 1"));
  law = named("fine");
  law.size = 8;
  EXPECT_THAT(refusal(law), HasSubstr("its description is of 8 bytes"));
  EXPECT_THAT(refusal(named("kelvin")), HasSubstr("as one of Kerf's own"));
  EXPECT_THAT(refusal(named("My Law")), HasSubstr("the law's name is 'My Law'"));
  EXPECT_THAT(refusal(named(nullptr)), HasSubstr("the law's name is missing"));
  law = named("fine");
  law.state_size = static_cast<std::size_t>(-1);
  EXPECT_THAT(refusal(law), HasSubstr("state_size is 18446744073709551615 bytes"));
  law = named("fine");
  law.state_alignment = 3;
  EXPECT_THAT(refusal(law), HasSubstr("state_alignment is 3, expected a power of two"));
  law = named("fine");
  law.step = nullptr;
  EXPECT_THAT(refusal(law), HasSubstr("no step()"));
  law = named("fine");
  law.parameter_count = 1000;
  EXPECT_THAT(refusal(law), HasSubstr("1000 parameters, expected 1 to 32"));
  law = named("fine");
  law.position_unit = "mm";
  EXPECT_THAT(refusal(law), HasSubstr("position_unit is 'mm', expected m or rad"));
  law = named("fine");
  law.axis_count = 3;
  EXPECT_THAT(refusal(law), HasSubstr("3 axes and no list of them"));
}

TEST(ForeignLaw, IsRefusedInOneLineForWhatItSaysOfAParameter) {
  const kerf_law_parameter_v1 fine{"k", "N/m", "stiffness", 0.0, 1e6, 100.0, KERF_SEARCHED};
  EXPECT_EQ(refusal_of(fine), "");
  kerf_law_parameter_v1 one = fine;
  one.unit = "furlong";
  EXPECT_THAT(refusal_of(one), HasSubstr("parameter 'k': its unit 'furlong' is none of N, m, m/s, N/m"));
  one = fine;
  one.lower = 2e6;
  EXPECT_THAT(refusal_of(one), HasSubstr("parameter 'k': its bounds are 2e+06 and 1e+06"));
  one = fine;
  one.upper = std::numeric_limits<double>::infinity();
  EXPECT_THAT(refusal_of(one), HasSubstr("its bounds are 0 and inf"));
  one = fine;
  one.initial = -1.0;
  EXPECT_THAT(refusal_of(one), HasSubstr("its initial value -1 is not from 0 to 1e+06"));
  one = fine;
  one.flags |= KERF_LOGARITHMIC;
  EXPECT_THAT(refusal_of(one), HasSubstr("is logarithmic, and its lower bound is 0"));
  one = fine;
  one.flags = 0;
  EXPECT_THAT(refusal_of(one), HasSubstr("none of its parameters is searched"));
  one = fine;
  one.meaning = "two\nlines";
  EXPECT_THAT(refusal_of(one), HasSubstr("a line break"));
}

}  // namespace
}  // namespace kerf::models
