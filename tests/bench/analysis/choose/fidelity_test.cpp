#include "choose/fidelity.h"

#include <atomic>
#include <cmath>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

const std::atomic<bool> go_on{false};

/// A shipped scene, its tissue so many times as viscous.
Scene scalpel(const char* path, double times) {
  Scene scene = read_scene(std::string(KERF_SOURCE_DIR) + "/examples/scenes/scalpel-" + path + ".scene.toml");
  std::vector<double> values = scene.tissue.law.values();
  for (double& value : values) value *= times;
  scene.tissue.law = models::Law::make("blade", values, scene.tissue.law.options());
  return scene;
}

const Candidate& named(const LawChoice& choice, const std::string& name) {
  for (const Candidate& one : choice.candidates) {
    if (one.law.name == name) return one;
  }
  throw std::logic_error("no candidate " + name);
}

TEST(ChooseFidelity, LeavesRotationOutWhereTheBladeDoesNotTurn) {
  const LawChoice choice = choose_fidelity(scalpel("t1", 1.0), {}, go_on);
  EXPECT_TRUE(choice.serves);
  EXPECT_EQ(choice.effects.at(0).matter, Matter::does_not);
  EXPECT_LT(named(choice, "blade-paper-64").error_jnd, 1e-9);
}

TEST(ChooseFidelity, TakesRotationInWhereItIsFelt) {
  const LawChoice choice = choose_fidelity(scalpel("t2", 100.0), {}, go_on);
  EXPECT_TRUE(choice.serves);
  EXPECT_EQ(choice.effects.at(0).matter, Matter::matters);
  // The strips of the paper feel nothing of a turn about the main axis: they miss all of it.
  EXPECT_GT(named(choice, "blade-paper-64").error_jnd, 1.0);
  EXPECT_TRUE(choice.candidates.at(choice.taken.value()).law.effects.contains(Effect::rotation));
  EXPECT_LT(named(choice, "blade-strips-64").error_jnd, named(choice, "blade-strips-2").error_jnd);
}

TEST(ChooseFidelity, LeavesOutWhatIsTooWeakToBeFelt) {
  const LawChoice choice = choose_fidelity(scalpel("t2", 1.0), {}, go_on);
  EXPECT_EQ(choice.effects.at(0).matter, Matter::does_not);
}

TEST(ChooseFidelity, RefusesAScriptThatMissesTheTissue) {
  Scene scene = scalpel("t1", 1.0);
  scene.trajectory.seconds = 0.0;
  EXPECT_THROW((void)choose_fidelity(scene, {}, go_on), std::invalid_argument);
}

}  // namespace
}  // namespace kerf::bench
