#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/sessions/subject/views.h"
#include "subject/subject_buttons.h"
#include "subject/subject_keys.h"
#include "subject/subject_rules.h"
#include "subject/subject_screen.h"
#include "subject/subject_words.h"

namespace kerf::bench {
namespace {

using testing::HasSubstr;

SubjectView number_trial(bool line) {
  SubjectView view = test::sequence_trial(1);
  view.labels = {"1"};
  view.answers = 1;
  view.number = {.lower = line ? 0.0 : 1e-6, .upper = line ? 100.0 : 1e9, .ends = {}};
  if (line) view.number->ends = {"soft", "hard"};
  return view;
}

std::optional<SubjectAction> typed(SubjectKeys& keys, const std::string& text) {
  std::optional<SubjectAction> last;
  for (const char key : text) last = keys.press(key);
  return last;
}

TEST(NumberKeys, GiveWhatIsTypedAtEnter) {
  SubjectKeys keys;
  keys.show(number_trial(false));
  const auto action = typed(keys, "12,5\r");
  ASSERT_TRUE(action);
  EXPECT_EQ(action->kind, SubjectAction::Kind::answer);
  EXPECT_EQ(action->number, 12.5);
  EXPECT_THAT(keys.what_keys_do(), HasSubstr("Type a number above 0, then Enter"));
}

TEST(NumberKeys, LetAMistakeBeMended) {
  SubjectKeys keys;
  keys.show(number_trial(false));
  EXPECT_EQ(typed(keys,
                  "13\x7f"
                  "2\n")
                ->number,
            12.0);
  EXPECT_FALSE(typed(keys, "0\r"));
  EXPECT_THAT(keys.hint(), HasSubstr("a number above 0"));
  EXPECT_FALSE(typed(keys, "1.2.3\r"));
  EXPECT_FALSE(typed(keys, "99\x1b\r")) << "Escape takes all of it back";
}

TEST(NumberKeys, StayWithinTheLine) {
  SubjectKeys keys;
  keys.show(number_trial(true));
  EXPECT_FALSE(typed(keys, "101\r"));
  EXPECT_THAT(keys.hint(), HasSubstr("from 0 (soft) to 100 (hard)"));
  EXPECT_EQ(typed(keys, "0\r")->number, 0.0);
}

TEST(NumberKeys, WaitUntilItMayBeAnswered) {
  SubjectKeys keys;
  SubjectView view = number_trial(false);
  view.may_answer = false;
  keys.show(view);
  EXPECT_FALSE(typed(keys, "12\r"));
  EXPECT_EQ(keys.hint(), "You cannot answer yet.");
  view.may_answer = true;
  keys.show(view);
  EXPECT_FALSE(typed(keys, "\r")) << "what was typed too early is not there";
}

TEST(NumberLines, AnswerWithANumber) {
  const SubjectView view = number_trial(false);
  EXPECT_EQ(command_of(view, "answer 7.25")->number, 7.25);
  EXPECT_FALSE(command_of(view, "answer much"));
  EXPECT_FALSE(permits(view, *command_of(view, "answer -2")));
  EXPECT_TRUE(permits(view, *command_of(view, "answer 2")));
}

TEST(NumberButtons, AnswerNothing) {
  double now = 0.0;
  ButtonSubject buttons([&] { return now; });
  buttons.show(number_trial(true));
  buttons.sample(1.0);
  for (int i = 0; i < 200; ++i) {
    now += 0.01;
    EXPECT_FALSE(buttons.next());
  }
}

TEST(NumberWords, NameStepsOnce) {
  SubjectView view = test::words_trial(1);
  view.answer_labels = {"not at all", "2", "very"};
  view.answers = 3;
  EXPECT_EQ(answer_list(view), "1 (not at all), 2 or 3 (very)");
}

}  // namespace
}  // namespace kerf::bench
