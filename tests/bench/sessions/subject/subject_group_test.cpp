#include "subject/subject_group.h"

#include <deque>

#include <gtest/gtest.h>

#include "views.h"

namespace kerf::bench {
namespace {

struct ScriptedSubject final : Subject {
  void show(const SubjectView& view) override {
    if (view.trial != trial) actions.clear();
    trial = view.trial;
  }
  [[nodiscard]] std::optional<SubjectAction> next() override {
    if (actions.empty()) return std::nullopt;
    const SubjectAction action = actions.front();
    actions.pop_front();
    return action;
  }
  std::size_t trial = 0;
  std::deque<SubjectAction> actions;
};

TEST(SubjectGroup, ShowsTheViewToAllAndTakesTheFirstAction) {
  ScriptedSubject page;
  ScriptedSubject keyboard;
  SubjectGroup group({&page, &keyboard});
  group.show(test::free_trial(7));
  EXPECT_EQ(page.trial, 7U);
  EXPECT_EQ(keyboard.trial, 7U);
  EXPECT_EQ(test::in_words(group.next()), "nothing");
  keyboard.actions.push_back({.kind = SubjectAction::Kind::answer, .slot = 1});
  EXPECT_EQ(test::in_words(group.next()), "answer 1");
}

TEST(SubjectGroup, DropsASecondAnswerToTheSameTrial) {
  ScriptedSubject page;
  ScriptedSubject keyboard;
  SubjectGroup group({&page, &keyboard});
  group.show(test::free_trial(7));
  page.actions.push_back({.kind = SubjectAction::Kind::answer, .slot = 0});
  keyboard.actions.push_back({.kind = SubjectAction::Kind::answer, .slot = 1});
  EXPECT_EQ(test::in_words(group.next()), "answer 0");
  group.show(test::free_trial(8));
  EXPECT_EQ(test::in_words(group.next()), "nothing");
}

}  // namespace
}  // namespace kerf::bench
