// An FMU is held against the standard and driven by an importer that shares nothing with its exporter.

#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pugixml.hpp>

#include "bench/export/example_export.h"
#include "bench/export/fmu/fmi3_importer.h"
#include "bench/export/fmu/fmi3_rules.h"
#include "exported_law.h"
#include "hosts/fmu/archive.h"
#include "support/program.h"

namespace kerf::bench {
namespace {

using testing::ElementsAre;
using testing::ElementsAreArray;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr std::uint32_t simulated_time = 0;
constexpr std::uint32_t position = 1;
constexpr std::uint32_t velocity = 2;
constexpr std::uint32_t force = 3;
constexpr std::uint32_t contact_position = 4;

/// Made once: a compiler takes longer than all that is asked of what it made.
class Fmu : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder = new test::TemporaryFolder;
    const std::vector<HostFile> files = fmu_host().files(test::liver());
    test::write_files(files, folder->path());
    archive = new std::string(files.at(0).content);
    parts = new std::vector<HostFile>(unzipped(*archive));
    test::write_files(*parts, folder->path());
    library = new test::FmuLibrary(*folder / part("binaries/"));
  }
  static void TearDownTestSuite() {
    delete library;
    delete parts;
    delete archive;
    delete folder;
  }
  /// The name of the first file that begins so.
  static std::string part(const std::string& begin) {
    for (const HostFile& file : *parts) {
      if (file.name.starts_with(begin)) return file.name;
    }
    return "none";
  }
  static pugi::xml_document description() {
    pugi::xml_document document;
    document.load_file((*folder / "modelDescription.xml").c_str());
    return document;
  }
  static std::string token() {
    return description().document_element().attribute("instantiationToken").value();
  }

  /// The forces of the samples from here on.
  static std::vector<double> forces(test::FmuInstance& fmu, const std::vector<HostSample>& samples) {
    std::vector<double> all;
    for (const HostSample& sample : samples) {
      double answer = std::nan("");
      EXPECT_EQ(fmu.set(position, sample.position), test::fmi_ok);
      EXPECT_EQ(fmu.set(velocity, sample.velocity), test::fmi_ok);
      EXPECT_EQ(fmu.step(fmu.time, sample.elapsed_s), test::fmi_ok) << fmu.last_said();
      EXPECT_EQ(fmu.get(force, answer), test::fmi_ok);
      all.push_back(answer);
    }
    return all;
  }

  static test::TemporaryFolder* folder;
  static std::string* archive;
  static std::vector<HostFile>* parts;
  static test::FmuLibrary* library;
};
test::TemporaryFolder* Fmu::folder;
std::string* Fmu::archive;
std::vector<HostFile>* Fmu::parts;
test::FmuLibrary* Fmu::library;

TEST_F(Fmu, DescribesItselfAsTheSchemaHasIt) {
  pugi::xml_document document = description();
  EXPECT_THAT(test::broken_rules(document), IsEmpty());
  auto root = document.document_element();
  root.child("ModelVariables").first_child().remove_attribute("causality");
  root.child("ModelStructure").remove_child("Output");
  root.child("CoSimulation").append_attribute("canFly") = true;
  root.prepend_move(root.child("ModelStructure"));
  EXPECT_THAT(test::broken_rules(document).size(), testing::Ge(4U)) << "the rules see nothing";
}

TEST_F(Fmu, IsAnArchiveThatEveryImporterReads) {
  EXPECT_THAT(test::broken_zip_rules(*archive), IsEmpty());
  std::vector<std::string> names;
  for (const HostFile& file : *parts) names.push_back(file.name);
  EXPECT_THAT(
      names,
      ElementsAre("modelDescription.xml", testing::MatchesRegex("binaries/[a-z0-9_]+-linux/liver.so"),
                  "sources/buildDescription.xml", "documentation/liver.law.toml", "documentation/liver.json",
                  "documentation/licenses/license.txt", "sources/liver_fmu.c", "sources/liver.c",
                  "sources/fmi3_types.h", "sources/fmi3_not_offered.h"));
  EXPECT_EQ(test::read_text(*folder / "documentation/liver.law.toml"), test::liver().text);
  EXPECT_EQ(fmu_host().files(test::liver()).at(0).content, *archive) << "not the same again";
}

TEST_F(Fmu, NamesThePartsOfItsUnits) {
  const auto document = description();
  const auto unit = document.document_element()
                        .child("UnitDefinitions")
                        .find_child_by_attribute("Unit", "name", "N.s/rad")
                        .child("BaseUnit");
  EXPECT_EQ(unit.attribute("kg").as_int(), 1);
  EXPECT_EQ(unit.attribute("m").as_int(), 1);
  EXPECT_EQ(unit.attribute("s").as_int(), -1);
  EXPECT_EQ(unit.attribute("rad").as_int(), -1);
}

TEST_F(Fmu, ExportsEveryFunctionOfTheStandard) {
  for (const std::string& name : test::fmi3_functions()) EXPECT_TRUE(library->has(name)) << name;
  EXPECT_FALSE(library->has("liver_step"));
  EXPECT_STREQ(library->get_version(), "3.0");
}

TEST_F(Fmu, CompilesWithoutAWarningAsC99) {
  for (const char* const compiler : {"gcc", "clang"}) {
    const auto outcome = test::run({"/usr/bin/env", compiler, "-std=c99", "-Wall", "-Wextra", "-pedantic",
                                    "-Werror", "-fsyntax-only", (*folder / "sources/liver_fmu.c").string()});
    if (outcome.exit_status == 127) GTEST_SKIP() << "no " << compiler;
    EXPECT_EQ(outcome.exit_status, 0) << outcome.errors;
  }
}

TEST_F(Fmu, GivesTheForcesOfTheLawToTheBit) {
  const std::vector<HostSample> samples = test::wandering(3000);
  test::FmuInstance fmu(*library, token());
  ASSERT_EQ(fmu.begin(2.0), test::fmi_ok);
  EXPECT_THAT(forces(fmu, samples), ElementsAreArray(test::forces_of_liver(samples)));
  EXPECT_EQ(fmu.call("fmi3Terminate"), test::fmi_ok);
  double last = 0.0;
  EXPECT_EQ(fmu.get(force, last), test::fmi_ok) << "what it came to is still to be had";
  EXPECT_EQ(last, test::forces_of_liver(samples).back());
  EXPECT_THAT(fmu.said(), IsEmpty());
}

TEST_F(Fmu, IsDrivenTheSameByTheProgramThatVerifiesIt) {
  std::vector<HostSample> samples = test::wandering(500);
  samples[100].position = std::nan("");
  samples[200].elapsed_s = 0.0;
  const std::vector<double> forces = fmu_host().forces(test::liver(), folder->path(), samples);
  EXPECT_THAT(test::differing(forces, test::forces_of_liver(samples)), IsEmpty());
  EXPECT_TRUE(std::isnan(forces.at(100)) && std::isnan(forces.at(200)));
}

TEST_F(Fmu, KeepsTwoInstancesApart) {
  const std::vector<HostSample> samples = test::wandering(400);
  const std::vector<HostSample> others(samples.begin() + 50, samples.end());
  test::FmuInstance one(*library, token());
  test::FmuInstance other(*library, token());
  ASSERT_EQ(one.begin(), test::fmi_ok);
  ASSERT_EQ(other.begin(), test::fmi_ok);
  std::vector<double> of_one;
  std::vector<double> of_other;
  for (std::size_t i = 0; i < others.size(); ++i) {
    of_one.push_back(forces(one, {samples[i]}).front());
    of_other.push_back(forces(other, {others[i]}).front());
  }
  EXPECT_THAT(of_one, ElementsAreArray(test::forces_of_liver({samples.begin(), samples.begin() + 350})));
  EXPECT_THAT(of_other, ElementsAreArray(test::forces_of_liver(others)));
}

TEST_F(Fmu, IsAsNewAfterAReset) {
  const std::vector<HostSample> samples = test::wandering(300);
  test::FmuInstance fmu(*library, token());
  ASSERT_EQ(fmu.begin(), test::fmi_ok);
  const std::vector<double> first = forces(fmu, samples);
  ASSERT_EQ(fmu.call("fmi3Reset"), test::fmi_ok);
  ASSERT_EQ(fmu.begin(7.0), test::fmi_ok);
  double before = 1.0;
  EXPECT_EQ(fmu.get(force, before), test::fmi_ok);
  EXPECT_EQ(before, 0.0);
  EXPECT_THAT(forces(fmu, samples), ElementsAreArray(first));
}

TEST_F(Fmu, GoesOnFromASavedState) {
  const std::vector<HostSample> samples = test::wandering(600);
  const std::vector<HostSample> begin(samples.begin(), samples.begin() + 300);
  const std::vector<HostSample> end(samples.begin() + 300, samples.end());
  test::FmuInstance fmu(*library, token());
  ASSERT_EQ(fmu.begin(), test::fmi_ok);
  forces(fmu, begin);
  void* state = nullptr;
  ASSERT_EQ(library->get_state(fmu.get(), &state), test::fmi_ok);
  const double time = fmu.time;
  const std::vector<double> first = forces(fmu, end);

  ASSERT_EQ(library->set_state(fmu.get(), state), test::fmi_ok);
  fmu.time = time;
  EXPECT_THAT(forces(fmu, end), ElementsAreArray(first));

  std::size_t size = 0;
  ASSERT_EQ(library->state_size(fmu.get(), state, &size), test::fmi_ok);
  std::vector<std::uint8_t> bytes(size);
  ASSERT_EQ(library->serialize(fmu.get(), state, bytes.data(), size), test::fmi_ok);
  EXPECT_EQ(library->free_state(fmu.get(), &state), test::fmi_ok);
  EXPECT_EQ(state, nullptr);
  test::FmuInstance another(*library, token());
  ASSERT_EQ(library->deserialize(another.get(), bytes.data(), size, &state), test::fmi_ok);
  ASSERT_EQ(library->set_state(another.get(), state), test::fmi_ok);
  another.time = time;
  EXPECT_THAT(forces(another, end), ElementsAreArray(first));
  EXPECT_EQ(library->free_state(another.get(), &state), test::fmi_ok);
}

TEST_F(Fmu, RefusesAStateThatIsNotItsOwn) {
  test::FmuInstance fmu(*library, token());
  ASSERT_EQ(fmu.begin(), test::fmi_ok);
  void* state = nullptr;
  std::size_t size = 0;
  ASSERT_EQ(library->get_state(fmu.get(), &state), test::fmi_ok);
  ASSERT_EQ(library->state_size(fmu.get(), state, &size), test::fmi_ok);
  std::vector<std::uint8_t> bytes(size);
  ASSERT_EQ(library->serialize(fmu.get(), state, bytes.data(), size), test::fmi_ok);
  void* made = nullptr;
  const auto refused = [&](const std::string& why) {
    EXPECT_EQ(library->deserialize(fmu.get(), bytes.data(), bytes.size(), &made), test::fmi_error);
    EXPECT_THAT(fmu.last_said(), HasSubstr(why));
    EXPECT_EQ(made, nullptr);
  };
  bytes.back() ^= 1U;
  refused("damaged: its bytes do not add up");
  bytes[20] ^= 1U;
  refused("no state of this FMU");
  bytes.pop_back();
  refused("a state of this FMU has");
  EXPECT_EQ(library->serialize(fmu.get(), state, bytes.data(), 3), test::fmi_error);
  EXPECT_EQ(library->set_state(fmu.get(), nullptr), test::fmi_error);
  EXPECT_EQ(library->set_state(fmu.get(), state), test::fmi_ok) << "after errors, back to before them";
  EXPECT_EQ(forces(fmu, {{.position = 0.4, .velocity = 0.0, .elapsed_s = 0.001}}).size(), 1U);
  EXPECT_EQ(library->free_state(fmu.get(), &state), test::fmi_ok);
}

TEST_F(Fmu, ShowsTheNumbersOfItsLawAndLetsNobodyChangeThem) {
  test::FmuInstance fmu(*library, token());
  ASSERT_EQ(library->initialize(fmu.get(), false, 0.0, 0.0, false, 0.0), test::fmi_ok);
  double value = 0.0;
  ASSERT_EQ(fmu.get(contact_position, value), test::fmi_ok);
  EXPECT_EQ(value, 0.5);
  ASSERT_EQ(fmu.get(contact_position + 4, value), test::fmi_ok);
  EXPECT_EQ(value, 130.0);
  EXPECT_EQ(fmu.set(contact_position + 4, 1.0), test::fmi_error);
  EXPECT_THAT(fmu.last_said(), HasSubstr("fmi3SetFloat64: law.damping is not to be set; only the inputs"));
}

/// A call that must be refused, and a part of what is said of it.
struct BadCall {
  const char* what;
  const char* said;
  int (*call)(test::FmuInstance& fmu, const test::FmuLibrary& library);
};
void PrintTo(const BadCall& bad, std::ostream* out) { *out << bad.what; }
class FmuBadCall : public Fmu, public testing::WithParamInterface<BadCall> {};

TEST_P(FmuBadCall, IsAnErrorWithOneLineAndWhatFollowsIsTooUntilAReset) {
  const std::vector<HostSample> samples = test::wandering(50);
  test::FmuInstance fmu(*library, token());
  ASSERT_EQ(fmu.begin(), test::fmi_ok);
  forces(fmu, samples);
  EXPECT_EQ(GetParam().call(fmu, *library), test::fmi_error);
  ASSERT_EQ(fmu.said().size(), 1U);
  EXPECT_THAT(fmu.last_said(), HasSubstr("logStatusError | fmi3"));
  EXPECT_THAT(fmu.last_said(), HasSubstr(GetParam().said));
  double value = 17.0;
  EXPECT_EQ(fmu.get(force, value), test::fmi_error);
  EXPECT_EQ(value, 17.0);
  EXPECT_EQ(fmu.step(fmu.time, 0.001), test::fmi_error);
  EXPECT_THAT(fmu.last_said(), HasSubstr("called after an error; expected fmi3Reset"));
  EXPECT_EQ(fmu.call("fmi3Reset"), test::fmi_ok);
  ASSERT_EQ(fmu.begin(), test::fmi_ok);
  EXPECT_THAT(forces(fmu, samples), ElementsAreArray(test::forces_of_liver(samples)));
}

using test::FmuInstance;
using test::FmuLibrary;
INSTANTIATE_TEST_SUITE_P(
    All, FmuBadCall,
    testing::Values(
        BadCall{"StepBackwards",
                "expected 0.0605, where the last step ended: the way back is fmi3SetFMUState",
                [](FmuInstance& fmu, const FmuLibrary&) { return fmu.step(fmu.time - 0.001, 0.001); }},
        BadCall{"StepAhead", "currentCommunicationPoint is 0.0705; expected 0.0605",
                [](FmuInstance& fmu, const FmuLibrary&) { return fmu.step(fmu.time + 0.01, 0.001); }},
        BadCall{"StepOfSizeZero", "communicationStepSize is 0; expected more than zero",
                [](FmuInstance& fmu, const FmuLibrary&) { return fmu.step(fmu.time, 0.0); }},
        BadCall{"StepOfNegativeSize", "communicationStepSize is -0.001",
                [](FmuInstance& fmu, const FmuLibrary&) { return fmu.step(fmu.time, -0.001); }},
        BadCall{"StepOfNoSize", "communicationStepSize is",
                [](FmuInstance& fmu, const FmuLibrary&) { return fmu.step(fmu.time, std::nan("")); }},
        BadCall{"StepToAForceThatIsNotFinite", "the force for position -1e+308 and velocity",
                [](FmuInstance& fmu, const FmuLibrary&) {
                  return fmu.set(position, -1e308) == test::fmi_ok ? fmu.step(fmu.time, 0.001) : -1;
                }},
        BadCall{"PositionThatIsNone", "position is nan; expected a finite number",
                [](FmuInstance& fmu, const FmuLibrary&) { return fmu.set(position, std::nan("")); }},
        BadCall{"SettingTheForce", "force is not to be set",
                [](FmuInstance& fmu, const FmuLibrary&) { return fmu.set(force, 1.0); }},
        BadCall{"SettingTheTime", "time is not to be set",
                [](FmuInstance& fmu, const FmuLibrary&) { return fmu.set(simulated_time, 1.0); }},
        BadCall{"SettingAConstant", "contact.position is not to be set",
                [](FmuInstance& fmu, const FmuLibrary&) { return fmu.set(contact_position, 1.0); }},
        BadCall{"SettingWhatIsNotThere", "there is no variable 99",
                [](FmuInstance& fmu, const FmuLibrary&) { return fmu.set(99, 1.0); }},
        BadCall{"TwoValuesForOneVariable", "1 variables and 2 values",
                [](FmuInstance& fmu, const FmuLibrary& library) {
                  const std::array<double, 2> values{};
                  return library.set(fmu.get(), &position, 1, values.data(), 2);
                }},
        BadCall{"InitializationInStepMode", "fmi3EnterInitializationMode: called in Step Mode",
                [](FmuInstance& fmu, const FmuLibrary& library) {
                  return library.initialize(fmu.get(), false, 0.0, 0.0, false, 0.0);
                }},
        BadCall{"EventMode", "fmi3EnterEventMode: this FMU does not offer it",
                [](FmuInstance& fmu, const FmuLibrary&) { return fmu.call("fmi3EnterEventMode"); }},
        BadCall{"CategoryOfTheLogThatIsNone", "there is no category 'all'; expected 'logStatusError'",
                [](FmuInstance& fmu, const FmuLibrary& library) {
                  const char* const category = "all";
                  return library.set_debug_logging(fmu.get(), true, 1, &category);
                }},
        BadCall{"NoRoomForResults", "there is no room for one of its four results",
                [](FmuInstance& fmu, const FmuLibrary& library) {
                  return library.do_step(fmu.get(), fmu.time, 0.001, false, nullptr, nullptr, nullptr,
                                         nullptr);
                }}),
    [](const testing::TestParamInfo<BadCall>& info) { return info.param.what; });

TEST_F(Fmu, RefusesStepsBeforeItIsInitializedAndSetsAfterItsEnd) {
  test::FmuInstance fmu(*library, token());
  double value = 0.0;
  EXPECT_EQ(fmu.get(force, value), test::fmi_error);
  EXPECT_THAT(
      fmu.last_said(),
      HasSubstr("fmi3GetFloat64: force has no value yet; expected fmi3EnterInitializationMode before"));
  EXPECT_EQ(fmu.call("fmi3Reset"), test::fmi_ok);
  EXPECT_EQ(fmu.get(position, value), test::fmi_ok);
  EXPECT_EQ(value, 0.5) << "not where the tissue begins, as modelDescription.xml has it";
  EXPECT_EQ(fmu.step(0.0, 0.001), test::fmi_error);
  EXPECT_EQ(fmu.call("fmi3Reset"), test::fmi_ok);
  ASSERT_EQ(fmu.begin(), test::fmi_ok);
  ASSERT_EQ(fmu.call("fmi3Terminate"), test::fmi_ok);
  EXPECT_EQ(fmu.set(position, 0.0), test::fmi_error);
  EXPECT_THAT(fmu.last_said(), HasSubstr("fmi3SetFloat64: called after fmi3Terminate"));
}

TEST_F(Fmu, StopsWhereItWasToldTo) {
  test::FmuInstance fmu(*library, token());
  EXPECT_EQ(library->initialize(fmu.get(), false, 0.0, 1.0, true, 0.5), test::fmi_error);
  EXPECT_THAT(fmu.last_said(), HasSubstr("stopTime is 0.5; expected a number from startTime, 1, on"));
  ASSERT_EQ(fmu.call("fmi3Reset"), test::fmi_ok);
  ASSERT_EQ(library->initialize(fmu.get(), false, 0.0, 0.0, true, 0.3), test::fmi_ok);
  ASSERT_EQ(fmu.call("fmi3ExitInitializationMode"), test::fmi_ok);
  EXPECT_EQ(fmu.step(0.0, 0.1), test::fmi_ok);
  EXPECT_EQ(fmu.step(0.1, 0.1), test::fmi_ok);
  EXPECT_EQ(fmu.step(0.1 + 0.1, 0.1), test::fmi_ok) << "which ends at 0.30000000000000004";
  EXPECT_EQ(fmu.step(0.3, 0.1), test::fmi_error);
  EXPECT_THAT(fmu.last_said(), HasSubstr("the step ends at 0.4; expected no later than stopTime, 0.3"));
}

TEST_F(Fmu, IsNotInstantiatedForAnotherFmu) {
  test::FmuInstance fmu(*library, "another");
  EXPECT_EQ(fmu.get(), nullptr);
  EXPECT_THAT(fmu.last_said(),
              HasSubstr("the instantiationToken is 'another', of another FMU; expected '0123"));
  EXPECT_EQ(fmu.call("fmi3Reset"), test::fmi_error) << "on no instance";
  EXPECT_EQ(fmu.step(0.0, 0.1), test::fmi_error);
}

TEST_F(Fmu, SaysWhatIsWrongToWhoAskedForNoLogAndToNobodyWhereThereIsNone) {
  test::FmuInstance fmu(*library, token(), false);
  EXPECT_EQ(fmu.set(force, 1.0), test::fmi_error);
  EXPECT_EQ(fmu.said().size(), 1U);
  void* const silent = library->instantiate("test", token().c_str(), nullptr, false, true, false, false,
                                            nullptr, 0, nullptr, nullptr, nullptr);
  const double value = 1.0;
  EXPECT_EQ(library->set(silent, &force, 1, &value, 1), test::fmi_error);
  library->free_instance(silent);
}

}  // namespace
}  // namespace kerf::bench
