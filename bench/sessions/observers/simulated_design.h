#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "protocol/protocol.h"

// How large a design is, and the same design larger or smaller.

namespace kerf::bench {

struct SimulationOptions;

/// The protocol in a file; of an experiment that which it names, and its number of participants, its test and
/// its stopping rule come into the options.
/// @throws std::invalid_argument as read_protocol() and read_experiment(), and if the options have already
///         what an experiment brings.
[[nodiscard]] Protocol protocol_to_simulate(const std::filesystem::path& file, SimulationOptions& options);

/// The protocol with another number of trials: of each pair or level; of a staircase at most so many.
/// @throws std::invalid_argument: none.
[[nodiscard]] Protocol with_trials(Protocol protocol, std::size_t trials);

/// What a subject answers about again and again: pairs, or levels but the standard's own.
[[nodiscard]] std::size_t cells_of(const Protocol& protocol);

/// What a design grows by: trials of each pair or level, of a staircase reversals; in words, how many there
/// are, and with another number of them.
[[nodiscard]] std::string counted_on_curve(Design design);
[[nodiscard]] std::size_t size_of(const Protocol& protocol);
[[nodiscard]] Protocol resized(const Protocol& protocol, std::size_t size);

/// How long a subject takes for so many trials: every slot once for its interval, however they are presented,
/// the answers, breaks at their least, practice included [s].
[[nodiscard]] double session_seconds(const Protocol& protocol, double trials, double answer_s);

}  // namespace kerf::bench
