#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "observers/simulate.h"
#include "plot/plot.h"

namespace kerf::bench {

/// What a simulation found, in lines for a terminal.
[[nodiscard]] std::vector<std::string> simulation_lines(const Simulation& simulation);

[[nodiscard]] nlohmann::ordered_json simulation_json(const Simulation& simulation);

/// The curve over numbers of trials as a table of comma-separated values.
[[nodiscard]] std::string simulation_csv(const Simulation& simulation);

/// Shares of right answers with the truth behind them; power, or the width of intervals, against trials; how
/// often intervals covered and tests gave false alarms.
[[nodiscard]] std::vector<Figure> simulation_charts(const Simulation& simulation);

/// One page with all of it. @throws std::runtime_error: gnuplot is missing or fails.
[[nodiscard]] std::string simulation_page(const Simulation& simulation);

}  // namespace kerf::bench
