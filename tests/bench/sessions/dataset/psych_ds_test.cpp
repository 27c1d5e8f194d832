#include "dataset/psych_ds.h"

#include <map>
#include <regex>
#include <set>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/sessions/sealed/stored_session.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;
using testing::SizeIs;
using testing::ThrowsMessage;

/// The cells of a table by RFC 4180, as any reader has them.
std::vector<std::vector<std::string>> cells_of(const std::string& text) {
  std::vector<std::vector<std::string>> rows(1, std::vector<std::string>(1));
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted && c == '"' && i + 1 < text.size() && text[i + 1] == '"') {
      rows.back().back() += text[++i];
    } else if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      rows.back().emplace_back();
    } else if (c == '\n' && !quoted) {
      rows.emplace_back(1);
    } else {
      rows.back().back() += c;
    }
  }
  rows.pop_back();
  return rows;
}

class Dataset : public testing::Test {
 protected:
  explicit Dataset(const std::string& top = "design = \"abx\"\ntrials = 2\n", const std::string& tables = "")
      : session_(test::set_up(top, tables)) {
    const SessionSetUp up = test::set_up(top, tables);
    SessionStore run = session_.run();
    run.note("run", "sim:scissors?seed=3,4");
    run.append(test::answered(up.plan[0], 1));
    run.append(test::answered(up.plan[1], 1));
    run.append(test::answered(up.plan[2], 0, 0));
    run.note("opened", "a look, \"early\"");
    run.close();
  }
  void expect_the_rules_of_psych_ds(std::size_t tables) const;
  void write(const DatasetNotes& notes = {}) {
    const SessionStore store = session_.read();
    write_dataset({&store}, nullptr, notes, folder_, true);
  }
  [[nodiscard]] std::string text(const std::string& file) const {
    return kerf::test::read_text(folder_ / file);
  }
  [[nodiscard]] nlohmann::json description() const {
    return nlohmann::json::parse(text("dataset_description.json"));
  }
  /// By the names of the first row.
  [[nodiscard]] std::vector<std::map<std::string, std::string>> table(const std::string& file) const {
    const auto cells = cells_of(text(file));
    std::vector<std::map<std::string, std::string>> rows;
    for (std::size_t i = 1; i < cells.size(); ++i) {
      auto& row = rows.emplace_back();
      for (std::size_t k = 0; k < cells[0].size(); ++k) row[cells[0][k]] = cells[i].at(k);
    }
    return rows;
  }

  test::StoredSession session_;
  fs::path folder_ = session_.folder() / "dataset";
};

// The rules of Psych-DS 1.5.0 that end in an error.
void Dataset::expect_the_rules_of_psych_ds(std::size_t tables) const {
  std::set<std::string> columns;
  std::size_t found = 0;
  const std::regex name("([a-z]+-[a-zA-Z0-9]+)(_[a-z]+-[a-zA-Z0-9]+)*_data\\.csv");
  for (const auto& entry : fs::recursive_directory_iterator(folder_ / "data")) {
    const std::string file = entry.path().filename();
    EXPECT_TRUE(std::regex_match(file, name)) << file;
    const auto cells = cells_of(kerf::test::read_text(entry.path()));
    ASSERT_FALSE(cells.empty()) << file;
    EXPECT_EQ(std::set(cells[0].begin(), cells[0].end()).size(), cells[0].size())
        << file << ": repeated names";
    for (const auto& row : cells) EXPECT_THAT(row, SizeIs(cells[0].size())) << file;
    for (const std::string& column : cells[0]) EXPECT_FALSE(column.empty()) << file;
    columns.insert(cells[0].begin(), cells[0].end());
    ++found;
  }
  EXPECT_EQ(found, tables);
  const auto json = description();
  EXPECT_EQ(json.at("@type"), "Dataset");
  EXPECT_THAT(json.at("@context").get<std::string>(), HasSubstr("://schema.org"));
  EXPECT_FALSE(json.at("name").get<std::string>().empty());
  EXPECT_FALSE(json.at("description").get<std::string>().empty());
  std::set<std::string> measured;
  for (const auto& variable : json.at("variableMeasured")) {
    EXPECT_EQ(variable.at("@type"), "PropertyValue");
    EXPECT_FALSE(variable.at("description").get<std::string>().empty()) << variable;
    EXPECT_TRUE(measured.insert(variable.at("name")).second) << variable;
  }
  EXPECT_EQ(measured, columns) << "every column is listed, and every listed variable occurs";
  EXPECT_TRUE(fs::exists(folder_ / "README.md"));
}

TEST_F(Dataset, HoldsTheRulesOfPsychDs) {
  write();
  expect_the_rules_of_psych_ds(3);
  const auto json = description();
  EXPECT_FALSE(json.contains("license"));
  EXPECT_FALSE(json.contains("author")) << "nobody is named who was not given";
}

TEST_F(Dataset, HasARowATrialWithWhatWasPlayedAnsweredAndFelt) {
  write();
  const auto trials = table("data/task-abx_description-trials_data.csv");
  ASSERT_THAT(trials, SizeIs(3));
  EXPECT_EQ(trials[0].at("trial_id"), "S2-1-001");
  EXPECT_EQ(trials[0].at("practice"), "TRUE");
  EXPECT_EQ(trials[1].at("practice"), "FALSE");
  EXPECT_EQ(trials[1].at("first"), "soft");
  EXPECT_EQ(trials[1].at("plays_1"), "stiff");
  EXPECT_EQ(trials[1].at("plays_2"), "soft");
  EXPECT_EQ(trials[1].at("plays_3"), "stiff");
  EXPECT_EQ(trials[1].at("right"), "A");
  EXPECT_EQ(trials[1].at("answer"), "B");
  EXPECT_EQ(trials[1].at("correct"), "FALSE");
  EXPECT_EQ(trials[1].at("response_time"), "3.25");
  EXPECT_EQ(trials[1].at("level"), "");
  EXPECT_EQ(trials[1].at("device"), "sim:scissors?seed=3,4") << "quoted, for its comma";
  EXPECT_EQ(trials[1].at("felt"), "FALSE") << "X was never played";
  EXPECT_EQ(trials[1].at("sound"), "TRUE");
  EXPECT_EQ(trials[2].at("felt"), "") << "it has no trace: unknown, and not false";
  EXPECT_EQ(trials[2].at("missed_deadlines"), "");
  EXPECT_EQ(trials[2].at("opened_early"), "TRUE");
  const auto slots = table("data/task-abx_description-slots_data.csv");
  ASSERT_THAT(slots, SizeIs(6)) << "three of each trial that has a trace";
  EXPECT_EQ(slots[0].at("playing_time"), "0.009");
  EXPECT_EQ(slots[2].at("contact_time"), "0");
  const auto people = table("data/task-abx_description-participants_data.csv");
  ASSERT_THAT(people, SizeIs(1));
  EXPECT_EQ(people[0].at("subject_id"), "S2");
  EXPECT_EQ(people[0].at("trials"), "2");
  EXPECT_EQ(people[0].at("practice_trials"), "1");
  EXPECT_EQ(people[0].at("unknown_trials"), "1");
  EXPECT_EQ(people[0].at("finished_sessions"), "0");
}

TEST_F(Dataset, NamesAuthorsAndLicenceThatWereGiven) {
  write({.description = "Liver and gel.", .licence = "CC-BY-4.0", .authors = {"A. Lab", "B. Lab"}});
  const auto json = description();
  EXPECT_EQ(json.at("license"), "CC-BY-4.0");
  EXPECT_EQ(json.at("description"), "Liver and gel.");
  ASSERT_THAT(json.at("author"), SizeIs(2));
  EXPECT_EQ(json.at("author")[1].at("name"), "B. Lab");
}

TEST_F(Dataset, HasAMethodsSectionOfWhatTheFilesSay) {
  write();
  const std::string methods = text("documentation/methods.md");
  EXPECT_THAT(methods, HasSubstr("1 participants took part in 1 sessions, 0 of them to the end"));
  EXPECT_THAT(methods, HasSubstr("`sim:scissors?seed=3,4`")) << "the device as it was run, its query too";
  EXPECT_THAT(methods, HasSubstr("(ABX)"));
  EXPECT_THAT(methods, HasSubstr("| stiff |")) << "each rendering with its law, parameters and gain";
  EXPECT_THAT(methods, HasSubstr("1000 Hz"));
  EXPECT_THAT(methods, HasSubstr("## What was felt"));
  EXPECT_THAT(methods, HasSubstr("Of 1 trials no trace of the forces is there"));
  EXPECT_THAT(methods, HasSubstr("Opened before the end"));
  EXPECT_THAT(methods, HasSubstr("to be said by the authors")) << "what no file knows is not made up";
  EXPECT_THAT(text("materials/protocol.toml"), HasSubstr("design = \"abx\""));
  EXPECT_TRUE(fs::exists(folder_ / "materials/laws/soft.law.toml"));
  EXPECT_EQ(*parse_texts(text("materials/texts.toml"), "texts.toml"), *english_texts());
  EXPECT_THAT(text("documentation/methods.md"), HasSubstr("Subjects were addressed in English (`en-GB`)."));
}

TEST_F(Dataset, IsOfOneStudyAndReplacesNothingUnlessToldTo) {
  write();
  const SessionStore store = session_.read();
  EXPECT_THAT([&] { write_dataset({&store}, nullptr, {}, folder_, false); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("--force replaces it")));
  EXPECT_THAT(
      [&] {
        write_dataset({&store, &store}, nullptr, {}, folder_, true);
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("there twice")));
  EXPECT_THAT([&] { write_dataset({}, nullptr, {}, folder_, true); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("no session")));
  const test::StoredSession other(test::set_up("design = \"preference\"\n"));
  const SessionStore of_another = other.read();
  EXPECT_THAT(
      [&] {
        write_dataset({&store, &of_another}, nullptr, {}, folder_, true);
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("different protocols")));
}

// A session is made for one person at a time, and then says of each that it is the first.
TEST_F(Dataset, TellsTwoSessionsOfOnePersonApart) {
  test::StoredSession again;
  {
    SessionStore run = again.run();
    run.append(test::answered(test::set_up().plan[0], 1));
    run.close();
  }
  const SessionStore one = session_.read();
  const SessionStore two = again.read();
  write_dataset({&one, &two}, nullptr, {}, folder_, true);
  std::set<std::string> ids;
  const auto trials = table("data/task-abx_description-trials_data.csv");
  for (const auto& trial : trials) ids.insert(trial.at("trial_id"));
  ASSERT_THAT(trials, SizeIs(4));
  EXPECT_EQ(ids.size(), 4U);
  EXPECT_EQ(trials[3].at("session_number"), "2");
  EXPECT_THAT(table("data/task-abx_description-participants_data.csv"), SizeIs(1));
}

class DatasetWithQuestionnaires : public Dataset {
 protected:
  DatasetWithQuestionnaires()
      : Dataset("design = \"abx\"\ntrials = 2\n", "[questionnaire]\nuse = \"nasa-tlx\"\n") {
    SessionStore run = session_.run();
    run.append(FilledQuestionnaire{.scores = {10, 20, 30, 40, 50, 60}, .at = "2026-01-31T12:30:00Z"});
    run.close();
  }
};

TEST_F(DatasetWithQuestionnaires, HaveATableWhoseColumnsAreInTheDictionary) {
  write();
  expect_the_rules_of_psych_ds(4);
  const auto answers = table("data/task-abx_description-questionnaires_data.csv");
  ASSERT_THAT(answers, SizeIs(6));
  EXPECT_EQ(answers[3].at("subject_id"), "S2");
  EXPECT_EQ(answers[3].at("session_id"), session_.read().session().uuid);
  EXPECT_EQ(answers[3].at("answered_at"), "2026-01-31T12:30:00Z");
  EXPECT_EQ(answers[3].at("item"), "Performance");
  EXPECT_EQ(answers[3].at("score"), "40");
  std::map<std::string, nlohmann::json> dictionary;
  const auto json = description();
  for (const auto& variable : json.at("variableMeasured")) dictionary[variable.at("name")] = variable;
  EXPECT_THAT(dictionary.at("score").at("description").get<std::string>(), HasSubstr("from 0, the first"));
  EXPECT_EQ(dictionary.at("score").at("unitText"), "1");
  EXPECT_THAT(dictionary.at("item").at("description").get<std::string>(), HasSubstr("question"));
  EXPECT_THAT(dictionary.at("tissue").at("description").get<std::string>(), HasSubstr("asked at the end"))
      << "a column of two tables has one meaning, which is true of both";
  EXPECT_THAT(text("README.md"), HasSubstr("- `data/task-abx_description-questionnaires_data.csv`\n"));
}

class DatasetOfPreferences : public Dataset {
 protected:
  DatasetOfPreferences() : Dataset("design = \"preference\"\n") {}
};

TEST_F(DatasetOfPreferences, CallsNoAnswerCorrect) {
  write();
  for (const auto& trial : table("data/task-preference_description-trials_data.csv")) {
    EXPECT_EQ(trial.at("correct"), "");
    EXPECT_EQ(trial.at("plays_3"), "");
  }
}

}  // namespace
}  // namespace kerf::bench
