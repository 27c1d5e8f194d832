#include "kerf/models/law.h"

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace kerf::models {
namespace {

constexpr std::size_t law_count = std::variant_size_v<AnyLaw<double>>;

/// Calls `f.template operator()<L>()` for the law of that name.
template <typename F, std::size_t... I>
auto dispatch(std::string_view model, F&& f, std::index_sequence<I...>) {
  using Result = decltype(f.template operator()<std::variant_alternative_t<0, AnyLaw<double>>>());
  std::optional<Result> result;
  const auto attempt = [&]<typename L>() {
    if (L::name == model) result = f.template operator()<L>();
  };
  (attempt.template operator()<std::variant_alternative_t<I, AnyLaw<double>>>(), ...);
  if (!result) {
    std::ostringstream message;
    message << "unknown law '" << model << "'; the laws are";
    ((message << (I ? ", " : " ") << std::variant_alternative_t<I, AnyLaw<double>>::name), ...);
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

template <std::size_t... I>
Law::State state_of(std::size_t index, std::index_sequence<I...>) noexcept {
  Law::State state;
  ((index == I ? static_cast<void>(state.emplace<I>()) : static_cast<void>(0)), ...);
  return state;
}

template <std::size_t I>
double step_as(const AnyLaw<double>& law, Law::State& state, const Motion& motion, double period_s) noexcept {
  auto* const own = std::get_if<I>(&state);
  if (own == nullptr) return std::numeric_limits<double>::quiet_NaN();  // another law's state: a fault
  return std::get_if<I>(&law)->step(*own, motion, period_s);
}

}  // namespace

std::vector<LawInfo> registry() {
  return []<std::size_t... I>(std::index_sequence<I...>) {
    return std::vector<LawInfo>{{std::variant_alternative_t<I, AnyLaw<double>>::name,
                                 std::variant_alternative_t<I, AnyLaw<double>>::equation}...};
  }
  (std::make_index_sequence<law_count>{});
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

Law Law::make(std::string_view model, std::span<const double> values, const Options& options) {
  check_values(model, parameters(model, options), values);
  auto law = dispatch(model, [&]<typename L>() { return AnyLaw<double>(L::make(values, options)); });
  return {std::move(law), {values.begin(), values.end()}, options};
}

std::string_view Law::model() const noexcept {
  return std::visit([](const auto& law) { return std::string_view(law.name); }, law_);
}

Law::State Law::initial_state() const noexcept {
  return state_of(law_.index(), std::make_index_sequence<law_count>{});
}

Response Law::step(State& state, const Motion& motion, double period_s) const noexcept {
  if (!std::isfinite(motion.penetration) || !std::isfinite(motion.velocity) || !(period_s > 0.0)) {
    return {.force = 0.0, .fault = true};
  }
  static constexpr auto steps = []<std::size_t... I>(std::index_sequence<I...>) {
    return std::array{&step_as<I>...};
  }
  (std::make_index_sequence<law_count>{});
  const double force = steps[law_.index()](law_, state, motion, period_s);
  if (!std::isfinite(force)) return {.force = 0.0, .fault = true};
  return {.force = force, .fault = false};
}

}  // namespace kerf::models
