// What subject and experimenter can see of a session: screens, files, names, timing, the process. Does any of
// it tell which sample is which?

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cmath>
#include <numeric>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "bench/sessions/session/blind_run.h"
#include "signal/quantiles.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;
using kerf::test::example_protocol;

const std::string quick =
    "presentation = \"sequence\"\ninterval = { value = 150, unit = \"ms\" }\ngap = { value = 50, unit = "
    "\"ms\" }\n"
    "ramp = { value = 50, unit = \"ms\" }\n";

/// Every slot plays the other sample.
Plan opposite(Plan plan) {
  for (TrialPlan& trial : plan) {
    for (std::uint8_t& sample : trial.slots) sample = static_cast<std::uint8_t>(1 - sample);
  }
  return plan;
}

std::vector<std::size_t> sizes_of_sealed(const fs::path& file) {
  std::vector<std::size_t> sizes;
  for (const schema::SessionEntry& entry : schema::read_session(file).entries)
    sizes.push_back(entry.sealed.size());
  return sizes;
}

std::vector<std::string> texts_of(const fs::path& file) {
  std::vector<std::string> texts;
  for (const schema::SessionEntry& entry : schema::read_session(file).entries)
    texts.push_back(entry.kind + ": " + entry.text);
  return texts;
}

TEST(Blindness, ShowsTheSameForOppositeOrders) {
  for (const char* name : {"preference", "abx", "2ifc", "3ifc", "constant"}) {
    SCOPED_TRACE(name);
    Protocol protocol = example_protocol(name);
    protocol.trials = 4;
    protocol.practice = 0;  // whose feedback is meant to tell
    const Plan plan = make_plans(protocol, 1, 3).front();
    test::BlindRun one(protocol, plan);
    test::BlindRun other(protocol, opposite(plan));
    test::WatchingSubject first;
    test::WatchingSubject second;
    (void)one.run(first);
    (void)other.run(second);
    EXPECT_EQ(first.seen, second.seen) << "every screen, in its order";
    EXPECT_EQ(sizes_of_sealed(one.file()), sizes_of_sealed(other.file()));
    EXPECT_EQ(texts_of(one.file()), texts_of(other.file()));
  }
}

/// What can be measured of one trial from outside, a number each.
using Features = std::vector<double>;

struct SeenTrial {
  Features features;
  bool second_first = false;  ///< the truth: slot 1 plays the second sample
};

double bits_in(const std::vector<std::uint8_t>& bytes) {
  return std::accumulate(bytes.begin(), bytes.end(), 0.0,
                         [](double sum, std::uint8_t byte) { return sum + std::popcount(byte); }) /
         static_cast<double>(bytes.size());
}

/// How often a byte follows another of the same upper half: forces in the clear would show in it.
double order_in(const std::vector<std::uint8_t>& bytes) {
  double same = 0.0;
  for (std::size_t i = 1; i < bytes.size(); ++i) same += (bytes[i] >> 4U) == (bytes[i - 1] >> 4U) ? 1.0 : 0.0;
  return same / static_cast<double>(bytes.size());
}

double files_in(const fs::path& folder) {
  return static_cast<double>(std::distance(fs::directory_iterator(folder), fs::directory_iterator{}));
}

/// Watches a session from outside while it runs: how long each tick takes while a slot plays, which files are
/// open.
class Onlooker : public test::WatchingSubject {
 public:
  struct Trial {
    std::array<std::vector<double>, max_slots> tick_s;
    double storing_s = 0.0;
    double shown = 0.0;  ///< characters
    double open_files = 0.0;
  };

  explicit Onlooker(std::uint64_t seed) : WatchingSubject(seed) {}

  void show(const SubjectView& view) override {
    const auto now = std::chrono::steady_clock::now();
    if (view.stage == SessionStage::trial) {
      if (trials.size() < view.trial) {
        if (!trials.empty()) trials.back().storing_s = std::chrono::duration<double>(now - last_).count();
        trials.resize(view.trial);
      }
      trials.back().open_files = files_in("/proc/self/fd");
    }
    playing_ = view.playing;
    last_ = now;
    WatchingSubject::show(view);
    if (!trials.empty()) trials.back().shown += static_cast<double>(seen.back().size());
  }
  void begin_tick() { begin_ = std::chrono::steady_clock::now(); }
  void end_tick() {
    if (!playing_ || trials.empty()) return;
    trials.back().tick_s[*playing_].push_back(
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count());
  }

  std::vector<Trial> trials;

 private:
  std::optional<std::size_t> playing_;
  std::chrono::steady_clock::time_point begin_;
  std::chrono::steady_clock::time_point last_;
};

double typical(const std::vector<double>& values) { return values.empty() ? 0.0 : median(values); }

/// One session, watched.
std::vector<SeenTrial> watch(const Protocol& protocol, std::uint64_t seed) {
  test::BlindRun session(protocol, seed);
  Onlooker onlooker(seed);
  SessionRunOptions watched{.each_sample = [&](const drivers::Sample&) { onlooker.begin_tick(); }};
  watched.loop.each_row = [&](const schema::Row&) { onlooker.end_tick(); };
  (void)session.run(onlooker, watched);
  const schema::Session file = schema::read_session(session.file());
  const SessionStore store = session.read();
  std::vector<SeenTrial> seen;
  std::size_t at = 0;
  for (const schema::SessionEntry& entry : file.entries) {
    if (entry.kind != "trial") continue;
    const Onlooker::Trial& trial = onlooker.trials[at];
    const double first_s = typical(trial.tick_s[0]);
    const double second_s = typical(trial.tick_s[1]);
    seen.push_back(
        {.features = {static_cast<double>(entry.sealed.size()), static_cast<double>(entry.text.size()),
                      bits_in(entry.sealed), order_in(entry.sealed),
                      static_cast<double>(entry.sealed.front()), static_cast<double>(entry.sealed.back()),
                      first_s, second_s, first_s / second_s, trial.storing_s, trial.shown, trial.open_files,
                      files_in(session.file().parent_path())},
         .second_first = store.plan()[at].slots[0] == 1});
    ++at;
  }
  return seen;
}

/// Learns on the first half of the trials, and guesses the second: logistic regression by gradient descent
/// over standardised features. Returns how many of the second half it guesses right.
std::size_t guesses_right(std::vector<SeenTrial> trials) {
  const std::size_t features = trials.front().features.size();
  const std::size_t half = trials.size() / 2;
  for (std::size_t f = 0; f < features; ++f) {
    double mean = 0.0;
    double square = 0.0;
    for (const SeenTrial& trial : trials) mean += trial.features[f] / static_cast<double>(trials.size());
    for (const SeenTrial& trial : trials) square += (trial.features[f] - mean) * (trial.features[f] - mean);
    const double deviation = std::sqrt(square / static_cast<double>(trials.size()));
    for (SeenTrial& trial : trials)
      trial.features[f] =
          deviation > 0.0 ? std::clamp((trial.features[f] - mean) / deviation, -4.0, 4.0) : 0.0;
  }
  std::vector<double> weights(features + 1);
  const auto score = [&](const SeenTrial& trial) {
    return std::inner_product(trial.features.begin(), trial.features.end(), weights.begin(), weights.back());
  };
  for (int step = 0; step < 500; ++step) {
    std::vector<double> slope(features + 1);
    for (std::size_t i = 0; i < half; ++i) {
      const double error = (trials[i].second_first ? 1.0 : 0.0) - 1.0 / (1.0 + std::exp(-score(trials[i])));
      for (std::size_t f = 0; f < features; ++f) slope[f] += error * trials[i].features[f];
      slope[features] += error;
    }
    for (std::size_t f = 0; f <= features; ++f) weights[f] += slope[f] / static_cast<double>(half);
  }
  return static_cast<std::size_t>(
      std::count_if(trials.begin() + static_cast<std::ptrdiff_t>(half), trials.end(),
                    [&](const SeenTrial& trial) { return (score(trial) > 0.0) == trial.second_first; }));
}

TEST(Blindness, NobodyWhoSeesEverythingButTheForceGuessesTheSamples) {
  // One of the laws costs many times the other, so that timing has something to tell.
  const Protocol protocol = bench::parse_protocol(
      "name = \"cheap or dear\"\ndesign = \"preference\"\nquestion = \"Which?\"\ntrials = 40\n" + quick +
          "[[sample]]\nname = \"cheap\"\nlaw = \"scissors\"\n[[sample]]\nname = \"dear\"\nlaw = "
          "\"scissors_mesh\"\n",
      "p.protocol.toml", [](const std::string& name) {
        return kerf::test::read_text(fmt::format("{}/examples/{}.law.toml", KERF_SOURCE_DIR, name));
      });
  std::vector<SeenTrial> trials;
  for (std::uint64_t seed = 1; trials.size() < 2000; ++seed) {
    for (SeenTrial& trial : watch(protocol, seed)) trials.push_back(std::move(trial));
  }
  const std::size_t right = guesses_right(trials);
  RecordProperty("right_of_1000", static_cast<int>(right));
  // By chance 500 of 1,000; more than 577 or less than 423 happens once in a million.
  EXPECT_GT(right, 423U);
  EXPECT_LT(right, 577U);
  // An entry that were four ticks longer for one of the laws would do; of less, the test before tells.
  for (SeenTrial& trial : trials) trial.features[0] += trial.second_first ? 400.0 : 0.0;
  EXPECT_GT(guesses_right(trials), 950U) << "it finds a leak where there is one";
}

}  // namespace
}  // namespace kerf::bench
