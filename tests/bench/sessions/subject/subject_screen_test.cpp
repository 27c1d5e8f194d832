#include "subject/subject_screen.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "subject/subject_keys.h"
#include "subject/subject_words.h"
#include "views.h"

namespace kerf::bench {
namespace {

using testing::Contains;
using testing::ElementsAre;

TEST(SubjectScreen, WrapsAtBlanksAndCountsCharactersNotBytes) {
  EXPECT_THAT(wrapped("one two three", 8), ElementsAre("one two", "three"));
  EXPECT_THAT(wrapped("Größe über", 5), ElementsAre("Größe", "über"));
  EXPECT_THAT(wrapped("unbreakable", 4), ElementsAre("unbr", "eaka", "ble"));
  EXPECT_THAT(wrapped("a\n\nb", 10), ElementsAre("a", "", "b"));
  EXPECT_THAT(wrapped("", 10), ElementsAre());
}

TEST(SubjectScreen, LetsNoTextCommandTheTerminal) {
  EXPECT_THAT(wrapped("\x1b[2Jred\x07 \xC2\x9B"
                      "31m",
                      40),
              ElementsAre("[2Jred 31m"));
}

TEST(SubjectScreen, SaysEverythingOfATrial) {
  const SubjectScreen screen = screen_of(test::free_trial(5), "Keys.", "", 79);
  EXPECT_THAT(screen.body, ElementsAre("Liver", "", "Trial 5 of 24", "", "Which is softer?", "",
                                       "[ A ]    B      X    ", "", "You feel A now.", ""));
  EXPECT_THAT(screen.foot, ElementsAre("Keys.", ""));
}

TEST(SubjectScreen, HasTheSameFormForEverySlot) {
  std::vector<std::string> masked;
  for (std::size_t slot = 0; slot < 3; ++slot) {
    SubjectView view = test::free_trial(5);
    view.labels = {"1", "1", "1"};  // what differs is where, and nothing else
    view.playing = slot;
    std::string all;
    for (const std::string& line : screen_of(view, "", "", 79).body) all += line + '\n';
    for (char& c : all) {
      if (c == '[' || c == ']') c = ' ';
    }
    masked.push_back(all);
  }
  EXPECT_EQ(masked[0], masked[1]);
  EXPECT_EQ(masked[0], masked[2]);
}

TEST(SubjectScreen, TurnsPagesWhereTheTextIsLongerThanTheTerminal) {
  const SubjectScreen screen{.body = {"1", "2", "3", "4", "5", "6", "7"}, .foot = {"keys", ""}};
  EXPECT_EQ(page_of(screen, 0, 9).pages, 1U);
  const SubjectScreenPage first = page_of(screen, 0, 7);
  EXPECT_EQ(first.pages, 2U);
  EXPECT_THAT(first.lines, ElementsAre("1", "2", "3", "4", "Page 1 of 2. Space: read on."));
  EXPECT_THAT(page_of(screen, 1, 7).lines,
              ElementsAre("5", "6", "7", "", "Page 2 of 2. P: back.", "keys", ""));
}

TEST(SubjectScreen, SaysInPlainLinesOnlyWhatChanged) {
  SubjectView view = test::free_trial(5);
  EXPECT_THAT(said_of(test::free_trial(4), view),
              ElementsAre("Trial 5 of 24", "Which is softer?", "You feel A now.",
                          "Commands: play A, B or X; answer A or B; quit."));
  view.playing = 1;
  EXPECT_THAT(said_of(test::free_trial(5), view), ElementsAre("You feel B now."));
  SubjectView refused = view;
  refused.notice = "Not now.";
  EXPECT_THAT(said_of(view, refused), ElementsAre("Not now."));
}

TEST(SubjectScreen, TellsHowLongABreakLasts) {
  SubjectView view{.stage = SessionStage::pause, .wait_s = 29.2};
  EXPECT_THAT(screen_of(view, "", "", 79).body, Contains("You can go on after 30 s."));
}

TEST(SubjectKeys, TakeATrialBackOnlyWhereItMayBe) {
  SubjectKeys keys;
  SubjectView view = test::free_trial(5);
  keys.show(view);
  EXPECT_EQ(test::in_words(keys.press('s')), "nothing");
  EXPECT_THAT(keys.what_keys_do(), testing::Not(HasSubstr("slipped")));
  view.may_slip = true;
  keys.show(view);
  EXPECT_THAT(keys.what_keys_do(), HasSubstr("S: I slipped."));
  EXPECT_EQ(test::in_words(keys.press('S')), "slip");
  EXPECT_EQ(test::in_words(command_of(view, "slip")), "slip");
}

SubjectView in_german(SubjectView view) {
  view.texts = shipped_texts("de");
  return view;
}

TEST(SubjectKeys, AreTheSameInEveryLanguageAndNamedInIt) {
  SubjectKeys keys;
  SubjectView view = in_german(test::free_trial(5));
  view.may_slip = true;
  keys.show(view);
  EXPECT_EQ(keys.what_keys_do(),
            "A, B oder X: fühlen. Eingabetaste: antworten. S: Ich habe mich vertan. Q: abbrechen.");
  EXPECT_EQ(test::in_words(keys.press('q')), "nothing");
  EXPECT_EQ(keys.what_keys_do(), "Die Sitzung abbrechen? Y: ja. Jede andere Taste: nein.");
  EXPECT_EQ(test::in_words(keys.press('y')), "quit");
  keys.show(in_german(test::words_trial(6)));
  EXPECT_EQ(test::in_words(keys.press('4')), "answer 3");
  EXPECT_EQ(test::in_words(keys.press('5')), "nothing");
  keys.show(in_german({.stage = SessionStage::consent, .may_go_on = true}));
  EXPECT_EQ(keys.what_keys_do(), "Leertaste: Ich willige ein. D: Ich willige nicht ein. Q: abbrechen.");
}

TEST(SubjectKeys, TakeCommandsInTheSubjectsLanguageAndInEnglish) {
  const SubjectView german = in_german(test::free_trial(5));
  EXPECT_THAT(said_of(in_german(test::free_trial(4)), german),
              Contains("Befehle: fühle A, B oder X; antworte A oder B; abbrechen."));
  EXPECT_EQ(test::in_words(command_of(german, "fühle x")), "play 2");
  EXPECT_EQ(test::in_words(command_of(german, "Antworte B")), "answer 1");
  EXPECT_EQ(test::in_words(command_of(german, "abbrechen")), "quit");
  EXPECT_EQ(test::in_words(command_of(german, "play A")), "play 0");
  EXPECT_EQ(test::in_words(command_of(test::free_trial(5), "fühle A")), "nothing");
}

TEST(SubjectWords, NameTheStagesAsTheyAreRecorded) {
  EXPECT_EQ(name_of(SessionStage::pause), "pause");
  EXPECT_EQ(progress(test::text_view(SessionStage::welcome, "")), "");
  SubjectView practice = test::free_trial(2);
  practice.practice = true;
  EXPECT_EQ(progress(practice), "Practice trial 2 of 24");
  practice.playing.reset();
  EXPECT_EQ(what_plays(practice), "Nothing plays now.");
}

}  // namespace
}  // namespace kerf::bench
