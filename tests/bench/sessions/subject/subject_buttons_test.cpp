#include "subject/subject_buttons.h"

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "views.h"

namespace kerf::bench {
namespace {

using test::in_words;

/// Buttons and a clock that goes when it is told to; polled every 5 ms.
class SubjectButtons : public testing::Test {
 protected:
  /// Holds the mask so long and gives what came of it.
  std::vector<std::string> hold(double mask, double seconds) {
    std::vector<std::string> actions;
    buttons_.sample(mask);
    for (int poll = 0; poll < std::lround(seconds / 0.005); ++poll) {
      if (const auto action = buttons_.next()) actions.push_back(in_words(action));
      now_s_ += 0.005;
    }
    return actions;
  }
  /// Pressed so long, then let go.
  std::vector<std::string> press(double mask, double seconds) {
    std::vector<std::string> actions = hold(mask, seconds);
    for (const std::string& action : hold(0, 0.1)) actions.push_back(action);
    return actions;
  }
  using Actions = std::vector<std::string>;

  double now_s_ = 100.0;
  ButtonSubject buttons_{[this] { return now_s_; }};
};

TEST_F(SubjectButtons, FeelByAShortPressAndAnswerByALongOne) {
  buttons_.show(test::free_trial(1));
  EXPECT_EQ(press(1, 0.2), Actions{"play 0"});
  EXPECT_EQ(press(2, 0.2), Actions{"play 1"});
  EXPECT_EQ(press(4, 0.7), Actions{"play 2"});
  EXPECT_EQ(press(2, 1.0), Actions{"answer 1"});
}

TEST_F(SubjectButtons, AnswerAsSoonAsThePressWasLong) {
  buttons_.show(test::free_trial(1));
  EXPECT_EQ(hold(1, 0.79), Actions{});
  EXPECT_EQ(hold(1, 0.02), Actions{"answer 0"});
  EXPECT_EQ(hold(1, 3.0), Actions{});
}

TEST_F(SubjectButtons, DoNothingWhereTheirSlotIsNoAnswer) {
  buttons_.show(test::free_trial(1));
  EXPECT_EQ(press(4, 1.0), Actions{}) << "X is no answer";
  EXPECT_EQ(press(8, 0.2), Actions{}) << "there is no fourth slot";
}

TEST_F(SubjectButtons, AnswerByAnyPressWhereEachSlotComesByItself) {
  buttons_.show(test::sequence_trial(1));
  EXPECT_EQ(hold(4, 0.05), Actions{"answer 2"});
  EXPECT_EQ(hold(4, 2.0), Actions{});
}

TEST_F(SubjectButtons, GoOnFromTextsByAnyButton) {
  buttons_.show(test::text_view(SessionStage::instructions, "Close it slowly."));
  EXPECT_EQ(press(128, 0.2), Actions{"go on"});
}

TEST_F(SubjectButtons, ConsentOnlyByALongPress) {
  buttons_.show(test::text_view(SessionStage::consent, "You may stop at any time."));
  EXPECT_EQ(press(1, 0.5), Actions{});
  EXPECT_EQ(press(1, 0.9), Actions{"go on"});
}

TEST_F(SubjectButtons, WithContactsThatBouncePressOnce) {
  buttons_.show(test::sequence_trial(1));
  Actions actions;
  for (const double mask : {1.0, 0.0, 1.0, 0.0, 1.0}) {
    for (const std::string& action : hold(mask, 0.02)) actions.push_back(action);
  }
  EXPECT_EQ(actions, Actions{}) << "20 ms are no press";
  EXPECT_EQ(hold(1, 0.1), Actions{"answer 0"});
  buttons_.show(test::sequence_trial(2));
  EXPECT_EQ(hold(0, 0.02), Actions{});
  EXPECT_EQ(hold(1, 0.1), Actions{}) << "letting go for 20 ms is not letting go";
}

TEST_F(SubjectButtons, HeldOverToTheNextScreenAreNotForIt) {
  buttons_.show(test::free_trial(1));
  EXPECT_EQ(hold(1, 0.5), Actions{});
  buttons_.show(test::free_trial(2));
  EXPECT_EQ(press(1, 0.6), Actions{});
  EXPECT_EQ(press(1, 0.2), Actions{"play 0"});
}

TEST_F(SubjectButtons, FeelNoMoreAndDoNotAnswerByAShortPressWhenTheTimeIsOver) {
  buttons_.show(test::free_trial(1));
  SubjectView over = test::free_trial(1);
  over.may_switch = false;
  buttons_.show(over);
  EXPECT_EQ(press(1, 0.2), Actions{});
  EXPECT_EQ(press(1, 0.9), Actions{"answer 0"});
}

TEST_F(SubjectButtons, TakeNoNumberThatIsNoMaskForAPress) {
  buttons_.show(test::sequence_trial(1));
  for (const double mask :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), -1.0, 1e300}) {
    EXPECT_EQ(press(mask, 1.0), Actions{});
  }
}

TEST(ButtonsChannel, IsFoundByItsName) {
  drivers::DeviceInfo device;
  EXPECT_EQ(buttons_channel(device), std::nullopt);
  device.channels = {{.name = "report_age", .unit = "s"}, {.name = "buttons", .unit = "1"}};
  EXPECT_EQ(buttons_channel(device), 1U);
}

}  // namespace
}  // namespace kerf::bench
