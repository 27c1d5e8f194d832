#include "prepare/prepare.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "laws/render.h"

namespace kerf::bench {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

/// Two presses along a decreasing position into a spring of 1000 N/m at 5 mm, on a sensor with bias and
/// drift.
schema::Recording presses() {
  std::mt19937_64 random(8);
  std::normal_distribution<double> normal(0.0, 0.02);
  schema::Recording recording;
  recording.header = schema::new_header("kerf test");
  recording.axes = {{.name = "depth"}};
  for (int i = 0; i < 10'000; ++i) {
    const double t = 1e-3 * i;
    const double in_period = std::fmod(t, 5.0);
    const double x = 0.010 - 0.01 * std::clamp(std::min(in_period - 1.0, 4.0 - in_period), 0.0, 1.0);
    recording.time.push_back(t);
    recording.tick.push_back(static_cast<std::uint64_t>(i));
    recording.position.push_back(x);
    recording.velocity.push_back(0.0);
    recording.force_measured.push_back(0.4 + 0.01 * t + 1000.0 * std::max(0.0, 0.005 - x) + normal(random));
  }
  return recording;
}

TEST(Prepare, StoresTheContactWhereTheFitLooksForIt) {
  const Prepared prepared = prepare(presses(), {.bias = true, .drift = true, .onset = true});
  const schema::Recording& recording = prepared.recording;
  ASSERT_EQ(prepared.contacts->contacts.size(), 2U);
  EXPECT_EQ(prepared.contact_signal, "depth");
  const models::Contact contact = contact_of(recording, 0);
  EXPECT_NEAR(contact.position, 0.005, 2e-5);
  EXPECT_EQ(contact.direction, -1.0);
  EXPECT_GT(recording.axes[0].contact_error, 1e-7);
  EXPECT_LT(recording.axes[0].contact_error, 2e-5);
  EXPECT_EQ(std::ranges::count(recording.events, "contact", &schema::Event::kind), 2);
  EXPECT_EQ(std::ranges::count(recording.events, "release", &schema::Event::kind), 2);
  EXPECT_NEAR(prepared.bias->axes[0].offset, 0.4, 0.005);
  EXPECT_NEAR(prepared.bias->axes[0].drift_per_minute, 0.6, 0.05);
}

TEST(Prepare, NotesEveryStepInTheOrderInWhichItWasDone) {
  schema::Recording made = presses();
  made.header.history = "before\n";
  made.force_measured[3000] = std::nan("");
  const Prepared prepared = prepare(std::move(made), {.drop_gaps = true,
                                                      .bias = true,
                                                      .onset = true,
                                                      .filter = parse_filter("butterworth2:20", false),
                                                      .to_s = 6.0});
  const std::string& history = prepared.recording.header.history;
  std::size_t at = 0;
  for (const char* step : {"before", "1 of 10000 rows left out", "bias taken off", "2 contacts",
                           "filter butterworth2:20Hz zero-phase", "rows from 0 to 6 s kept"}) {
    const std::size_t found = history.find(step, at);
    ASSERT_NE(found, std::string::npos) << step << " in\n" << history;
    at = found;
  }
  EXPECT_EQ(prepared.recording.rows(), 6000U);
  EXPECT_EQ(std::count(history.begin(), history.end(), '\n'), 6);
}

TEST(Prepare, RefusesWhatCannotBeDone) {
  const auto attempt = [](const PrepareOptions& options) {
    return [options] { (void)prepare(presses(), options); };
  };
  EXPECT_THAT(attempt({}), ThrowsMessage<std::invalid_argument>(HasSubstr("nothing to do")));
  EXPECT_THAT(attempt({.from_s = 20.0}), ThrowsMessage<std::invalid_argument>(HasSubstr("keeps no row")));
  EXPECT_THAT(attempt({.cycles = {1}}), ThrowsMessage<std::invalid_argument>(HasSubstr("kerf segment")));
  EXPECT_THAT(attempt({.onset = true, .axis = "y"}),
              ThrowsMessage<std::invalid_argument>(HasSubstr("depth")));
  EXPECT_THAT(attempt({.onset = true, .signal = {"fx"}}),
              ThrowsMessage<std::invalid_argument>(HasSubstr("no axis or channel 'fx'")));
  EXPECT_THAT(attempt({.labels = Labels{.channel = "label", .value = 3.0}}),
              ThrowsMessage<std::invalid_argument>(HasSubstr("no channel 'label'")));
}

}  // namespace
}  // namespace kerf::bench
