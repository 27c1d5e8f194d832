#include "texts/subject_texts.h"

#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "own_texts.h"

namespace kerf::bench {
namespace {

using test::angled_texts;
using test::as_toml;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;
using testing::ThrowsMessage;

auto is_refused_with(const std::string& message) {
  return ThrowsMessage<std::invalid_argument>(AllOf(StartsWith("fr.toml:"), HasSubstr(message)));
}

TEST(SubjectTexts, AreOfTheSamePlaceholdersInEveryLanguage) {
  const auto as_set = [](const std::string& text) {
    const auto all = placeholders_of(text);
    return std::set<std::string>(all.begin(), all.end());
  };
  for (const std::string_view language : shipped_languages) {
    const auto texts = shipped_texts(language);
    for (std::size_t i = 0; i < text_names.size(); ++i) {
      EXPECT_NE(texts->all()[i], "") << text_names[i];
      EXPECT_EQ(as_set(texts->all()[i]), as_set(english_texts()->all()[i]))
          << language << ' ' << text_names[i];
    }
  }
}

TEST(SubjectTexts, SayEachThingInGermanThatIsNotJustOrder) {
  const std::set<std::string_view> alike{"list_more", "numbered_answer", "answer_with_confidence",
                                         "commands_more"};
  const auto german = shipped_texts("de");
  EXPECT_EQ(german->language(), "de");
  for (std::size_t i = 0; i < text_names.size(); ++i) {
    EXPECT_EQ(german->all()[i] == english_texts()->all()[i], alike.contains(text_names[i])) << text_names[i];
  }
}

TEST(SubjectTexts, SayNothingInALanguageThatThereIsNot) {
  EXPECT_THAT([] { (void)shipped_texts("nl"); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("no texts in 'nl', only in en and de")));
}

TEST(SubjectTexts, FillTheirPlaceholdersByName) {
  const SubjectTexts& english = *english_texts();
  EXPECT_EQ(english("trial_of", {{"most", "24"}, {"trial", "5"}}), "Trial 5 of 24");
  EXPECT_EQ(english("trial_of", {{"trial", "{most}"}, {"most", "24"}}), "Trial {most} of 24")
      << "a value is not read again";
  EXPECT_EQ(english("trial_of", {}), "Trial {trial} of {most}");
  const SubjectTexts& german = *shipped_texts("de");
  EXPECT_EQ(german("page_feel", {{"label", "A"}}), "A fühlen");
  EXPECT_EQ(german("goes_on_one", {{"trials", "1"}}), "Die Sitzung geht weiter: 1 Durchgang ist erledigt.");
}

TEST(SubjectTexts, ListWordsAsTheLanguageDoes) {
  const SubjectTexts& german = *shipped_texts("de");
  EXPECT_EQ(german.list({}), "");
  EXPECT_EQ(german.list({"A"}), "A");
  EXPECT_EQ(german.list({"A", "B"}), "A oder B");
  EXPECT_EQ(german.list({"A", "B", "X"}), "A, B oder X");
  EXPECT_EQ(english_texts()->list({"A", "B", "C", "D"}), "A, B, C or D");
}

TEST(SubjectTexts, HavePlaceholdersOfNamesInBraces) {
  EXPECT_THAT(placeholders_of("{a} of {at_most}, {a}"), ElementsAre("a", "at_most", "a"));
  for (const char* bad : {"{", "}", "{}", "{a", "a}", "{a{b}}", "{1}", "{a b}"})
    EXPECT_THROW((void)placeholders_of(bad), std::invalid_argument) << bad;
}

TEST(SubjectTexts, AreReadFromAFileOfAnyLanguage) {
  const auto texts = parse_texts(as_toml(angled_texts()), "fr.toml");
  EXPECT_EQ(texts->language(), "fr-CA");
  EXPECT_EQ((*texts)("trial_of", {{"trial", "1"}, {"most", "2"}}), "<Trial 1 of 2>");
}

TEST(SubjectTexts, AreRefusedByTheFirstThatIsMissingOrUnknown) {
  auto missing = angled_texts();
  missing.erase("list_or");
  EXPECT_THAT([&] { (void)parse_texts(as_toml(missing), "fr.toml"); },
              is_refused_with("there is no text 'list_or'; expected every one, in English it is \"{first} or "
                              "{last}\""));
  auto unknown = angled_texts();
  unknown["colour"] = "rouge";
  EXPECT_THAT([&] { (void)parse_texts(as_toml(unknown), "fr.toml"); },
              is_refused_with("unknown text 'colour'"));
  EXPECT_THAT([] { (void)parse_texts("language = ", "fr.toml"); }, is_refused_with("not TOML"));
}

TEST(SubjectTexts, AreRefusedWithoutTheirPlaceholders) {
  const std::map<std::string, std::string> bad{
      {"Essai {trial}", "the text 'trial_of' has no {most} in it; expected the placeholders {most}, {trial}"},
      {"Essai {trial} de {most} {key}", "the text 'trial_of' has {key} in it"},
      {"Essai {trial} de {most", "the text 'trial_of': found a '{' that is no placeholder's"},
      {"", "'trial_of' has 0 characters, expected 1 to 400"},
      {std::string(401, 'x'), "has 401 characters"},
      {"a\x1b[2J", "not TOML"}};
  for (const auto& [text, message] : bad) {
    auto texts = angled_texts();
    texts["trial_of"] = text;
    EXPECT_THAT([&] { (void)parse_texts(as_toml(texts), "fr.toml"); }, is_refused_with(message)) << text;
  }
  auto texts = angled_texts();
  for (const char* tag : {"French", "f", "fr FR", "fr-", "\" onload=\""}) {
    texts["language"] = tag;
    EXPECT_THAT([&] { (void)parse_texts(as_toml(texts), "fr.toml"); },
                is_refused_with("expected a tag such as \"fr\" or \"pt-BR\""))
        << tag;
  }
}

TEST(SubjectTexts, ThatWereKeptAreReadByAProgramThatHasOthers) {
  auto kept = angled_texts();
  kept["of_an_older_program"] = "gone";
  kept.erase("may_go_on");
  kept["trial_of"] = "Trial {trial}";
  EXPECT_EQ((*kept_texts(kept))("may_go_on"), "You can go on.");
  EXPECT_EQ((*kept_texts(kept))("trial_of"), "Trial {trial} of {most}");
  EXPECT_EQ((*kept_texts(kept))("page_stop"), "<Stop>");
  kept["language"] = "de-AT";
  EXPECT_EQ((*kept_texts(kept))("may_go_on"), "Sie können weitermachen.");
  EXPECT_EQ(*kept_texts({}), *english_texts());
}

}  // namespace
}  // namespace kerf::bench
