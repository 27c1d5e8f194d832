#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <kerf/models/blade.h>
#include <kerf/models/exponential.h>
#include <kerf/models/fracture.h>
#include <kerf/models/fuzzy_kelvin.h>
#include <kerf/models/fuzzy_kelvin_3d.h>
#include <kerf/models/fuzzy_rupture.h>
#include <kerf/models/kelvin.h>
#include <kerf/models/motion.h>
#include <kerf/models/orthogonal.h>
#include <kerf/models/parameter.h>
#include <kerf/models/piecewise.h>
#include <kerf/models/precontact.h>
#include <kerf/models/recording.h>
#include <kerf/models/scissors_analytic.h>
#include <kerf/models/scissors_free.h>
#include <kerf/models/scissors_mesh.h>
#include <kerf/models/spatial.h>

namespace kerf::models {

/// The registry: every law, once. A new law is one header, one entry here and one test.
///
/// A scalar law is templated, so that the law that is fitted is the one that is rendered, and its step takes
/// a Motion along one axis. A spatial law names its axes and its step takes a SpatialMotion.
using AnyLaw =
    std::variant<Kelvin<double>, Exponential<double>, Piecewise<double>, Recording<double>,
                 ScissorsAnalytic<double>, Precontact<double>, Fracture<double>, FuzzyRupture<double>,
                 FuzzyKelvin<double>, FuzzyKelvin3d, Blade, ScissorsFree, ScissorsMesh, Orthogonal>;

/// What the registry knows of a law without building one.
struct LawInfo {
  std::string_view name;
  std::string_view equation;
  std::string_view position_unit;  ///< the only one that its equation makes sense in; empty: "m" or "rad"
  std::string_view force_unit;     ///< likewise
};
[[nodiscard]] std::vector<LawInfo> registry();
/// @throws std::invalid_argument for an unknown law.
[[nodiscard]] LawInfo law_info(std::string_view model);

/// The answer of a scalar law in one tick.
struct Response {
  double force = 0.0;  ///< what the tissue exerts on the tool [N], positive when it resists
  bool fault = false;  ///< an input or the result was not finite; the force is then zero
};

/// The answer of a spatial law in one tick: on each axis what the tissue exerts on the tool, positive where
/// it pushes the position up.
struct SpatialResponse {
  AxisValues force{};
  bool fault = false;  ///< an input or the result was not finite; every force is then zero
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
  /// A copy of a state is a state of its own. A law with a mesh takes its memory in initial_state().
  using State = StatesOf<AnyLaw>::type;

  /// Builds a law by name; `values` in the order of `parameters(model, options)`.
  /// @throws std::invalid_argument with a sentence that names what is wrong: an unknown law or option, a
  ///         wrong number of values, a value that is not finite or outside its range.
  static Law make(std::string_view model, std::span<const double> values, const Options& options = {});

  /// The parameters of a law with these options, in order. @throws std::invalid_argument as make() does.
  static std::vector<ParameterInfo> parameters(std::string_view model, const Options& options = {});
  /// The options of a law. @throws std::invalid_argument for an unknown law.
  static std::vector<OptionInfo> options(std::string_view model);
  /// The axes of a spatial law; none for a scalar law, which goes on any axis.
  /// @throws std::invalid_argument for an unknown law.
  static std::vector<LawAxis> axes(std::string_view model);

  [[nodiscard]] std::string_view model() const noexcept;
  [[nodiscard]] const std::vector<double>& values() const noexcept { return values_; }
  [[nodiscard]] const Options& options() const noexcept { return options_; }
  [[nodiscard]] std::vector<ParameterInfo> parameters() const { return parameters(model(), options_); }
  [[nodiscard]] std::vector<LawAxis> axes() const { return axes(model()); }
  [[nodiscard]] bool is_spatial() const { return !axes().empty(); }
  [[nodiscard]] const AnyLaw& any() const noexcept { return law_; }

  /// A state before the first tick.
  [[nodiscard]] State initial_state() const;

  /// One tick of a scalar law; of a spatial law, a fault. Never throws, allocates or returns a number that is
  /// not finite.
  [[nodiscard]] Response step(State& state, const Motion& motion, double period_s) const noexcept;
  /// One tick of a spatial law; of a scalar law, a fault.
  [[nodiscard]] SpatialResponse step(State& state, const SpatialMotion& motion,
                                     double period_s) const noexcept;

 private:
  Law(AnyLaw law, std::vector<double> values, Options options)
      : law_(std::move(law)), values_(std::move(values)), options_(std::move(options)) {}

  AnyLaw law_;
  std::vector<double> values_;
  Options options_;
};

}  // namespace kerf::models
