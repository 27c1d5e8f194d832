#pragma once

#include <filesystem>
#include <string>

#include "bench/sessions/protocol/written_protocol.h"
#include "bench/sessions/sealed/sealed_session.h"
#include "sealed/session_store.h"

namespace kerf::test {

/// A session of two samples, ABX, of three trials.
inline bench::SessionSetUp set_up(const std::string& top = "design = \"abx\"\ntrials = 2\n",
                                  const std::string& tables = "") {
  bench::SessionSetUp up{.protocol = protocol_from(protocol_text(top, tables)),
                         .subject = "S2",
                         .number = 2,
                         .subjects = 3,
                         .plan = {}};
  up.protocol.samples[1].gain = 0.1 + 0.2;
  up.plan = {{.pair = {0, 1}, .slots = {0, 1, 0}, .practice = true},
             {.pair = {0, 1}, .slots = {1, 0, 1}},
             {.pair = {0, 1}, .slots = {0, 1, 1}}};
  return up;
}

/// An answered trial with a trace in which A, then B is played.
inline bench::RecordedTrial answered(const bench::TrialPlan& what, std::size_t answer,
                                     std::size_t ticks = 40) {
  bench::RecordedTrial trial{.what = what,
                             .answer = answer,
                             .response_s = 3.25,
                             .switches = 1,
                             .at = "2026-01-31T12:00:00Z",
                             .axes = {{.name = "theta", .position_unit = "rad", .force_unit = "N"}},
                             .trace = {},
                             .channels = {}};
  for (std::size_t i = 0; i < ticks; ++i) {
    const double x = static_cast<double>(i);
    bench::TraceRow tick{.row = {.tick = i, .time_s = 0.001 * x},
                         .slot = static_cast<std::uint8_t>(i < 10   ? 255
                                                           : i < 20 ? 0
                                                                    : 1)};
    tick.row.position[0] = 0.5 - 0.001 * x;
    tick.row.velocity[0] = -1.0;
    tick.row.force_commanded[0] = x / 3.0;
    trial.trace.push_back(tick);
  }
  return trial;
}

/// A session file in a folder of its own, made but not run.
class StoredSession {
 public:
  explicit StoredSession(const bench::SessionSetUp& up = set_up()) : key_(key_of('k')) {
    bench::SessionStore::create(file_, up, key_, {}, false);
  }
  [[nodiscard]] const std::filesystem::path& file() const { return file_; }
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_.path(); }
  [[nodiscard]] const bench::SealKey& key() const { return key_; }
  [[nodiscard]] bench::SessionStore run() const { return {file_, key_, bench::SessionStore::Purpose::run}; }
  [[nodiscard]] bench::SessionStore read() const { return {file_, key_, bench::SessionStore::Purpose::read}; }

 private:
  TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "s2.session.h5";
  bench::SealKey key_;
};

}  // namespace kerf::test
