#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include <kerf/schema/session.h>

#include "sealed/blake2b.h"
#include "sealed/seal.h"

namespace kerf::bench {

/// What happened to an experiment: "registered", "assigned", "run", "dropped", "excluded", "look", "opened".
struct LogLine {
  std::string kind;
  std::string time;              ///< ISO 8601, UTC
  nlohmann::ordered_json facts;  ///< of this kind; with kind and time
  std::string chain;             ///< after it
};

/// experiment.log, beside the sessions of a study: JSON Lines to which lines are added and from which none is
/// taken.
///
/// Each line ends with "chain", BLAKE2b of the key, the chain of the line before, and the line up to there.
/// So nobody who has not the key can change, add or take out a line without being seen; but lines at the end
/// that were cut off can be told from what sessions and receipts say alone.
class ExperimentLog {
 public:
  using Facts = nlohmann::ordered_json;
  using Lines = std::vector<std::pair<std::string, Facts>>;  ///< kind, facts

  /// The text of a log that begins with "registered" and these facts, then with `more`.
  [[nodiscard]] static std::string begun(const SealKey& key, const schema::KeyDerivation& derivation,
                                         const Facts& registered, const Lines& more);
  /// By what the key of a log is made.
  [[nodiscard]] static schema::KeyDerivation derivation_of(const std::filesystem::path& file);

  /// @throws std::invalid_argument: no such file, another key, a line that was changed or taken out (naming
  ///         it); std::system_error.
  ExperimentLog(std::filesystem::path file, const SealKey& key);

  [[nodiscard]] const std::vector<LogLine>& lines() const noexcept { return lines_; }
  [[nodiscard]] const LogLine& registered() const { return lines_.front(); }
  /// The first digits of the chain after all lines, to be kept elsewhere.
  [[nodiscard]] std::string receipt() const;
  /// Whether the log still has the lines of a receipt. @throws std::invalid_argument for what is none.
  [[nodiscard]] bool bears_out(const std::string& receipt) const;
  /// What is odd and no tampering: a torn last line that was dropped.
  [[nodiscard]] const std::vector<std::string>& warnings() const noexcept { return warnings_; }

  /// On the disk when it returns. @throws std::system_error: then nothing was added.
  void append(const std::string& kind, const Facts& facts);

 private:
  void read(std::string_view text);

  std::filesystem::path file_;
  SealKey key_;
  std::vector<LogLine> lines_;
  std::string chain_;
  std::vector<std::string> warnings_;
};

/// experiment.log in the folder of an experiment's file.
[[nodiscard]] std::filesystem::path log_of(const std::filesystem::path& experiment_file);

/// BLAKE2b of a text in hexadecimal.
[[nodiscard]] std::string digest_of(std::string_view text);

}  // namespace kerf::bench
