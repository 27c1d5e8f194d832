#pragma once

#include <cstddef>
#include <optional>

#include <kerf/psychophysics/random.h>

#include "subject/subject.h"

namespace kerf::bench {

/// A subject that feels nothing: goes on wherever it may, feels each slot in turn, and answers by chance.
/// Where that is refused time and again, as on a full disk, it leaves: nobody is there to be called. In
/// virtual time it walks through a whole session in seconds, to try a protocol out, or to look for anything
/// that gives the samples away.
class RehearsalSubject : public Subject {
 public:
  explicit RehearsalSubject(std::uint64_t seed) : random_(seed) {}

  void show(const SubjectView& view) override;
  [[nodiscard]] std::optional<SubjectAction> next() override;

 private:
  static constexpr int ticks_a_slot = 800;  ///< of polls, before it goes on to the next
  static constexpr int most_tries = 5;      ///< of leaving a stage or a trial

  [[nodiscard]] SubjectAction tried(const SubjectAction& action);

  psychophysics::Random random_;
  SubjectView view_;
  std::size_t slot_ = 0;
  int polls_ = 0;
  int tries_ = 0;
};

}  // namespace kerf::bench
