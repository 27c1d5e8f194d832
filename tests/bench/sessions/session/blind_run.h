#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "bench/sessions/protocol/written_protocol.h"
#include "bench/sessions/sealed/sealed_session.h"
#include "session/rehearsal.h"
#include "session/run_session.h"
#include "subject/subject_words.h"

namespace kerf::test {

/// A session in a folder of its own, to be run in virtual time on simulated scissors.
class BlindRun {
 public:
  explicit BlindRun(const bench::Protocol& protocol, std::uint64_t seed = 1)
      : BlindRun(protocol, make_plans(protocol, 1, seed).front()) {}
  BlindRun(const bench::Protocol& protocol, bench::Plan plan) : key_(key_of('k')) {
    bench::SessionStore::create(file_, {.protocol = protocol, .subject = "S01", .plan = std::move(plan)},
                                key_, {}, false);
  }

  [[nodiscard]] const std::filesystem::path& file() const { return file_; }
  [[nodiscard]] bench::SessionStore store(bench::SessionStore::Purpose purpose) const {
    return {file_, key_, purpose};
  }
  [[nodiscard]] bench::SessionStore read() const { return store(bench::SessionStore::Purpose::read); }

  /// To its end, or to where the subject leaves it.
  bench::SessionRunResult run(bench::Subject& subject, bench::SessionRunOptions options = {}) {
    bench::SessionStore running = store(bench::SessionStore::Purpose::run);
    bench::SessionRunResult result = run(running, subject, std::move(options));
    running.close();
    return result;
  }
  static bench::SessionRunResult run(bench::SessionStore& running, bench::Subject& subject,
                                     bench::SessionRunOptions options = {}) {
    options.loop.virtual_time = true;
    const std::atomic<bool> stop = false;
    return run_session(running, subject, options, stop);
  }

 private:
  TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "s01.h5";
  bench::SealKey key_;
};

/// Answers by chance, and keeps what it was shown, in words.
class WatchingSubject : public bench::RehearsalSubject {
 public:
  explicit WatchingSubject(std::uint64_t seed = 1) : bench::RehearsalSubject(seed) {}
  void show(const bench::SubjectView& view) override {
    seen.push_back(fmt::format("{} | {} | {} | {} | {} | {}{}{}{} | {} | {}", name_of(view.stage),
                               heading(view), text_below(view), progress(view), what_plays(view),
                               view.may_switch, view.may_answer, view.may_go_on, view.practice, view.wait_s,
                               view.notice));
    bench::RehearsalSubject::show(view);
  }
  std::vector<std::string> seen;
};

/// Does what it is told in each view, and keeps the last one.
class ScriptedSubject : public bench::Subject {
 public:
  using Script = std::function<std::optional<bench::SubjectAction>(const bench::SubjectView&)>;
  explicit ScriptedSubject(Script script) : script_(std::move(script)) {}
  void show(const bench::SubjectView& view) override { view_ = view; }
  std::optional<bench::SubjectAction> next() override { return script_(view_); }
  [[nodiscard]] const bench::SubjectView& view() const { return view_; }

 private:
  Script script_;
  bench::SubjectView view_;
};

}  // namespace kerf::test
