#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <kerf/psychophysics/binomial.h>
#include <kerf/psychophysics/sequential/alpha_spending.h>

#include "protocol/protocol.h"

// What is decided of a study before its first answer: experiment.toml, docs/experiments.md.

namespace kerf::bench {

/// Who may be replaced by another participant, who takes their order.
enum class ReplacementRule : std::uint8_t { never, dropped, dropped_or_excluded };

struct ParticipantPlan {
  std::size_t target = 0;
  std::size_t visits = 1;           ///< sessions of each
  std::vector<std::string> groups;  ///< of equal size; empty: one without a name
  ReplacementRule replace = ReplacementRule::dropped;
};

/// When the answers may be looked at, and when the study ends.
enum class StoppingKind : std::uint8_t { fixed, alpha_spending, bayes_factor };

struct StoppingRule {
  StoppingKind kind = StoppingKind::fixed;
  psychophysics::SpendingFunction spending = psychophysics::SpendingFunction::obrien_fleming;
  std::vector<std::size_t> looks;  ///< numbers of participants before the target, ascending; of no fixed rule
  double evidence = 10.0;          ///< bayes_factor: ends at it, or at one over it
};

/// Which participants are not analysed. What is not written here is a deviation.
struct ExclusionPlan {
  std::optional<double> faulty;       ///< a larger share of their trials had a fault
  std::optional<double> unfelt;       ///< or a slot without a force that can be felt
  std::optional<double> catch_right;  ///< less than this share of their catch trials were right
  std::vector<std::string> rules;     ///< what an experimenter has to see, in words
};

enum class PrimaryTest : std::uint8_t { difference, equivalence };

struct AnalysisPlan {
  PrimaryTest test = PrimaryTest::difference;
  double alpha = 0.05;
  std::optional<double> margin;   ///< of a preference
  std::optional<double> d_prime;  ///< where an answer is right
  std::optional<psychophysics::Interval> jnd_margins;
  ExclusionPlan exclude;
  StoppingRule stopping;
};

struct Experiment {
  std::string name;
  std::string protocol;  ///< a file, relative to the folder of this one
  ParticipantPlan participants;
  AnalysisPlan analysis;
  std::string toml;  ///< as it was read

  /// Numbers of participants at which the answers are looked at, the target last.
  [[nodiscard]] std::vector<std::size_t> planned_looks() const;
};

/// The file itself, or experiment.toml of a folder. @throws std::invalid_argument: there is none.
[[nodiscard]] std::filesystem::path experiment_file(const std::filesystem::path& file_or_folder);
/// Whether a command line names an experiment: a folder, or a file whose name ends with experiment.toml.
[[nodiscard]] bool is_experiment(const std::filesystem::path& file_or_folder);

/// @throws std::invalid_argument with file, line, found and expected; std::system_error.
[[nodiscard]] Experiment read_experiment(const std::filesystem::path& file);
/// From text; `name` stands for the file in messages.
[[nodiscard]] Experiment parse_experiment(const std::string& text, const std::string& name);

/// The protocol that it names. @throws as read_protocol() does; std::invalid_argument where test or stopping
/// rule are not of its design.
[[nodiscard]] Protocol protocol_of(const Experiment& experiment, const std::filesystem::path& file);
void require_fits(const Experiment& experiment, const Protocol& protocol, const std::string& file);

/// Whether the main test has two sides.
[[nodiscard]] bool is_two_sided(const Protocol& protocol, PrimaryTest test) noexcept;

[[nodiscard]] std::string_view name_of(PrimaryTest test) noexcept;
[[nodiscard]] std::string_view name_of(StoppingKind kind) noexcept;
[[nodiscard]] std::string_view name_of(psychophysics::SpendingFunction function) noexcept;
[[nodiscard]] std::string_view name_of(ReplacementRule rule) noexcept;

/// The file, with every key and what may stand there.
[[nodiscard]] std::string experiment_text(const Experiment& experiment);

}  // namespace kerf::bench
