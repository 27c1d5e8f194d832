#include "kerf/models/law.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace kerf::models {
namespace {

constexpr std::size_t law_count = std::variant_size_v<AnyLaw>;

/// Calls `f.template operator()<L>()` for the law of that name.
template <typename F, std::size_t... I>
auto dispatch(std::string_view model, F&& f, std::index_sequence<I...>) {
  using Result = decltype(f.template operator()<std::variant_alternative_t<0, AnyLaw>>());
  std::optional<Result> result;
  const auto attempt = [&]<typename L>() {
    if (L::name == model) result = f.template operator()<L>();
  };
  (attempt.template operator()<std::variant_alternative_t<I, AnyLaw>>(), ...);
  if (!result) {
    std::ostringstream message;
    message << "unknown law '" << model << "'; the laws are";
    ((message << (I ? ", " : " ") << std::variant_alternative_t<I, AnyLaw>::name), ...);
    throw std::invalid_argument(message.str());
  }
  return *std::move(result);
}

template <typename F>
auto dispatch(std::string_view model, F&& f) {
  return dispatch(model, std::forward<F>(f), std::make_index_sequence<law_count>{});
}

void check_values(std::string_view model, const std::vector<ParameterInfo>& parameters,
                  std::span<const double> values) {
  std::ostringstream message;
  message << "law '" << model << "': ";
  if (values.size() != parameters.size()) {
    message << "takes " << parameters.size() << " parameters, got " << values.size();
    throw std::invalid_argument(message.str());
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i] >= parameters[i].lower && values[i] <= parameters[i].upper) continue;
    message << "parameter '" << parameters[i].name << "' is " << values[i] << ", expected a number from "
            << parameters[i].lower << " to " << parameters[i].upper;
    throw std::invalid_argument(message.str());
  }
}

template <typename L>
concept Spatial = requires {
  L::axes();
};

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// One tick as law number I, or a fault if the state is another law's, or the law of the other kind.
template <std::size_t I>
double step_as(const AnyLaw& law, Law::State& state, const Motion& motion, double period_s) noexcept {
  if constexpr (Spatial<std::variant_alternative_t<I, AnyLaw>>) {
    return not_a_number;
  } else {
    auto* const own = std::get_if<I>(&state);
    return own == nullptr ? not_a_number : std::get_if<I>(&law)->step(*own, motion, period_s);
  }
}
template <std::size_t I>
AxisValues step_as(const AnyLaw& law, Law::State& state, const SpatialMotion& motion,
                   double period_s) noexcept {
  if constexpr (Spatial<std::variant_alternative_t<I, AnyLaw>>) {
    if (auto* const own = std::get_if<I>(&state)) return std::get_if<I>(&law)->step(*own, motion, period_s);
  }
  return {not_a_number};
}

template <typename Answer, typename Input>
constexpr auto steps = []<std::size_t... I>(std::index_sequence<I...>) {
  using Step = Answer (*)(const AnyLaw&, Law::State&, const Input&, double) noexcept;
  return std::array<Step, law_count>{&step_as<I>...};
}
(std::make_index_sequence<law_count>{});

template <typename L>
LawInfo info_of() {
  LawInfo info{.name = L::name, .equation = L::equation, .position_unit = {}, .force_unit = {}};
  if constexpr (requires { L::position_unit; }) {
    info.position_unit = L::position_unit;
    info.force_unit = L::force_unit;
  }
  return info;
}

}  // namespace

std::vector<LawInfo> registry() {
  return []<std::size_t... I>(std::index_sequence<I...>) {
    return std::vector<LawInfo>{info_of<std::variant_alternative_t<I, AnyLaw>>()...};
  }
  (std::make_index_sequence<law_count>{});
}

LawInfo law_info(std::string_view model) {
  return dispatch(model, []<typename L>() { return info_of<L>(); });
}

std::vector<ParameterInfo> Law::parameters(std::string_view model, const Options& options) {
  return dispatch(model, [&]<typename L>() {
    const OptionReader refuses_unknown(L::name, L::options(), options);
    return L::parameters(options);
  });
}

std::vector<OptionInfo> Law::options(std::string_view model) {
  return dispatch(model, []<typename L>() { return L::options(); });
}

std::vector<LawAxis> Law::axes(std::string_view model) {
  return dispatch(model, []<typename L>() {
    if constexpr (Spatial<L>) return L::axes();
    return std::vector<LawAxis>{};
  });
}

Law Law::make(std::string_view model, std::span<const double> values, const Options& options) {
  check_values(model, parameters(model, options), values);
  auto law = dispatch(model, [&]<typename L>() { return AnyLaw(L::make(values, options)); });
  return {std::move(law), {values.begin(), values.end()}, options};
}

std::string_view Law::model() const noexcept {
  return std::visit([](const auto& law) { return std::string_view(law.name); }, law_);
}

Law::State Law::initial_state() const {
  return [this]<std::size_t... I>(std::index_sequence<I...>) {
    State state;
    const auto begin = [&]<std::size_t Index>() {
      if (law_.index() != Index) return;
      if constexpr (requires { std::get<Index>(law_).initial_state(); }) {
        state.emplace<Index>(std::get<Index>(law_).initial_state());
      } else {
        state.emplace<Index>();
      }
    };
    (begin.template operator()<I>(), ...);
    return state;
  }
  (std::make_index_sequence<law_count>{});
}

Response Law::step(State& state, const Motion& motion, double period_s) const noexcept {
  if (!std::isfinite(motion.penetration) || !std::isfinite(motion.velocity) || !(period_s > 0.0) ||
      !std::isfinite(period_s)) {
    return {.force = 0.0, .fault = true};
  }
  const double force = steps<double, Motion>[law_.index()](law_, state, motion, period_s);
  if (!std::isfinite(force)) return {.force = 0.0, .fault = true};
  return {.force = force, .fault = false};
}

SpatialResponse Law::step(State& state, const SpatialMotion& motion, double period_s) const noexcept {
  const auto all_finite = [](const AxisValues& values) {
    return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
  };
  if (!all_finite(motion.position) || !all_finite(motion.velocity) || !(period_s > 0.0) ||
      !std::isfinite(period_s)) {
    return {.force = {}, .fault = true};
  }
  const AxisValues force = steps<AxisValues, SpatialMotion>[law_.index()](law_, state, motion, period_s);
  if (!all_finite(force)) return {.force = {}, .fault = true};
  return {.force = force, .fault = false};
}

}  // namespace kerf::models
