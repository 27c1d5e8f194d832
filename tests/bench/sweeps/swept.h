#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <kerf/schema/recording.h>

#include "plan/plan_file.h"
#include "plan/sweep_file.h"
#include "recordings/provenance.h"
#include "support/program.h"
#include "support/recordings.h"

namespace kerf::test {

/// Walls on a device: cells of well under a millisecond.
inline std::string walls(const std::string& more = "") {
  return "version = 1\nverb = \"stability\"\n" + more +
         "[cells]\nmass = [0.05, 0.1]\nseconds = 0.05\n"
         "stiffness = { from = 100, to = 100000, count = 10, scale = \"logarithmic\" }\n";
}

/// The inputs of a verb as docs/sweeps.md lists them.
inline std::vector<std::string> documented_inputs(const std::string& verb) {
  const std::string page = read_text(KERF_SOURCE_DIR "/docs/sweeps.md");
  const std::string head = "\n| `" + verb + "` | ";
  std::vector<std::string> names;
  auto at = page.find(head);
  if (at == std::string::npos) return names;
  at += head.size();
  std::string listed = page.substr(at, page.find(" | ", at) - at);
  for (auto open = listed.find('('); open != std::string::npos; open = listed.find('('))
    listed.erase(open, listed.find(')', open) + 1 - open);
  for (auto tick = listed.find('`'); tick != std::string::npos;) {
    const auto end = listed.find('`', tick + 1);
    names.push_back(listed.substr(tick + 1, end - tick - 1));
    tick = listed.find('`', end + 1);
  }
  return names;
}

/// A folder with a sweep in it, w.toml, and what is run of it.
class SweepFolder : public testing::Test {
 protected:
  [[nodiscard]] std::filesystem::path file(const std::string& name) const { return folder_ / name; }

  bench::PlanFile plan_of(const std::string& toml, const std::string& name = "w") const {
    write_text(file(name + ".toml"), toml);
    const auto plan = file(name + ".plan.json");
    bench::SweepPlan read = bench::read_sweep(file(name + ".toml"));
    if (read.shards == 0) read.shards = 1;
    bench::write_plan(plan, read, std::nullopt, true);
    return bench::read_plan(plan);
  }

  /// Three laws with noise of many seeds on one recording of 2,000 rows.
  bench::PlanFile fits(unsigned seeds, const std::string& more = "") const {
    schema::write_recording(file("r.h5"), punch({.seconds = 2.0}));
    return plan_of(
        "version = 1\nverb = \"fit\"\n" + more +
        "[cells]\nrecording = \"r.h5\"\nlaw = [\"kelvin\", \"exponential\"]\nfolds = 0\nnoise = 0.01\n"
        "seed = { from = 1, to = " +
        std::to_string(seeds) + " }\n");
  }

  [[nodiscard]] Outcome sweep(std::vector<std::string> words) const {
    words.insert(words.begin(), "sweep");
    return run_kerf(words);
  }
  [[nodiscard]] Outcome run_it(std::vector<std::string> more = {}, const std::string& name = "w") const {
    more.insert(more.begin(), {"run", file(name + ".plan.json").string()});
    return sweep(more);
  }
  /// With KERF_SWEEP_FAULT.
  [[nodiscard]] Outcome run_with(const std::string& fault, std::vector<std::string> more = {}) const {
    more.insert(more.begin(), {"/usr/bin/env", "KERF_SWEEP_FAULT=" + fault, KERF_PROGRAM, "sweep", "run",
                               file("w.plan.json").string()});
    return run(more);
  }

  /// Name and content (of sweep.h5 its hash) of every file that the shards in a folder merge to, but for
  /// times.csv.
  [[nodiscard]] std::map<std::string, std::string> merged(const std::string& shards = "w.shards",
                                                          int status = 0) const {
    const auto output = file("merged");
    std::filesystem::remove_all(output);
    const Outcome outcome = sweep(
        {"merge", file("w.plan.json").string(), "--folder", file(shards).string(), "-o", output.string()});
    EXPECT_EQ(outcome.exit_status, status) << outcome.errors << outcome.output;
    std::map<std::string, std::string> files;
    if (!std::filesystem::exists(output)) return files;
    for (const auto& entry : std::filesystem::directory_iterator(output))
      if (entry.path().filename() != "times.csv")
        files[entry.path().filename().string()] =
            entry.path().extension() == ".h5" ? bench::sha256_of(entry.path()) : read_text(entry.path());
    return files;
  }

  TemporaryFolder folder_;
};

}  // namespace kerf::test
