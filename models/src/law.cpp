#include "kerf/models/law.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>

#include "any_law.h"
#include "kerf/models/foreign.h"
#include "kerf/models/registry.h"

namespace kerf::models {

namespace {

constexpr std::size_t law_count = std::tuple_size_v<Registry>;
template <Place I>
using LawAt = std::tuple_element_t<I, Registry>;

/// Calls `f.template operator()<I>()` for the place of the law of that name.
template <typename F, Place... I>
auto dispatch(std::string_view model, F&& f, std::index_sequence<I...>) {
  std::optional<decltype(f.template operator()<0>())> result;
  const auto attempt = [&]<Place At>() {
    if (LawAt<At>::name == model) result = f.template operator()<At>();
  };
  (attempt.template operator()<I>(), ...);
  if (!result) {
    std::ostringstream message;
    message << "unknown law '" << model << "'; the laws are";
    ((message << (I ? ", " : " ") << LawAt<I>::name), ...);
    for (const ForeignLaw* const foreign : foreign_laws()) message << ", " << foreign->info().name;
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

/// The same law in another scalar.
template <typename L, typename T>
struct WithScalar;
template <template <typename> typename L, typename From, typename T>
struct WithScalar<L<From>, T> {
  using Law = L<T>;
};

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// `Of` in the registry; laws in single precision have places of their own behind it.
template <typename L, Place Of>
struct StateOf final : AnyState {
  using Value = typename L::State;
  explicit StateOf(Value first) : AnyState(Of), value(std::move(first)) {}
  [[nodiscard]] std::unique_ptr<AnyState> copy() const override { return std::make_unique<StateOf>(value); }
  void assign(const AnyState& other) override { value = static_cast<const StateOf&>(other).value; }

  Value value;
};

template <typename L, Place Of>
struct RegisteredLaw final : AnyLaw {
  explicit RegisteredLaw(L of) : law(std::move(of)) {}
  [[nodiscard]] std::string_view name() const noexcept override { return L::name; }
  [[nodiscard]] std::unique_ptr<AnyState> initial_state() const override {
    if constexpr (requires { law.initial_state(); }) {
      return std::make_unique<StateOf<L, Of>>(law.initial_state());
    } else {
      return std::make_unique<StateOf<L, Of>>(typename L::State{});
    }
  }
  [[nodiscard]] double step(AnyState& state, const Motion& motion, double period_s) const noexcept override {
    if constexpr (!SpatialLaw<L>) {
      if (state.law == Of) return law.step(static_cast<StateOf<L, Of>&>(state).value, motion, period_s);
    }
    return not_a_number;
  }
  [[nodiscard]] AxisValues step(AnyState& state, const SpatialMotion& motion,
                                double period_s) const noexcept override {
    if constexpr (SpatialLaw<L>) {
      if (state.law == Of) return law.step(static_cast<StateOf<L, Of>&>(state).value, motion, period_s);
    }
    return {not_a_number};
  }
  // Flat: what a call would leave in memory would be waited for in the next tick.
  [[gnu::flatten]] void steps(AnyState& state, std::span<const Motion> motion,
                              std::span<const double> period_s,
                              std::span<double> force) const noexcept override {
    if constexpr (!SpatialLaw<L> && std::is_trivially_copyable_v<typename L::State>) {
      if (state.law != Of) return AnyLaw::steps(state, motion, period_s, force);
      // Beside the memory that it is kept in, so that it need not be written back in each tick.
      auto& kept = static_cast<StateOf<L, Of>&>(state).value;
      auto value = kept;
      step_each(motion, period_s, force, [&](const Motion& tick, double period) noexcept {
        return static_cast<double>(law.step(value, tick, period));
      });
      kept = value;
    } else {
      AnyLaw::steps(state, motion, period_s, force);
    }
  }
  [[nodiscard]] double stored_energy(const AnyState& state) const noexcept override {
    if constexpr (requires(const typename L::State& of) { law.stored_energy(of); }) {
      static_assert(noexcept(law.stored_energy(std::declval<const typename L::State&>())));
      if (state.law == Of) return law.stored_energy(static_cast<const StateOf<L, Of>&>(state).value);
    }
    return not_a_number;
  }

  L law;
};

template <Place I>
std::shared_ptr<const AnyLaw> registered(std::span<const double> values, const Options& options) {
  using L = LawAt<I>;
  if constexpr (L::facts.in_float) {
    const OptionReader reader(L::name, L::options(), options);
    if (reader.choice("precision", {"double", "float"}) == "float") {
      using Single = typename WithScalar<L, float>::Law;
      // What refuses values that make no law does so in double, before they are rounded.
      (void)L::make(values, options);
      const std::vector<float> rounded(values.begin(), values.end());
      return std::make_shared<const RegisteredLaw<Single, I + law_count>>(Single::make(rounded, options));
    }
  }
  return std::make_shared<const RegisteredLaw<L, I>>(L::make(values, options));
}

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
  auto laws = []<std::size_t... I>(std::index_sequence<I...>) {
    return std::vector<LawInfo>{info_of<LawAt<I>>()...};
  }
  (std::make_index_sequence<law_count>{});
  for (const ForeignLaw* const foreign : foreign_laws()) laws.push_back(foreign->info());
  return laws;
}

std::size_t place_in_registry(std::string_view model) {
  const std::vector<LawInfo> all = registry();
  return static_cast<std::size_t>(std::ranges::find(all, model, &LawInfo::name) - all.begin());
}

LawInfo law_info(std::string_view model) {
  if (const ForeignLaw* const foreign = foreign_law(model)) return foreign->info();
  return dispatch(model, []<Place I>() { return info_of<LawAt<I>>(); });
}

const LawFacts& law_facts(std::string_view model) {
  if (const ForeignLaw* const foreign = foreign_law(model)) return foreign->facts();
  return *dispatch(model, []<Place I>() { return &LawAt<I>::facts; });
}

std::vector<ParameterInfo> Law::parameters(std::string_view model, const Options& options) {
  if (const ForeignLaw* const foreign = foreign_law(model)) {
    const OptionReader refuses_all(model, {}, options);
    return foreign->parameters();
  }
  return dispatch(model, [&]<Place I>() {
    using L = LawAt<I>;
    const OptionReader refuses_unknown(L::name, L::options(), options);
    return L::parameters(options);
  });
}

std::vector<OptionInfo> Law::options(std::string_view model) {
  if (foreign_law(model) != nullptr) return {};
  return dispatch(model, []<Place I>() { return LawAt<I>::options(); });
}

std::vector<LawAxis> Law::axes(std::string_view model) {
  if (const ForeignLaw* const foreign = foreign_law(model)) return foreign->axes();
  return dispatch(model, []<Place I>() {
    if constexpr (SpatialLaw<LawAt<I>>) return LawAt<I>::axes();
    return std::vector<LawAxis>{};
  });
}

Law::State::State(std::unique_ptr<AnyState> state) noexcept : state_(std::move(state)) {}
Law::State::State(const State& other) : state_(other.state_ ? other.state_->copy() : nullptr) {}
Law::State::State(State&& other) noexcept = default;
Law::State& Law::State::operator=(State&& other) noexcept = default;
Law::State::~State() = default;

Law::State& Law::State::operator=(const State& other) {
  if (state_ && other.state_ && state_->law == other.state_->law) {
    state_->assign(*other.state_);
  } else {
    *this = State(other);
  }
  return *this;
}

Law::Law(std::shared_ptr<const AnyLaw> law, std::vector<double> values, Options options)
    : law_(std::move(law)), values_(std::move(values)), options_(std::move(options)) {}

Law Law::make(std::string_view model, std::span<const double> values, const Options& options) {
  check_values(model, parameters(model, options), values);
  if (const ForeignLaw* const foreign = foreign_law(model))
    return {made_of(*foreign, values), {values.begin(), values.end()}, options};
  auto law = dispatch(
      model, [&]<Place I>() -> std::shared_ptr<const AnyLaw> { return registered<I>(values, options); });
  return {std::move(law), {values.begin(), values.end()}, options};
}

std::string_view Law::model() const noexcept { return law_->name(); }

Law::State Law::initial_state() const { return State(law_->initial_state()); }

Response Law::step(State& state, const Motion& motion, double period_s) const noexcept {
  if (!is_sound(motion, period_s)) return {.force = 0.0, .fault = true};
  const double force = state.state_ ? law_->step(*state.state_, motion, period_s) : not_a_number;
  if (!std::isfinite(force)) return {.force = 0.0, .fault = true};
  return {.force = force, .fault = false};
}

void Law::steps(State& state, std::span<const Motion> motion, std::span<const double> period_s,
                std::span<double> force) const noexcept {
  if (state.state_) return law_->steps(*state.state_, motion, period_s, force);
  std::fill(force.begin(), force.end(), not_a_number);
}

SpatialResponse Law::step(State& state, const SpatialMotion& motion, double period_s) const noexcept {
  const auto all_finite = [](const AxisValues& values) {
    return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
  };
  if (!all_finite(motion.position) || !all_finite(motion.velocity) || !(period_s > 0.0) ||
      !std::isfinite(period_s)) {
    return {.force = {}, .fault = true};
  }
  if (!state.state_) return {.force = {}, .fault = true};
  const AxisValues force = law_->step(*state.state_, motion, period_s);
  if (!all_finite(force)) return {.force = {}, .fault = true};
  return {.force = force, .fault = false};
}

double Law::stored_energy(const State& state) const noexcept {
  const double energy = state.state_ ? law_->stored_energy(*state.state_) : not_a_number;
  return std::isfinite(energy) ? energy : not_a_number;
}

std::vector<double> Law::along(std::span<const Motion> motion, std::span<const double> period_s) const {
  std::vector<double> force(motion.size());
  State state = initial_state();
  steps(state, motion, period_s, force);
  for (double& one : force)
    if (std::isnan(one)) one = 0.0;  // as step() faults
  return force;
}

}  // namespace kerf::models
