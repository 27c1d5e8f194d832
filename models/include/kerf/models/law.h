#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include <kerf/models/law_facts.h>
#include <kerf/models/motion.h>
#include <kerf/models/parameter.h>
#include <kerf/models/spatial.h>

namespace kerf::models {

// One of the laws, and one's state; registry.h has the list.
struct AnyLaw;
struct AnyState;

/// What the registry knows of a law without building one.
struct LawInfo {
  std::string_view name;
  std::string_view equation;
  std::string_view position_unit;  ///< the only one that its equation makes sense in; empty: "m" or "rad"
  std::string_view force_unit;     ///< likewise
};
[[nodiscard]] std::vector<LawInfo> registry();
/// Where a law stands in registry(): of laws that serve alike the first there is taken, whichever was asked
/// for first. An unknown law stands behind all.
[[nodiscard]] std::size_t place_in_registry(std::string_view model);
/// @throws std::invalid_argument for an unknown law.
[[nodiscard]] LawInfo law_info(std::string_view model);
[[nodiscard]] const LawFacts& law_facts(std::string_view model);

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

/// A force law ready to be rendered: a value with its parameters, to be stepped with a State of its own. A
/// law does not change, so that copies share its tables.
class Law {
 public:
  /// What a law remembers from tick to tick: a value, a copy of a state is a state of its own. Its memory is
  /// taken by initial_state() and by copying; assigning a state of the same law takes none anew.
  class State {
   public:
    State(const State& other);
    State(State&& other) noexcept;
    State& operator=(const State& other);
    State& operator=(State&& other) noexcept;
    ~State();

   private:
    friend class Law;
    explicit State(std::unique_ptr<AnyState> state) noexcept;
    std::unique_ptr<AnyState> state_;
  };

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

  /// A state before the first tick.
  [[nodiscard]] State initial_state() const;

  /// One tick of a scalar law; of a spatial law, a fault. Never throws, allocates or returns a number that is
  /// not finite.
  ///
  /// `period_s` is the time since the state's last tick [s], whatever it was: a period of the loop, several
  /// after a late one, a minute after a stall. The tool went there in a straight line. The rule for all laws:
  /// the force stays bounded by what the motion asks for, and the work of a tick does not grow with its
  /// length. A law that remembers no time sees where the tool is and how it moves now; one whose memory has a
  /// closed form (kelvin, maxwell, springpot and what is made of them) takes the whole time at once; one
  /// that has to be integrated in sub-steps (scissors_mesh) advances by two nominal ticks at most, is held
  /// for the rest, and trails a tool that went far no slower than a hand moves.
  [[nodiscard]] Response step(State& state, const Motion& motion, double period_s) const noexcept;
  /// Ticks of a scalar law one after the other, each as step() takes it but in less time; not a number where
  /// it faults, in a spatial law everywhere. `period_s`: one for all ticks, or one each; `force`: one each.
  void steps(State& state, std::span<const Motion> motion, std::span<const double> period_s,
             std::span<double> force) const noexcept;
  /// One tick of a spatial law; of a scalar law, a fault.
  [[nodiscard]] SpatialResponse step(State& state, const SpatialMotion& motion,
                                     double period_s) const noexcept;

  /// Energy that the springs of a state hold as of its last step, [J] for a position in m, [N·rad] for rad
  /// (work per unit of lever): what the law can give back at most, the part of past work that is not
  /// dissipated. What a contact that never pulls cannot give back is not stored. Of a passive law it never
  /// grows by more than the work done on it; the docstring of a law says where it is not passive. Not a
  /// number where the law does not say, or for the state of another law. Never throws or allocates.
  [[nodiscard]] double stored_energy(const State& state) const noexcept;

  /// The force of a scalar law along a motion, tick by tick from a fresh state: one period for each tick.
  [[nodiscard]] std::vector<double> along(std::span<const Motion> motion,
                                          std::span<const double> period_s) const;

 private:
  Law(std::shared_ptr<const AnyLaw> law, std::vector<double> values, Options options);

  std::shared_ptr<const AnyLaw> law_;
  std::vector<double> values_;
  Options options_;
};

}  // namespace kerf::models
