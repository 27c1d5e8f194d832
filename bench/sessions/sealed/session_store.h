#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <kerf/schema/recording.h>
#include <kerf/schema/session.h>

#include "protocol/judgement.h"
#include "protocol/plan.h"
#include "protocol/trial_rules.h"
#include "sealed/blake2b.h"
#include "sealed/seal.h"

namespace kerf::bench {

/// One tick of a trial.
struct TraceRow {
  schema::Row row;          ///< `tick` and `time_s` of the loop
  std::uint8_t slot = 255;  ///< that plays, or to which the force goes; 255: none
};

/// A trial that was answered, or taken back.
struct RecordedTrial {
  TrialPlan what;                                            ///< with its level
  std::size_t answer = 0;                                    ///< a slot, or no_answer
  double number = std::numeric_limits<double>::quiet_NaN();  ///< that was written, where one is asked for
  double response_s = 0.0;                                   ///< from the first force to the answer
  /// From the first force until it could be answered; NaN in files of earlier versions.
  double answerable_s = std::numeric_limits<double>::quiet_NaN();

  /// From when it could be answered, where that is known, to the answer: without the stimuli of a sequence.
  [[nodiscard]] double decision_s() const noexcept {
    return std::isfinite(answerable_s) ? response_s - answerable_s : response_s;
  }

  [[nodiscard]] bool is_void() const noexcept { return !void_reasons.empty(); }

  std::size_t switches = 0;
  std::vector<VoidReason> void_reasons;  ///< why it does not count and, as long as it may, comes again
  std::string at;                        ///< when it was answered, ISO 8601, UTC
  std::vector<schema::Axis> axes;
  std::vector<TraceRow> trace;
  std::vector<schema::Channel> channels;  ///< names and units of Row::channels; the values are in the trace
};

/// A questionnaire that was filled in, under the seal as trials are: it tells which tissue came when.
struct FilledQuestionnaire {
  std::size_t tissue = 0;      ///< after whose trials
  std::vector<double> scores;  ///< item by item
  std::string at;              ///< ISO 8601, UTC
};

/// What a session is made of.
struct SessionSetUp {
  Protocol protocol;  ///< with its gains
  std::string subject;
  std::size_t number = 1;
  std::size_t subjects = 1;
  Plan plan;
};

/// A session file with its key: the one way to what is under the seal.
///
/// While a session runs, every entry is appended to FILE.journal and flushed to the disk before anything goes
/// on; close() puts them into FILE at once. A journal that a crash left is taken up by the next open, without
/// a last entry that is torn. An exclusive lock on the journal refuses a second run.
class SessionStore {
 public:
  /// @throws std::invalid_argument: `file` exists and not `replace`; a subject code that is none (1 to 16 of
  ///         A-Z a-z 0-9 _ -). std::system_error.
  static void create(const std::filesystem::path& file, const SessionSetUp& set_up, const SealKey& key,
                     const schema::KeyDerivation& derivation, bool replace);

  /// Opens it to go on with, or to read it. Checks every seal.
  /// @throws std::invalid_argument: no such file, wrong key, tampered with (naming the entry), run by another
  ///         process. schema::FormatError, std::system_error.
  enum class Purpose { run, read };
  SessionStore(std::filesystem::path file, const SealKey& key, Purpose purpose);
  SessionStore(const SessionStore&) = delete;
  SessionStore& operator=(const SessionStore&) = delete;
  ~SessionStore();  ///< without close() the journal stays, as after a crash

  [[nodiscard]] const Protocol& protocol() const noexcept;
  [[nodiscard]] const Plan& plan() const noexcept;
  [[nodiscard]] const schema::Session& session() const noexcept;  ///< with the entries of the journal
  /// The answers so far, without their traces.
  [[nodiscard]] const std::vector<RecordedTrial>& trials() const noexcept;
  /// With its trace. @throws std::out_of_range.
  [[nodiscard]] RecordedTrial trial(std::size_t index) const;
  [[nodiscard]] const std::vector<FilledQuestionnaire>& questionnaires() const noexcept;
  [[nodiscard]] bool finished() const;  ///< there is an entry "finished"
  /// Each time that the order was looked at before the session was finished, in words.
  [[nodiscard]] std::vector<std::string> early_openings() const;
  /// What all entries up to so many are bound to (SealedEntries). @throws std::out_of_range.
  [[nodiscard]] const Digest& chain_after(std::size_t entries) const;
  /// What is odd and no tampering: a torn last entry that was dropped.
  [[nodiscard]] const std::vector<std::string>& warnings() const noexcept;

  /// Purpose::run. Both are on the disk when they return. @throws std::system_error.
  void append(const RecordedTrial& trial);
  void append(const FilledQuestionnaire& filled);
  void note(const std::string& kind, const std::string& text);  ///< "run", "quit", "opened", "finished"

  /// Puts the journal into the file. @throws std::system_error; the journal then stays.
  void close();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// By what the key of a session is made, to know what to ask for.
[[nodiscard]] schema::KeyDerivation derivation_of(const std::filesystem::path& file);

/// @throws std::invalid_argument: no session; two protocols, or laws, that differ; a session that is there
/// twice.
void require_one_study(const std::vector<const SessionStore*>& sessions);

/// What the subject of a session answered to its questionnaires, in order; `number` goes with each.
[[nodiscard]] std::vector<QuestionnaireAnswers> questionnaires_of(const SessionStore& store,
                                                                  std::size_t number);

/// The judgements of sessions of one study. @throws as require_one_study() does.
[[nodiscard]] Study study_of(const std::vector<const SessionStore*>& sessions);

}  // namespace kerf::bench
