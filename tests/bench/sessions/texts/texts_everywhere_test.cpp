// That a participant reads nothing but what texts.toml, or the protocol, says.

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bench/sessions/protocol/written_protocol.h"
#include "bench/sessions/session/blind_run.h"
#include "own_texts.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::ThrowsMessage;

const fs::path sessions_folder = KERF_SOURCE_DIR "/bench/sessions";

std::string content_of(const fs::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Where participants' words could come from.
std::vector<fs::path> subject_sources() {
  std::vector<fs::path> files{sessions_folder / "session/director.cpp",
                              sessions_folder / "session/director_view.cpp",
                              sessions_folder / "session/director.h"};
  for (const auto& each : fs::directory_iterator(sessions_folder / "subject")) {
    if (each.is_regular_file()) files.push_back(each.path());
  }
  files.push_back(sessions_folder / "subject/page/page.js");
  files.push_back(sessions_folder / "subject/page/noise.js");
  return files;
}

std::vector<std::string> all_matches(const std::string& text, const std::string& pattern) {
  const std::regex expression(pattern);
  std::vector<std::string> found;
  for (auto it = std::sregex_iterator(text.begin(), text.end(), expression); it != std::sregex_iterator();
       ++it)
    found.push_back((*it)[1]);
  return found;
}

/// Literals without the comments and the includes around them.
std::vector<std::string> literals_of(const fs::path& file) {
  std::string code;
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    const std::size_t comment = line.find("//");
    const bool in_url = comment != std::string::npos && comment > 0 && line[comment - 1] == ':';
    if (line.starts_with("#include")) continue;
    code += line.substr(0, in_url ? std::string::npos : comment) + '\n';
  }
  std::vector<std::string> literals = all_matches(code, R"re("((?:[^"\\\n]|\\.)*)")re");
  for (const std::string& one : all_matches(code, "`([^`]*)`")) literals.push_back(one);
  return literals;
}

TEST(TextsEverywhere, StandInNoSourceOfWhatASubjectSees) {
  const std::set<std::string> not_for_participants{
      // kept in the session, for the experimenter
      "by the subject", "consent was not given", "practice did not come to its criterion",
      // to whoever writes a program for the page's server
      "a noise has a level_db from -60 to -15", "an action has kind, slot, stage and trial", "Content-Type",
      "X-Kerf-Token",
      // JavaScript and keys of a browser
      "use strict", "Enter", "Escape"};
  const std::regex sentence("[A-Za-z]{2,}[,:;]? [A-Za-z]{2,}");
  const std::regex word("^[A-Z][a-z]+");
  for (const fs::path& file : subject_sources()) {
    for (const std::string& literal : literals_of(file)) {
      const bool says_something = std::regex_search(literal, sentence) || std::regex_search(literal, word);
      EXPECT_TRUE(!says_something || not_for_participants.contains(literal))
          << file << " says \"" << literal << "\": it belongs to texts.toml";
    }
  }
  const std::string html = content_of(sessions_folder / "subject/page/page.html");
  for (const std::string& text : all_matches(html, ">([^<>]*)<")) {
    const std::string without_marks = std::regex_replace(text, std::regex(R"(\{\{[a-z_ ]+\}\})"), "");
    EXPECT_FALSE(std::regex_search(without_marks, std::regex("[A-Za-z]"))) << "page.html says " << text;
  }
}

TEST(TextsEverywhere, AreKnownToThePageByTheirNamesAndEachIsSaidSomewhere) {
  std::set<std::string> said;
  const std::set<std::string_view> known(text_names.begin(), text_names.end());
  const std::string script = content_of(sessions_folder / "subject/page/page.js");
  const std::string html = content_of(sessions_folder / "subject/page/page.html");
  for (const auto& names :
       {all_matches(script, R"(\btexts\.([a-z_]+))"), all_matches(html, R"(\{\{text ([a-z_]+)\}\})")}) {
    for (const std::string& name : names) {
      EXPECT_TRUE(known.contains(name)) << name;
      said.insert(name);
    }
  }
  for (const auto& each : fs::recursive_directory_iterator(sessions_folder)) {
    if (each.path().extension() != ".cpp") continue;
    const std::string code = content_of(each.path());
    for (const std::string& name : all_matches(code, R"re("([a-z_]+)")re")) said.insert(name);
  }
  for (const std::string_view name : text_names) {
    EXPECT_TRUE(said.contains(std::string(name))) << name << " is said nowhere";
  }
}

/// Files by name: the laws, and a language of its own.
std::string with_own_texts(const std::string& name) {
  return name == "fr.texts.toml" ? test::as_toml(test::angled_texts()) : test::law_called(name);
}

Protocol protocol_in(const std::string& top) {
  return parse_protocol(test::protocol_text(top), "p.protocol.toml", with_own_texts);
}

TEST(TextsEverywhere, AreThoseOfTheProtocolsLanguage) {
  EXPECT_EQ(*protocol_in("design = \"abx\"").texts, *english_texts());
  const Protocol german = parse_protocol(
      "name = \"n\"\nlanguage = \"de\"\ndesign = \"same-different\"\npractice = 1\n"
      "[[sample]]\nname = \"a\"\nlaw = \"soft.law.toml\"\n[[sample]]\nname = \"b\"\nlaw = "
      "\"stiff.law.toml\"\n",
      "p.protocol.toml", with_own_texts);
  EXPECT_EQ(german.title, "Vergleich");
  EXPECT_EQ(german.question, "Waren die beiden gleich oder verschieden?");
  EXPECT_THAT(choice_labels_of(german), testing::ElementsAre("gleich", "verschieden"));
  EXPECT_EQ(told_answer(german, 1), "„verschieden“");
  EXPECT_EQ(answer_label_of(german.design, 0), "same") << "tables are in English";
  const Protocol sure = protocol_in("design = \"yes-no\"\nsignal = \"soft\"\nlanguage = \"de\"");
  EXPECT_EQ(choice_labels_of(sure).back(), "ja, sicher");
  EXPECT_EQ((*protocol_in("design = \"abx\"\ntexts = \"fr.texts.toml\"").texts)("page_stop"), "<Stop>");
}

TEST(TextsEverywhere, AreThoseOfTheExamplesInOtherLanguages) {
  const Protocol german = test::example_protocol("german");
  EXPECT_EQ(*german.texts, *shipped_texts("de"));
  EXPECT_THAT(german.instructions, HasSubstr("gleich oder verschieden"));
  const Protocol french = test::example_protocol("french");
  EXPECT_EQ(french.texts->language(), "fr");
  EXPECT_EQ(french.question, "Lequel des deux est X ?");
}

TEST(TextsEverywhere, RefuseALanguageThatThereIsNotWithTheLine) {
  const auto is_refused_with = [](const char* message) {
    return ThrowsMessage<std::invalid_argument>(
        testing::AllOf(HasSubstr("p.protocol.toml:"), HasSubstr(message)));
  };
  EXPECT_THAT([] { (void)protocol_in("design = \"abx\"\nlanguage = \"nl\""); },
              is_refused_with(":4: 'language' is \"nl\", expected one of \"en\", \"de\""));
  EXPECT_THAT([] { (void)protocol_in("design = \"abx\"\ntexts = \"no.toml\""); },
              is_refused_with(":4: 'texts': there is no file no.toml"));
  EXPECT_THAT([] { (void)protocol_in("design = \"abx\"\ntexts = \"\""); },
              is_refused_with("'texts' is empty"));
  EXPECT_THAT([] { (void)protocol_in("design = \"abx\"\nlanguage = \"en\"\ntexts = \"fr.texts.toml\""); },
              is_refused_with("leave 'language' out"));
}

TEST(TextsEverywhere, AreKeptInTheSessionAsTheyWereWhenItWasMade) {
  for (const char* top :
       {"design = \"abx\"\nlanguage = \"de\"", "design = \"abx\"\ntexts = \"fr.texts.toml\""}) {
    const Protocol protocol = protocol_in(top);
    const test::BlindRun run(protocol);
    EXPECT_EQ(*run.read().protocol().texts, *protocol.texts) << "from the session alone";
    EXPECT_EQ(run.read().protocol().question, "Which felt more like cutting?");
  }
}

TEST(TextsEverywhere, SayNothingInEnglishInASessionInGerman) {
  const Protocol protocol = protocol_in(
      "language = \"de\"\ndesign = \"yes-no\"\nsignal = \"soft\"\ntrials = 2\npractice = 1\nfeedback = true\n"
      "title = \"T\"\nconsent = \"C\"\ninstructions = \"I\"\ninterval = { value = 300, unit = \"ms\" }\n"
      "break = { every = 1, at_least = { value = 1, unit = \"s\" } }\n"
      "trial = { start = \"key\", void = { fault = true } }");
  test::BlindRun run(protocol);
  test::WatchingSubject subject;
  run.run(subject);
  std::string all;
  for (const std::string& one : subject.seen) all += one + '\n';
  for (const char* german : {"Willkommen", "Ihre Einwilligung", "Was Sie tun werden", "Der nächste Durchgang",
                             "Übungsdurchgang 1 von etwa 3", "Durchgang 3 von etwa 3", "Sie fühlen jetzt A.",
                             "Nehmen Sie die Hand vom Gerät", "Das war der letzte Durchgang."}) {
    EXPECT_THAT(all, HasSubstr(german));
  }
  for (std::size_t i = 0; i < text_names.size(); ++i) {
    const std::string& english = english_texts()->all()[i];
    const std::string begin = english.substr(0, english.find('{'));
    if (begin.find(' ') == std::string::npos || shipped_texts("de")->all()[i] == english) continue;
    EXPECT_THAT(all, testing::Not(HasSubstr(begin))) << text_names[i];
  }
}

}  // namespace
}  // namespace kerf::bench
