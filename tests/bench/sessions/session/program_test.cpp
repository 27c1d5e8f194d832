// `kerf session` from the command line, and what it refuses.

#include "support/program.h"

#include <array>
#include <regex>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include "bench/sessions/protocol/written_protocol.h"
#include "sealed/session_store.h"

namespace kerf::bench {
namespace {

using kerf::test::Outcome;
using kerf::test::read_text;
using kerf::test::run_kerf;
using kerf::test::TemporaryFolder;
using kerf::test::write_text;
using testing::HasSubstr;
using testing::Not;

/// A folder with a protocol, its laws and a key.
class SessionFolder {
 public:
  explicit SessionFolder(const std::string& top = "design = \"abx\"\ntrials = 4\ndevice = \"sim:scissors\"\n",
                         const std::string& tables = "") {
    for (const char* law : {"soft", "stiff", "third", "still"})
      write_text(folder_ / fmt::format("{}.law.toml", law),
                 kerf::test::law_called(fmt::format("{}.law.toml", law)));
    write_text(protocol(), kerf::test::protocol_text(top, tables));
    EXPECT_EQ(run_kerf({"session", "key", path("k.key")}).exit_status, 0);
  }
  [[nodiscard]] std::string path(const std::string& name) const { return (folder_ / name).string(); }
  [[nodiscard]] std::string protocol() const { return path("p.protocol.toml"); }
  [[nodiscard]] Outcome make(const std::vector<std::string>& more = {}) const {
    return with_key({"session", "new", protocol(), "--subject", "S01", "-o", path("s.h5")}, more);
  }
  [[nodiscard]] Outcome run(const std::vector<std::string>& more = {"--rehearse"}) const {
    return with_key({"session", "run", path("s.h5")}, more);
  }
  [[nodiscard]] Outcome analyze(const std::vector<std::string>& more = {}) const {
    return with_key({"session", "analyze", path("s.h5")}, more);
  }

 private:
  [[nodiscard]] Outcome with_key(std::vector<std::string> command,
                                 const std::vector<std::string>& more) const {
    command.insert(command.end(), {"--key-file", path("k.key")});
    command.insert(command.end(), more.begin(), more.end());
    return run_kerf(command);
  }
  TemporaryFolder folder_;
};

/// Whether a passphrase is asked for now. Other words may end with a colon where a read ends; what is typed
/// then is thrown away by the program, which takes nothing that was typed before it asked.
bool is_question(std::string_view said) {
  for (const std::string_view question :
       {"Passphrase of the session: ", "New passphrase, for whoever keeps the blinding: ", "Once more: "}) {
    if (said.ends_with(question)) return true;
  }
  return false;
}

/// Runs a program at a terminal of its own and answers its questions.
Outcome at_a_terminal(std::vector<std::string> command, std::vector<std::string> answers) {
  command.insert(command.begin(), KERF_PROGRAM);
  std::vector<char*> arguments;
  for (std::string& argument : command) arguments.push_back(argument.data());
  arguments.push_back(nullptr);
  int terminal = -1;
  const pid_t child = forkpty(&terminal, nullptr, nullptr, nullptr);
  if (child == 0) {
    execv(arguments[0], arguments.data());
    _exit(127);
  }
  Outcome outcome;
  std::array<char, 512> bytes{};
  for (ssize_t count = 0; (count = read(terminal, bytes.data(), bytes.size())) > 0;) {
    outcome.errors.append(bytes.data(), static_cast<std::size_t>(count));
    if (answers.empty() || !is_question(outcome.errors)) continue;
    const std::string answer = answers.front() + "\n";
    EXPECT_EQ(write(terminal, answer.data(), answer.size()), static_cast<ssize_t>(answer.size()));
    answers.erase(answers.begin());
  }
  int status = 0;
  waitpid(child, &status, 0);
  close(terminal);
  outcome.exit_status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

/// Refused with exit status 2 and one line that says so.
void expect_refused(const Outcome& outcome, const std::string& why) {
  EXPECT_EQ(outcome.exit_status, 2);
  EXPECT_THAT(outcome.errors, HasSubstr("kerf: "));
  EXPECT_THAT(outcome.errors, HasSubstr(why));
}

TEST(SessionProgram, GoesFromAProtocolToAnAnalysis) {
  const SessionFolder folder;
  ASSERT_EQ(folder.make().exit_status, 0);
  const Outcome run = folder.run();
  ASSERT_EQ(run.exit_status, 0) << run.errors;
  const Outcome analysis = folder.analyze({"--json", "-o", folder.path("out")});
  ASSERT_EQ(analysis.exit_status, 0) << analysis.errors;
  EXPECT_THAT(analysis.errors, HasSubstr("a rehearsal, whose answers are by chance"));
  const auto json = nlohmann::json::parse(analysis.output);
  EXPECT_EQ(json["trials"], 4);
  for (const char* key : {"correct", "p_value", "ci95", "dprime"}) EXPECT_TRUE(json.contains(key)) << key;
  EXPECT_THAT(read_text(folder.path("out/analysis.html")), HasSubstr("<svg"));
  // What it exports can be read again, and says the same.
  ASSERT_EQ(run_kerf({"session", "open", folder.path("s.h5"), "--key-file", folder.path("k.key"), "-o",
                      folder.path("open")})
                .exit_status,
            0);
  const Outcome again = run_kerf({"session", "analyze", folder.path("open/trials.csv"), "--json"});
  ASSERT_EQ(again.exit_status, 0) << again.errors;
  EXPECT_EQ(nlohmann::json::parse(again.output)["correct"], json["correct"]);
  const Outcome replay = run_kerf({"info", folder.path("open/trial-001.h5")});
  EXPECT_EQ(replay.exit_status, 0) << replay.errors;
}

TEST(SessionProgram, RehearsesEverySubjectByASeedOfItsOwn) {
  const SessionFolder folder("design = \"abx\"\ntrials = 2\ndevice = \"sim:scissors\"\n",
                             "[questionnaire]\nuse = \"nasa-tlx\"\n");
  const auto scores = [&](const std::string& subject, const std::string& file, const std::string& seed) {
    const auto with_key = [&](std::vector<std::string> command) {
      command.insert(command.end(), {"--key-file", folder.path("k.key")});
      const Outcome outcome = run_kerf(command);
      EXPECT_EQ(outcome.exit_status, 0) << outcome.errors;
      return outcome;
    };
    (void)with_key({"session", "new", folder.protocol(), "--subject", subject, "-o", folder.path(file)});
    (void)with_key({"session", "run", folder.path(file), "--rehearse", "--no-check", "--seed", seed});
    const Outcome opened =
        with_key({"session", "open", folder.path(file), "-o", folder.path(file + ".open")});
    EXPECT_THAT(opened.output, HasSubstr("trials.csv, slots.csv, questionnaire.csv and a recording"));
    std::istringstream table(read_text(folder.path(file + ".open/questionnaire.csv")));
    std::vector<std::string> found;
    for (std::string line; std::getline(table, line);) {
      if (!line.starts_with(subject)) continue;
      const std::size_t end = line.rfind(',');
      const std::size_t begin = line.rfind(',', end - 1) + 1;
      found.push_back(line.substr(begin, end - begin));
    }
    EXPECT_EQ(found.size(), 6U);
    return found;
  };
  const auto first = scores("S01", "a.h5", "1");
  EXPECT_NE(scores("S02", "b.h5", "1"), first);
  EXPECT_EQ(scores("S01", "c.h5", "1"), first) << "a rehearsal can be had again";
  EXPECT_NE(scores("S01", "d.h5", "2"), first);
}

TEST(SessionProgram, AnswersAtAKeyboardThatIsAPipe) {
  const SessionFolder folder(
      "design = \"preference\"\ntrials = 1\ndevice = \"sim:scissors\"\n"
      "presentation = \"sequence\"\ninterval = { value = 0.2, unit = \"s\" }\n"
      "gap = { value = 0, unit = \"s\" }\nramp = { value = 0.02, unit = \"s\" }\n");
  ASSERT_EQ(folder.make().exit_status, 0);
  write_text(folder.path("keys"), "go on\nanswer B\ngo on\n");
  const Outcome outcome =
      kerf::test::run({"/bin/sh", "-c",
                       fmt::format("{} session run {} --key-file {} <{}", KERF_PROGRAM, folder.path("s.h5"),
                                   folder.path("k.key"), folder.path("keys"))});
  EXPECT_EQ(outcome.exit_status, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("The session is finished: 1 trials"));
  EXPECT_THAT(folder.analyze().output, HasSubstr("1 trial"));
}

TEST(SessionProgram, MakesTheSessionsOfAWholeStudy) {
  const SessionFolder folder;
  const std::vector<std::string> command{"session",
                                         "new",
                                         folder.protocol(),
                                         "--subjects",
                                         "3",
                                         "--key-file",
                                         folder.path("k.key"),
                                         "-o",
                                         folder.path("study")};
  ASSERT_EQ(run_kerf(command).exit_status, 0);
  for (const char* name : {"S01.h5", "S02.h5", "S03.h5"}) {
    EXPECT_THAT(run_kerf({"info", folder.path(std::string("study/") + name)}).output, HasSubstr("of 3"));
  }
  expect_refused(run_kerf(command), "S01.h5");
}

TEST(SessionProgram, SaysWhenOneCodeHasTwoSessions) {
  const SessionFolder folder;
  ASSERT_EQ(folder.make().exit_status, 0);
  ASSERT_EQ(folder.run().exit_status, 0);
  std::filesystem::copy_file(folder.path("s.h5"), folder.path("first.h5"));
  ASSERT_EQ(folder.make({"--force"}).exit_status, 0);
  ASSERT_EQ(folder.run().exit_status, 0);
  const Outcome both = folder.analyze({folder.path("first.h5")});
  EXPECT_EQ(both.exit_status, 0) << both.errors;
  EXPECT_THAT(both.errors, HasSubstr("are two sessions of S01, who is counted as one person"));
}

TEST(SessionProgram, GivesAReceiptThatFindsAFileCutShort) {
  const SessionFolder folder;
  ASSERT_EQ(folder.make().exit_status, 0);
  const Outcome run = folder.run();
  std::smatch receipt;
  ASSERT_TRUE(std::regex_search(run.errors, receipt,
                                std::regex("Receipt ([0-9a-f]{8}/[0-9]+/[0-9a-f]{16}): keep it away")))
      << run.errors;
  const std::string kept = folder.path("s.h5.receipts");
  for (const std::string& given : {receipt[1].str(), kept}) {
    const Outcome analysis = folder.analyze({"--receipt", given, "--json"});
    EXPECT_EQ(analysis.exit_status, 0) << analysis.errors;
    EXPECT_EQ(nlohmann::json::parse(analysis.output).at("receipts").at(0).at("holds"), true);
  }
  schema::Session session = schema::read_session(folder.path("s.h5"));
  session.entries.erase(session.entries.end() - 2, session.entries.end());
  schema::write_session(folder.path("s.h5"), session);
  const Outcome cut = folder.analyze({"--receipt", receipt[1], "--receipt", kept, "--reason", "a test"});
  EXPECT_EQ(cut.exit_status, 1);
  EXPECT_THAT(cut.errors, HasSubstr("it was cut short, or an older copy was put back\n"));
  EXPECT_THAT(cut.output, HasSubstr("trial")) << "the analysis is there all the same";
  expect_refused(folder.analyze({"--receipt", "nonsense"}), "'nonsense' is no receipt of a session");
}

TEST(SessionProgram, IsOpenedEarlyOnlyWithAReasonThatItKeeps) {
  const SessionFolder folder;
  ASSERT_EQ(folder.make().exit_status, 0);
  expect_refused(folder.analyze(), "the session is not finished; to open it early say why with --reason");
  const Outcome early = folder.analyze({"--reason", "the study was stopped"});
  EXPECT_EQ(early.exit_status, 0) << early.errors;
  ASSERT_EQ(folder.run().exit_status, 0);
  EXPECT_THAT(folder.analyze().errors, HasSubstr("opened before its end"));
  EXPECT_THAT(run_kerf({"info", folder.path("s.h5")}).output, HasSubstr("the study was stopped"));
}

TEST(SessionProgram, RefusesAProtocolThatCannotBe) {
  const SessionFolder folder;
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = kerf::test::protocol_text("design = \"abx\"\ntrials = 4\ndevice = \"sim:scissors\"\n");
    text.replace(text.find(from), from.size(), to);
    write_text(folder.protocol(), text);
    return folder.make();
  };
  expect_refused(with("soft.law.toml", "none.law.toml"), "p.protocol.toml:9: there is no file");
  expect_refused(with("law = \"soft.law.toml\"", "recording = \"none.h5\""), "there is no file");
  expect_refused(with("abx", "abc"), "p.protocol.toml:3: ");
  write_text(folder.path("odd.law.toml"), "model = \"odd\"\n");
  expect_refused(with("soft.law.toml", "odd.law.toml"), "odd");
  EXPECT_FALSE(std::filesystem::exists(folder.path("s.h5"))) << "and nothing is written";
}

TEST(SessionProgram, RefusesALawThatFailsItsCheckOnTheDevice) {
  const SessionFolder folder;
  std::string law = kerf::test::law_called("stiff.law.toml");
  const std::string from = "parallel_stiffness = { value = 8";
  law.replace(law.find(from), from.size(), "parallel_stiffness = { value = 800");
  write_text(folder.path("stiff.law.toml"), law);
  expect_refused(
      folder.make(),
      "sample 'stiff' fails its check on sim:scissors: its force is cut to the limit of the device");
  // Another device has no such axis.
  expect_refused(folder.make({"--device", "sim:premium"}), "cannot be rendered on sim:premium");
}

TEST(SessionProgram, RefusesWhoIsNotItsSubjectOrHasNotItsKey) {
  const SessionFolder folder;
  expect_refused(run_kerf({"session", "new", folder.protocol(), "--subject", "Anna Smith", "-o",
                           folder.path("s.h5"), "--key-file", folder.path("k.key")}),
                 "no name");
  ASSERT_EQ(folder.make().exit_status, 0);
  ASSERT_EQ(run_kerf({"session", "key", folder.path("other.key")}).exit_status, 0);
  expect_refused(
      run_kerf({"session", "run", folder.path("s.h5"), "--rehearse", "--key-file", folder.path("other.key")}),
      "key");
  expect_refused(run_kerf({"session", "key", folder.path("k.key")}), "k.key");
  expect_refused(run_kerf({"session", "run", folder.path("s.h5"), "--rehearse"}), "--key-file");
}

TEST(SessionProgram, TakesAPassphraseThatNobodySees) {
  const SessionFolder folder;
  const auto make = [&](const std::vector<std::string>& answers) {
    return at_a_terminal({"session", "new", folder.protocol(), "--subject", "S01", "-o", folder.path("s.h5")},
                         answers);
  };
  expect_refused(make({"short"}), "expected 8 at least");
  expect_refused(make({"four words of mine", "four words of thine"}), "are not the same");
  expect_refused(make({"\x03"}), "no passphrase was given");
  const Outcome made = make({"four words of mine", "four w\x7fwords\x7f\x7f\x7f\x7f\x7fwords of mine"});
  ASSERT_EQ(made.exit_status, 0) << made.errors;
  EXPECT_THAT(made.errors, Not(HasSubstr("words")));
  const auto run = [&](const std::string& passphrase) {
    return at_a_terminal({"session", "run", folder.path("s.h5"), "--rehearse"}, {passphrase});
  };
  expect_refused(run("four words of thine"), "does not open with this key");
  EXPECT_EQ(run("four words of mine").exit_status, 0);
  expect_refused(folder.analyze(), "--key-file: the session was sealed with a passphrase");
}

TEST(SessionProgram, RefusesASessionThatIsFinishedOrTamperedWith) {
  const SessionFolder folder;
  ASSERT_EQ(folder.make().exit_status, 0);
  ASSERT_EQ(folder.run().exit_status, 0);
  expect_refused(folder.run(), "the session is finished");
  std::string bytes = read_text(folder.path("s.h5"));
  const std::size_t at = bytes.find("sim:scissors");
  ASSERT_NE(at, std::string::npos);
  bytes[at] = 't';
  write_text(folder.path("s.h5"), bytes);
  expect_refused(folder.analyze(), "chang");
}

TEST(SessionProgram, RefusesASecondRunOfOneFile) {
  const SessionFolder folder;
  ASSERT_EQ(folder.make().exit_status, 0);
  {
    const SealKey key = SealKey::from_file(folder.path("k.key"), derivation_of(folder.path("s.h5")));
    const SessionStore running(folder.path("s.h5"), key, SessionStore::Purpose::run);
    expect_refused(folder.run(), "is being run by another process");
  }
  EXPECT_EQ(folder.run().exit_status, 0) << "and nothing is lost";
}

TEST(SessionProgram, GoesOnAfterTheDeviceWasLost) {
  const SessionFolder folder;
  ASSERT_EQ(folder.make().exit_status, 0);
  const Outcome lost = folder.run({"--rehearse", "--no-check", "--device", "sim:scissors?fault=unplug@5s"});
  EXPECT_EQ(lost.exit_status, 3);
  EXPECT_THAT(lost.errors, HasSubstr("the device was lost"));
  const Outcome info = run_kerf({"info", folder.path("s.h5"), "--json"});
  EXPECT_EQ(nlohmann::json::parse(info.output)["trials"], 2) << "two of them took 4.8 s";
  ASSERT_EQ(folder.run().exit_status, 0);
  EXPECT_EQ(nlohmann::json::parse(run_kerf({"info", folder.path("s.h5"), "--json"}).output)["trials"], 4);
}

TEST(SessionProgram, SaysWhatIsMissingOnTheCommandLine) {
  const SessionFolder folder;
  expect_refused(run_kerf({"session"}), "needs a verb");
  expect_refused(run_kerf({"session", "new", folder.protocol(), "-o", folder.path("s.h5"), "--key-file",
                           folder.path("k.key")}),
                 "--subject");
  expect_refused(run_kerf({"session", "analyze", folder.path("none.h5"), "--key-file", folder.path("k.key")}),
                 "there is no such file");
  ASSERT_EQ(folder.make().exit_status, 0);
  expect_refused(folder.run({"--rehearse", "--page"}), "leave out --page");
  expect_refused(folder.run({"--rehearse", "--device", "falcon:0"}), "--rehearse is for simulated devices");
  expect_refused(folder.run({"--buttons"}), "has no buttons");
}

}  // namespace
}  // namespace kerf::bench
