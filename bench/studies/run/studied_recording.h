#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "recordings/row_span.h"

namespace kerf::bench {

/// A parameter of a law, as one recording gives it, in SI.
struct StudiedParameter {
  std::string name;
  std::string unit;
  double value = 0.0;
  double std_error = 0.0;    ///< infinite: the recording sets no limit
  bool is_positive = false;  ///< by nature: recordings differ by factors
};

/// A law fitted to one recording; errors in the force's unit.
struct StudiedLaw {
  std::string model;
  std::size_t free_parameters = 0;
  double rmse = 0.0;
  double held_out = 0.0;  ///< on cycles (or blocks of time) that it was not fitted to; NaN: none
  bool can_be_chosen = false;
  bool within_jnd = false;  ///< held out
  std::string blame;        ///< what is to blame where it is not
  std::vector<StudiedParameter> parameters;
  /// Options that a fit took from this recording, such as a depth at which a force is given: parameters are
  /// of one quantity only where these are the same.
  std::map<std::string, double> taken_from_it{};
};

struct StudiedCycle {
  std::uint32_t number = 0;
  double begin_s = 0.0;
  double closing_s = 0.0;
  double peak = 0.0;
  double closing_work = 0.0;  ///< [work_unit()]
  bool is_good = true;
  std::string reason;  ///< why it is not, or what was found and accepted
};

/// What a blank took off a recording; root mean squares over the rows that it covers, in the force's unit.
struct StudiedBlank {
  std::string name;      ///< of the blank in the study; empty: none was taken off
  std::string why_none;  ///< why not
  std::uint64_t rows = 0;
  std::uint64_t covered = 0;
  std::size_t cycles = 0;  ///< of the blank
  double force_rms = 0.0;  ///< before
  double taken_rms = 0.0;
  double spread_rms = 0.0;       ///< of the blank from cycle to cycle
  double negative_before = 0.0;  ///< share of the rows below zero
  double negative_after = 0.0;
  double pulling_share = 0.0;  ///< below zero by more than two spreads and what is felt, after
  /// Rows from which nothing was taken: laws run through them, and are not fitted to them.
  std::vector<RowSpan> uncovered{};
  /// without_parts(): quantities by name, with one part of the blank's cycles left out after the other.
  std::vector<std::map<std::string, double>> without{};

  [[nodiscard]] bool is_taken() const { return !name.empty(); }
  /// What was taken off differs by more than half of itself from one cycle of the blank to the next.
  [[nodiscard]] bool is_hardly_known() const { return spread_rms > 0.5 * taken_rms; }
};

/// Another file with its own clock, t = shift + (1 + skew) t_other, that was taken into a recording.
struct StudiedJoin {
  std::string file;  ///< below the drawer's folder
  std::string on;
  double shift_s = 0.0;
  double shift_error_s = 0.0;  ///< standard error; NaN: it is one clock
  double skew = 0.0;
  double skew_error = 0.0;          ///< NaN also of one marker, which tells no skew
  double correlation = 0.0;         ///< NaN of markers and of one clock
  std::uint64_t markers = 0;        ///< that brought the clocks together; 0: it was something else
  std::uint64_t rows_left_out = 0;  ///< where one of both has nothing
};

/// The law `blade`, fitted to a recording of six axes.
struct StudiedBlade {
  std::string why_none;  ///< why it is not; empty: it is
  std::uint64_t rows_in_tissue = 0;
  double rmse = 0.0;  ///< [N], of the force's vector, on what it was fitted to
  double rms = 0.0;   ///< [N], of the force itself, in the tissue
  std::vector<StudiedParameter> parameters{};
};

/// All that a study knows of one recording. The same recording and settings give the same, to the last bit.
struct StudiedRecording {
  std::string key;      ///< of what it was made of: source, settings, program
  std::string failure;  ///< why there is nothing; empty: there is
  std::string content;  ///< content_sha256_of() the recording
  std::uint64_t rows = 0;
  double duration_s = 0.0;
  double period_s = 0.0;  ///< usual step
  std::string axis;       ///< along which it is fitted; empty: one of several, and none is named
  std::string position_unit;
  std::string force_unit;
  double travel = 0.0;             ///< range of the positions
  double peak = 0.0;               ///< largest force
  double rms = 0.0;                ///< root mean square force of the rows that count
  double jnd = 0.0;                ///< at it
  double floor = 0.0;              ///< error that the best map without an equation leaves; NaN: unknown
  double closing_direction = 0.0;  ///< 0: no cycles
  double clipped_at = 0.0;         ///< force at which the sensor is clipped; NaN: it is not
  std::uint64_t clipped_rows = 0;
  double least_shown = 0.0;  ///< smallest force beside exact zeros, of a sensor with a dead zone; NaN: none
  std::optional<StudiedJoin> join;    ///< nothing: it is one file
  std::optional<StudiedBlade> blade;  ///< nothing: it has not six axes
  std::optional<StudiedBlank> blank;  ///< nothing: none was to be taken off
  std::vector<std::string> warnings;
  std::vector<StudiedCycle> cycles;
  std::vector<StudiedLaw> laws;
  std::string chosen;  ///< the simplest law that serves, or the best; empty: none
  std::string why_chosen;
  std::string not_fitted;  ///< why no law was; a blank, or no force that is felt

  /// Rows by which no law is fitted or judged.
  [[nodiscard]] std::vector<RowSpan> not_the_tissue() const {
    return blank ? blank->uncovered : std::vector<RowSpan>{};
  }
};

/// What good cycles (or all) have of a quantity, in their order.
[[nodiscard]] std::vector<double> of_cycles(const StudiedRecording& recording, double StudiedCycle::*quantity,
                                            bool all_cycles = false);

[[nodiscard]] nlohmann::ordered_json as_json(const StudiedRecording& recording);
[[nodiscard]] nlohmann::ordered_json as_json(const StudiedJoin& join);
[[nodiscard]] nlohmann::ordered_json as_json(const StudiedBlade& blade);
[[nodiscard]] nlohmann::ordered_json as_json(const StudiedBlank& blank);
/// @throws nlohmann::json::exception for what as_json() did not write.
[[nodiscard]] StudiedRecording studied_recording(const nlohmann::ordered_json& json);

}  // namespace kerf::bench
