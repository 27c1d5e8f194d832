#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <kerf/schema/recording.h>

#include "prepare/bias.h"
#include "prepare/blank_off.h"
#include "prepare/filter.h"
#include "prepare/onset.h"
#include "prepare/score.h"
#include "prepare/weight.h"

namespace kerf::bench {

/// Labels to score contacts against: rows where a channel has a value.
struct Labels {
  std::string channel;
  double value = 0.0;
};

/// What `kerf prepare` is asked to do. Nothing is done unless asked for.
struct PrepareOptions {
  bool drop_gaps = false;
  bool weight = false;
  WeightOptions weight_options;
  std::optional<BlankOptions> blank;
  bool bias = false;
  bool drift = false;  ///< with the bias
  bool onset = false;
  std::string axis;                 ///< along which onsets are told; empty: the only one, or none
  std::vector<std::string> signal;  ///< axes (their force) or channels that tell a contact; empty: the axis,
                                    ///< or all axes with a force in N
  OnsetOptions contact;             ///< `free` also names the rows for bias and weight
  std::optional<FilterSpec> filter;
  bool filter_position = false;
  std::optional<double> from_s;
  std::optional<double> to_s;
  std::vector<std::uint32_t> cycles;
  std::optional<Labels> labels;
};

/// The recording as it is afterwards, and what every step did.
struct Prepared {
  schema::Recording recording;
  std::size_t rows_before = 0;
  std::size_t gap_rows = 0;
  std::optional<Weight> weight;
  std::optional<BlankTaken> blank;
  std::optional<Bias> bias;
  std::string contact_signal;
  std::optional<ContactsFound> contacts;  ///< rows count as they did before rows were chosen
  std::optional<FilterReport> filter;
  std::optional<ContactScore> score;
  std::vector<std::string> steps;  ///< as they stand in the history
  std::vector<std::string> warnings;
};

/// Runs the steps that are asked for, always in this order:
///
///     gaps -> weight -> blank -> bias and drift -> onset -> score -> filter -> time span -> cycles
///
/// The blank goes before the bias, which takes what the zeros of both differ by, and before contacts are
/// looked for, since friction is none. Contacts are looked for in the force before the filter, which would
/// smear them; rows are chosen last, so that the filter sees no seams and the bias comes from all free rows.
/// Every step appends a line to the recording's history.
/// @throws std::invalid_argument if nothing is asked for, or a step cannot be done.
[[nodiscard]] Prepared prepare(schema::Recording recording, const PrepareOptions& options);

}  // namespace kerf::bench
