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

namespace kerf::bench::test {

/// A session in a folder of its own, to be run in virtual time on simulated scissors.
class BlindRun {
 public:
  explicit BlindRun(const Protocol& protocol, std::uint64_t seed = 1)
      : BlindRun(protocol, make_plans(protocol, 1, seed).front()) {}
  BlindRun(const Protocol& protocol, Plan plan) : key_(key_of('k')) {
    SessionStore::create(file_, {.protocol = protocol, .subject = "S01", .plan = std::move(plan)}, key_, {},
                         false);
  }

  [[nodiscard]] const std::filesystem::path& file() const { return file_; }
  [[nodiscard]] SessionStore store(SessionStore::Purpose purpose) const { return {file_, key_, purpose}; }
  [[nodiscard]] SessionStore read() const { return store(SessionStore::Purpose::read); }

  /// To its end, or to where the subject leaves it.
  SessionRunResult run(Subject& subject, SessionRunOptions options = {}) {
    SessionStore running = store(SessionStore::Purpose::run);
    const SessionRunResult result = run(running, subject, std::move(options));
    running.close();
    return result;
  }
  static SessionRunResult run(SessionStore& running, Subject& subject, SessionRunOptions options = {}) {
    options.loop.device_uri = "sim:scissors";
    options.loop.virtual_time = true;
    const std::atomic<bool> stop = false;
    return run_session(running, subject, options, stop);
  }

 private:
  kerf::test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "s01.h5";
  SealKey key_;
};

/// Answers by chance, and keeps what it was shown, in words.
class WatchingSubject : public RehearsalSubject {
 public:
  explicit WatchingSubject(std::uint64_t seed = 1) : RehearsalSubject(seed) {}
  void show(const SubjectView& view) override {
    seen.push_back(fmt::format("{} | {} | {} | {} | {} | {}{}{}{} | {} | {}", name_of(view.stage),
                               heading(view), text_below(view), progress(view), what_plays(view),
                               view.may_switch, view.may_answer, view.may_go_on, view.practice, view.wait_s,
                               view.notice));
    RehearsalSubject::show(view);
  }
  std::vector<std::string> seen;
};

/// Does what it is told in each view, and keeps the last one.
class ScriptedSubject : public Subject {
 public:
  using Script = std::function<std::optional<SubjectAction>(const SubjectView&)>;
  explicit ScriptedSubject(Script script) : script_(std::move(script)) {}
  void show(const SubjectView& view) override { view_ = view; }
  std::optional<SubjectAction> next() override { return script_(view_); }
  [[nodiscard]] const SubjectView& view() const { return view_; }

 private:
  Script script_;
  SubjectView view_;
};

}  // namespace kerf::bench::test
