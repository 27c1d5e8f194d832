#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <kerf/models/parameter.h>
#include <kerf/traced/traced.h>

namespace kerf::traced {

/// One operation; what it is of stands before it.
struct Noted {
  Operation operation = Operation::number;
  bool single = false;
  std::array<Node, 3> of{-1, -1, -1};
  std::int32_t place = 0;  ///< of an input, a number in memory, a table; how far behind a place
  double number = 0.0;

  bool operator==(const Noted&) const = default;
};

/// Places of what a tick brings.
enum Input : std::int32_t { penetration, velocity, period_s };

/// A number that a state keeps, or several of one name.
struct Memory {
  std::string name;
  bool is_array = false;
  bool single = false;
  std::vector<double> first;  ///< before the first tick
  std::size_t place = 0;      ///< of its first number in `Tick::next`
};

/// What a tick comes to once all its conditions are answered.
struct Outcome {
  Node force = 0;
  std::vector<Node> next;  ///< of every number in memory
  std::size_t way = 0;     ///< on which the next tick goes
};

/// The conditions that a tick meets, in order.
struct Tick {
  Node condition = of_the_law;  ///< `of_the_law`: none is left
  std::unique_ptr<Tick> yes;
  std::unique_ptr<Tick> no;
  Outcome outcome;
};

/// Ticks that begin with the same flags and modes in the state, which decide more than a number.
struct Way {
  std::vector<std::pair<std::string, int>> because;  ///< name and value of each
  Tick tick;
};

/// A law along one axis, written out: what a tick does with penetration, velocity and period.
struct Program {
  std::vector<Noted> nodes;
  std::vector<std::vector<double>> tables;
  std::vector<bool> table_is_single;
  std::vector<Memory> memory;
  std::vector<Way> ways;  ///< the first is that of the first tick
  bool single = false;    ///< the force is in single precision
};

/// The law of that model with these parameters, which must be as Law::make() takes them, run on traced
/// numbers along every way that its ticks can take.
/// @throws std::invalid_argument with the reason for one that cannot be written out: a law in space, one of a
///         plug-in, one that repeats something a number of times that a tick decides.
[[nodiscard]] Program trace(std::string_view model, std::span<const double> values,
                            const models::Options& options);

/// As a function of C99,
///
///     static double NAME_resisting(NAME_state* s, double x, double v, double T)
///
/// behind its state, NAME_state, plain data, and before `static void NAME_begin(NAME_state* s)`. Needs
/// math.h.
[[nodiscard]] std::string to_c(const Program& program, std::string_view name);

}  // namespace kerf::traced
