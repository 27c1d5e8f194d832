#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include <kerf/psychophysics/random.h>
#include <kerf/schema/session.h>

#include "subject/subject.h"

namespace kerf::bench {

/// A seed of a session's own from that of the program: the same for the same subject and visit, another for
/// any other, so that people who are rehearsed differ as people do (FNV-1a of 64 bits over both).
[[nodiscard]] std::uint64_t rehearsal_seed(std::uint64_t seed, const schema::Session& session) noexcept;

/// A subject that feels nothing: goes on wherever it may, feels each slot in turn, and answers by chance.
/// Where that is refused time and again, as on a full disk, it leaves: nobody is there to be called. In
/// virtual time it walks through a whole session in seconds, to try a protocol out, or to look for anything
/// that gives the samples away.
class RehearsalSubject : public Subject {
 public:
  /// Shares of the trials, by chance.
  struct Mishaps {
    double slip = 0.0;  ///< taken back after the first slot, where that may be
    double unexplored =
        0.0;  ///< of the others: of a free trial the first slot alone is felt, until it is over
  };

  explicit RehearsalSubject(std::uint64_t seed, const Mishaps& mishaps) : random_(seed), mishaps_(mishaps) {}
  explicit RehearsalSubject(std::uint64_t seed) : RehearsalSubject(seed, Mishaps{}) {}

  void show(const SubjectView& view) override;
  [[nodiscard]] std::optional<SubjectAction> next() override;

 private:
  static constexpr int ticks_a_slot = 800;  ///< of polls, before it goes on to the next
  static constexpr int most_tries = 5;      ///< of leaving a stage or a trial

  [[nodiscard]] double number(const SubjectView::AskedNumber& asked);
  [[nodiscard]] SubjectAction tried(const SubjectAction& action);

  psychophysics::Random random_;
  Mishaps mishaps_;
  bool slips_ = false;   ///< in the trial at hand
  bool strays_ = false;  ///< likewise: it explores too little
  SubjectView view_;
  std::size_t slot_ = 0;
  int polls_ = 0;
  int tries_ = 0;
};

}  // namespace kerf::bench
