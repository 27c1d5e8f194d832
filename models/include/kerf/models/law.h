#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include <kerf/models/exponential.h>
#include <kerf/models/kelvin.h>
#include <kerf/models/motion.h>
#include <kerf/models/parameter.h>
#include <kerf/models/piecewise.h>
#include <kerf/models/recording.h>

namespace kerf::models {

/// The registry: every scalar law, once. A new law is one header, one entry here and one test.
template <typename T>
using AnyLaw = std::variant<Kelvin<T>, Exponential<T>, Piecewise<T>, Recording<T>>;

/// What the registry knows of a law without building one.
struct LawInfo {
  std::string_view name;
  std::string_view equation;
};
[[nodiscard]] std::vector<LawInfo> registry();

/// The answer of a law in one tick.
struct Response {
  double force = 0.0;  ///< what the tissue exerts on the tool [N], positive when it resists
  bool fault = false;  ///< an input or the result was not finite; the force is then zero
};

/// A force law ready to be rendered: a value with its parameters, to be stepped with a State of its own.
class Law {
  template <typename Any>
  struct StatesOf;
  template <typename... Each>
  struct StatesOf<std::variant<Each...>> {
    // A law's place in the variant selects its state, also where two laws share a type of state.
    using type = std::variant<typename Each::State...>;
  };

 public:
  using State = StatesOf<AnyLaw<double>>::type;
  static_assert(std::is_trivially_copyable_v<State>);

  /// Builds a law by name; `values` in the order of `parameters(model, options)`.
  /// @throws std::invalid_argument with a sentence that names what is wrong: an unknown law or option, a
  ///         wrong number of values, a value that is not finite or outside its range.
  static Law make(std::string_view model, std::span<const double> values, const Options& options = {});

  /// The parameters of a law with these options, in order. @throws std::invalid_argument as make() does.
  static std::vector<ParameterInfo> parameters(std::string_view model, const Options& options = {});
  /// The options of a law. @throws std::invalid_argument for an unknown law.
  static std::vector<OptionInfo> options(std::string_view model);

  [[nodiscard]] std::string_view model() const noexcept;
  [[nodiscard]] const std::vector<double>& values() const noexcept { return values_; }
  [[nodiscard]] const Options& options() const noexcept { return options_; }
  [[nodiscard]] std::vector<ParameterInfo> parameters() const { return parameters(model(), options_); }
  [[nodiscard]] const AnyLaw<double>& any() const noexcept { return law_; }

  /// A state before the first tick.
  [[nodiscard]] State initial_state() const noexcept;

  /// One tick. Never throws, allocates or returns a number that is not finite.
  [[nodiscard]] Response step(State& state, const Motion& motion, double period_s) const noexcept;

 private:
  Law(AnyLaw<double> law, std::vector<double> values, Options options)
      : law_(std::move(law)), values_(std::move(values)), options_(std::move(options)) {}

  AnyLaw<double> law_;
  std::vector<double> values_;
  Options options_;
};

}  // namespace kerf::models
