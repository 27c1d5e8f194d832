#include "fits/batch.h"

#include <filesystem>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "support/program.h"
#include "support/recordings.h"

namespace kerf::bench {
namespace {

using nlohmann::json;
using test::Outcome;
using test::run_kerf;
using testing::HasSubstr;

class Batch : public testing::Test {
 protected:
  void add(const std::string& name, const test::Tissue& tissue) {
    const auto file = folder_ / ("in/" + name);
    std::filesystem::create_directories(file.parent_path());
    schema::write_recording(file, test::punch(tissue));
  }
  /// `count` recordings of one second, of tissues that differ.
  void add_many(unsigned count) {
    for (unsigned i = 0; i < count; ++i) {
      add(fmt::format("{}/r{:02}.h5", i % 2 == 0 ? "even" : "odd", i),
          {.parallel_stiffness = 200.0 + 10.0 * i, .seconds = 1.0, .seed = i});
    }
  }
  Outcome fit(const std::string& out, std::vector<std::string> more = {}) {
    more.insert(more.begin(), {"fit", "--batch", (folder_ / "in").string(), "-o", (folder_ / out).string(),
                               "--models", "kelvin,exponential", "--folds", "2"});
    return run_kerf(more);
  }
  [[nodiscard]] std::string table(const std::string& out) const {
    return test::read_text(folder_ / (out + "/batch.csv"));
  }
  test::TemporaryFolder folder_;
};

TEST_F(Batch, GivesTheSameTableWhateverTheNumberOfJobs) {
  add_many(24);
  test::write_text(folder_ / "in/odd/broken.h5", "no recording");
  for (const auto* jobs : {"1", "2", "5"}) EXPECT_EQ(fit(jobs, {"--jobs", jobs}).exit_status, 1);
  const std::string one = table("1");
  EXPECT_EQ(std::count(one.begin(), one.end(), '\n'), 1 + 2 * 24 + 1);
  EXPECT_EQ(one, table("2"));
  EXPECT_EQ(one, table("5"));
}

TEST_F(Batch, GoesOnAfterWhatCannotBeFittedAndListsIt) {
  add("a.h5", {.seconds = 1.0});
  add("still.h5", {.depth_m = 0.0, .seconds = 1.0});
  test::write_text(folder_ / "in/broken.h5", "no recording");
  schema::Recording forceless = test::punch({.seconds = 1.0});
  forceless.force_measured.clear();
  schema::write_recording(folder_ / "in/forceless.h5", forceless);

  const Outcome outcome = fit("out", {"--json"});
  EXPECT_EQ(outcome.exit_status, 1);
  EXPECT_THAT(outcome.errors, HasSubstr("still.h5: cannot fit: the position is constant"));
  EXPECT_THAT(outcome.errors, HasSubstr("forceless.h5: the recording holds no force"));
  const json all = json::parse(outcome.output);
  EXPECT_EQ(all.at("failed"), 3);
  EXPECT_EQ(all.at("recordings").at(0).at("recording"), "a.h5");
  EXPECT_TRUE(all.at("recordings").at(0).at("failure").is_null());
  EXPECT_EQ(all, json::parse(test::read_text(folder_ / "out/batch.json")));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out/a/kelvin.law.toml"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out/still"));
  EXPECT_THAT(table("out"), HasSubstr("broken.h5,,failed,"));
}

TEST_F(Batch, EveryRowOfTheTableHasEveryColumn) {
  add("a, \"b\".h5", {.seconds = 1.0});
  add("still.h5", {.depth_m = 0.0, .seconds = 1.0});
  test::write_text(folder_ / "in/broken.h5", "no recording");
  (void)fit("out");
  std::istringstream lines(table("out"));
  std::set<std::ptrdiff_t> commas;
  for (std::string line; std::getline(lines, line);) {
    bool quoted = false;
    std::ptrdiff_t count = 0;
    for (const char c : line) {
      if (c == '"') quoted = !quoted;
      if (c == ',' && !quoted) ++count;
    }
    commas.insert(count);
  }
  EXPECT_EQ(commas.size(), 1U);
  EXPECT_THAT(table("out"), HasSubstr("parallel_stiffness,parallel_stiffness_ci95_lower"));
}

TEST_F(Batch, ReplacesNothingUnasked) {
  add("a.h5", {.seconds = 1.0});
  EXPECT_EQ(fit("out").exit_status, 0);
  const Outcome again = fit("out");
  EXPECT_EQ(again.exit_status, 2);
  EXPECT_THAT(again.errors, HasSubstr("batch.csv exists; --force replaces it"));
  std::filesystem::remove(folder_ / "out/batch.csv");
  std::filesystem::remove(folder_ / "out/batch.json");
  EXPECT_EQ(fit("out").exit_status, 1) << "a law file that somebody may have edited";
  EXPECT_EQ(fit("out", {"--force"}).exit_status, 0);
}

TEST_F(Batch, SaysWhatAFolderLacks) {
  std::filesystem::create_directory(folder_ / "in");
  test::write_text(folder_ / "in/data.csv", "1,2,3\n");
  EXPECT_THAT(fit("out").errors, HasSubstr("holds no recordings (*.h5); 'kerf import' makes them from text"));
  EXPECT_EQ(fit("out", {(folder_ / "in/data.csv").string()}).exit_status, 2) << "a folder or recordings";
  EXPECT_EQ(run_kerf({"fit", "-o", (folder_ / "out").string()}).exit_status, 2);
  EXPECT_EQ(run_kerf({"fit", "x.h5", "--jobs", "2", "-o", (folder_ / "out").string()}).exit_status, 2);
}

TEST_F(Batch, BeginsNothingOnceItIsStopped) {
  add_many(3);
  const std::atomic<bool> stop{true};
  std::atomic<std::size_t> done{0};
  const auto entries =
      run_batch(recordings_in(folder_ / "in"),
                {.folder = folder_ / "in", .output = folder_ / "out", .jobs = 2}, stop, done);
  ASSERT_EQ(entries.size(), 3U);
  EXPECT_EQ(done, 3U);
  for (const BatchEntry& entry : entries) EXPECT_THAT(entry.failure, HasSubstr("the batch was stopped"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
}

}  // namespace
}  // namespace kerf::bench
