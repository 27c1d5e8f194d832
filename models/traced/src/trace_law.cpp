#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>

// Before the laws, which ask of their scalar which others go with it.
#include "kerf/models/foreign.h"
#include "kerf/models/registry.h"
#include "kerf/traced/program.h"
#include "kerf/traced/traced.h"
#include "trace.h"

namespace kerf::traced {
namespace {

template <typename L, typename T>
struct WithScalar;
template <template <typename> typename L, typename From, typename T>
struct WithScalar<L<From>, T> {
  using Law = L<T>;
};

/// Goes through a state: numbers, and what decides more than a number.
template <typename OnNumber, typename OnMode>
struct Visitor {
  OnNumber on_number;
  OnMode on_mode;

  template <typename Real>
  void operator()(const std::string& name, Traced<Real>& number) {
    on_number(name, number, false);
  }
  template <typename Real, std::size_t N>
  void operator()(const std::string& name, std::array<Traced<Real>, N>& numbers) {
    for (Traced<Real>& number : numbers) on_number(name, number, true);
  }
  template <typename Mode>
  requires(std::is_integral_v<Mode> || std::is_enum_v<Mode>) void operator()(const std::string& name,
                                                                             Mode& mode) {
    int value = static_cast<int>(mode);
    on_mode(name, value);
    mode = static_cast<Mode>(value);
  }
};

template <typename OnNumber, typename OnMode>
Visitor(OnNumber, OnMode) -> Visitor<OnNumber, OnMode>;

template <typename State>
auto modes_of(State& state) {
  std::vector<std::pair<std::string, int>> modes;
  Visitor visit{[](const std::string&, auto&, bool) {},
                [&](const std::string& name, int& value) { modes.emplace_back(name, value); }};
  state.each(visit);
  return modes;
}

/// What the state of the first tick holds, as memory.
template <typename State>
void lay_out(State& state, std::vector<Memory>& memory) {
  std::size_t place = 0;
  Visitor visit{
      [&]<typename Number>(const std::string& name, Number& number, bool is_array) {
        if (memory.empty() || memory.back().name != name)
          memory.push_back(
              {.name = name, .is_array = is_array, .single = Number::single, .first = {}, .place = place});
        memory.back().first.push_back(number.value);
        ++place;
      },
      [](const std::string&, int&) {}};
  state.each(visit);
}

/// A state whose numbers are those in memory, with these modes.
template <typename State>
void recall(State& state, const std::vector<std::pair<std::string, int>>& modes) {
  std::int32_t place = 0;
  std::size_t mode = 0;
  Visitor visit{[&]<typename Number>(const std::string&, Number& number, bool) {
                  number.node = Trace::running().add(
                      {.operation = Operation::memory, .single = Number::single, .place = place});
                  ++place;
                },
                [&](const std::string&, int& value) { value = modes[mode++].second; }};
  state.each(visit);
}

template <typename State>
std::vector<Node> kept(State& state) {
  std::vector<Node> all;
  Visitor visit{[&](const std::string&, auto& number, bool) { all.push_back(number.noted()); },
                [](const std::string&, int&) {}};
  state.each(visit);
  return all;
}

Traced<double> brought(Input input) {
  Traced<double> number;
  number.node = Trace::running().add({.operation = Operation::input, .place = input});
  return number;
}

template <typename L>
Program trace_law(const L& law, Trace& trace) {
  using State = typename L::State;
  State first{};
  lay_out(first, trace.program.memory);
  std::vector<Way>& ways = trace.program.ways;
  ways.push_back({.because = modes_of(first), .tick = {}});
  const auto way_of = [&](State& state) {
    auto modes = modes_of(state);
    const auto place = static_cast<std::size_t>(
        std::find_if(ways.begin(), ways.end(), [&](const Way& way) { return way.because == modes; }) -
        ways.begin());
    if (place == ways.size()) ways.push_back({.because = std::move(modes), .tick = {}});
    return place;
  };
  for (std::size_t i = 0; i < ways.size(); ++i) {
    const auto because = ways[i].because;
    Tick tick = trace.along_all_ways([&] {
      State state{};
      recall(state, because);
      const auto force = law.step(state, {brought(penetration), brought(velocity)}, brought(period_s));
      Outcome outcome{.force = force.noted(), .next = kept(state), .way = 0};
      outcome.way = way_of(state);
      return outcome;
    });
    ways[i].tick = std::move(tick);
  }
  return std::move(trace.program);
}

template <typename L, typename Real>
Program trace_in(std::span<const double> values, const models::Options& options) {
  using Law = typename WithScalar<L, Traced<Real>>::Law;
  Trace trace;
  trace.program.single = std::is_same_v<Real, float>;
  const std::vector<Traced<Real>> parameters = [&] {
    std::vector<Traced<Real>> all;
    for (const double value : values) all.emplace_back(static_cast<Real>(value));
    return all;
  }();
  return trace_law(Law::make(parameters, options), trace);
}

template <typename L>
Program trace_registered(std::span<const double> values, const models::Options& options) {
  if constexpr (models::SpatialLaw<L>) {
    std::string axes;
    for (const auto& axis : L::axes()) axes += (axes.empty() ? "" : ", ") + std::string(axis.name);
    throw std::invalid_argument("it acts on the axes " + axes +
                                " at once; a file of C carries a law along one axis");
  } else {
    if constexpr (L::facts.in_float) {
      const models::OptionReader reader(L::name, L::options(), options);
      if (reader.choice("precision", {"double", "float"}) == "float")
        return trace_in<L, float>(values, options);
    }
    return trace_in<L, double>(values, options);
  }
}

template <std::size_t... I>
Program trace_at(std::string_view model, std::span<const double> values, const models::Options& options,
                 std::index_sequence<I...>) {
  Program program;
  const bool found =
      ((std::tuple_element_t<I, models::Registry>::name == model &&
        (program = trace_registered<std::tuple_element_t<I, models::Registry>>(values, options), true)) ||
       ...);
  if (!found) throw std::invalid_argument("there is no such law");
  return program;
}

}  // namespace

Program trace(std::string_view model, std::span<const double> values, const models::Options& options) {
  const std::string law = "law '" + std::string(model) + "': ";
  if (models::foreign_law(model) != nullptr)
    throw std::invalid_argument(law + "its code is that of a plug-in, which has no equation to write out");
  try {
    return trace_at(model, values, options, std::make_index_sequence<std::tuple_size_v<models::Registry>>{});
  } catch (const std::invalid_argument& why) {
    throw std::invalid_argument(law + why.what());
  }
}

}  // namespace kerf::traced
