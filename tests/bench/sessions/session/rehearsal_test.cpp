#include "session/rehearsal.h"

#include <map>

#include <gtest/gtest.h>

namespace kerf::bench {
namespace {

TEST(Rehearsal, AnswersALineFromOneEndToTheOther) {
  SubjectView view{.stage = SessionStage::trial, .may_answer = true, .trial = 1};
  view.number = SubjectView::AskedNumber{.lower = 1.0, .upper = 7.0, .step = 1.0, .ends = {"soft", "hard"}};
  std::map<double, int> given;
  for (std::uint64_t seed = 1; seed <= 700; ++seed) {
    RehearsalSubject subject(seed);
    subject.show(view);
    const auto action = subject.next();
    ASSERT_TRUE(action);
    ASSERT_EQ(action->kind, SubjectAction::Kind::answer);
    ASSERT_TRUE(view.number->takes(action->number)) << action->number;
    ++given[action->number];
  }
  ASSERT_EQ(given.size(), 7U);
  // 100 of each expected, with a standard deviation of 9.
  for (const auto& [number, times] : given) EXPECT_NEAR(times, 100, 40) << number;
}

}  // namespace
}  // namespace kerf::bench
