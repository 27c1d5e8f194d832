#pragma once

#include <array>
#include <cstddef>
#include <new>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <kerf/law.h>
#include <kerf/models/dual.h>
#include <kerf/models/motion.h>
#include <kerf/models/parameter.h>

/// A law as a C++ header in the shape of Kerf's own, kerf/models/kelvin.h, made a plug-in: `kerf law new`
/// writes one, `kerf law build` compiles it, docs/own-law.md walks through it.
///
/// The last line of such a header is KERF_LAW(Name), Name a struct templated on its scalar with
///
///     name, equation                              texts
///     parameters(const Options&)                  std::vector<ParameterInfo>, as in Kerf's own laws
///     initial()                                   a value for each: where a fit begins
///     linear                                      optional: names of those that the force is linear in
///     tells                                       optional: KERF_TELLS_... (kerf/law.h)
///     State                                       trivially copyable
///     make(std::span<const T>, const Options&)    the law with these values; there are no options
///     step(State&, const Motion&, double) const   the force after so many seconds
///     stored_energy(const State&) const           optional
///
/// Values that make no law are refused by make(), with an exception.
namespace kerf::plugin {

/// The unit of a quantity along a depth in m, as kerf::models::unit_of() has it.
[[nodiscard]] constexpr const char* unit_text(models::Quantity quantity) {
  constexpr std::array units{"N",   "m",     "m/s",       "N/m",    "N·s/m",  "1",    "m",
                             "kg",  "s",     "1/s",       "N·m",    "J",      "J/m²", "N",
                             "N/m", "N·s/m", "N·m·s/rad", "N·s/m²", "N·s/m³", "N/m²", "N/m³"};
  return units.at(static_cast<std::size_t>(quantity));
}

/// The description of a law, and its functions.
template <template <typename> typename Law>
class Described {
  using Value = Law<double>;
  static constexpr int width = 8;  // of derivatives in one pass; more parameters take several
  using Dual = models::Dual<width>;
  using State = typename Value::State;
  using DualState = typename Law<Dual>::State;
  static_assert(std::is_trivially_copyable_v<State>,
                "a State is copied byte by byte: no pointers, no vectors");

 public:
  static const kerf_law_v1* law() {
    static const Described described;
    return &described.law_;
  }

 private:
  Described() : infos_(Value::parameters({})), initial_(Value::initial()) {
    for (std::size_t i = 0; i < infos_.size(); ++i) parameters_.push_back(described(i));
    count = infos_.size();
    law_ = {.abi = KERF_LAW_ABI,
            .size = sizeof(kerf_law_v1),
            .name = name_.c_str(),
            .equation = equation_.c_str(),
            .position_unit = nullptr,
            .force_unit = nullptr,
            .parameters = parameters_.data(),
            .axes = nullptr,
            .parameter_count = static_cast<std::uint32_t>(count),
            .axis_count = 0,
            .tells = tells(),
            .reserved = 0,
            .state_size = sizeof(State),
            .state_alignment = alignof(State),
            .init = init,
            .step = step,
            .stored_energy = energy(),
            .derivatives_state_size = passes() * sizeof(DualState),
            .derivatives_state_alignment = alignof(DualState),
            .init_derivatives = init_derivatives,
            .step_derivatives = step_derivatives};
  }

  kerf_law_parameter_v1 described(std::size_t i) const {
    const models::ParameterInfo& info = infos_[i];
    std::uint32_t flags = KERF_SEARCHED;
    if (info.scale == models::Scale::logarithmic) flags |= KERF_LOGARITHMIC;
    if constexpr (requires { Value::linear; }) {
      for (const std::string_view one : Value::linear) flags |= one == info.name ? KERF_LINEAR : 0U;
    }
    return {info.name.c_str(),
            unit_text(info.quantity),
            info.meaning.c_str(),
            info.lower,
            info.upper,
            i < initial_.size() ? initial_[i] : info.lower,
            flags};
  }
  static std::uint32_t tells() {
    if constexpr (requires { Value::tells; }) return Value::tells;
    return 0;
  }
  static auto energy() -> double (*)(const double*, const void*) {
    if constexpr (requires(const Value& law, const State& state) { law.stored_energy(state); }) {
      return [](const double* values, const void* state) -> double {
        return made(values).stored_energy(*static_cast<const State*>(state));
      };
    }
    return nullptr;
  }
  static std::size_t passes() { return (count + width - 1) / width; }
  static Value made(const double* values) { return Value::make({values, count}, {}); }
  /// Room for the most parameters; to clear all of it at each step would take longer than most steps.
  union Duals {
    Duals() {}
    Dual all[32];
  };
  /// With derivatives by the parameters of one pass.
  static Law<Dual> made(const double* values, std::size_t pass) {
    Duals room;
    Dual* const first = room.all;
    for (std::size_t i = 0; i < count; ++i) {
      Dual* const one = new (first + i) Dual(values[i]);
      if (i / width == pass) one->v[i % width] = 1.0;
    }
    return Law<Dual>::make({first, count}, {});
  }

  static int init(const double* values, void* memory) {
    try {
      (void)made(values);
    } catch (...) {
      return 1;
    }
    new (memory) State{};
    return 0;
  }
  static void step(const double* values, void* memory, const double* position, const double* velocity,
                   double period_s, double* force) {
    *force = made(values).step(*static_cast<State*>(memory), {*position, *velocity}, period_s);
  }
  static int init_derivatives(const double* values, void* memory) {
    for (std::size_t pass = 0; pass < passes(); ++pass)
      new (static_cast<DualState*>(memory) + pass) DualState{};
    State unused{};
    return init(values, &unused);
  }
  static void step_derivatives(const double* values, void* memory, const double* position,
                               const double* velocity, double period_s, double* force, double* derivatives) {
    for (std::size_t pass = 0; pass < passes(); ++pass) {
      const Dual result =
          made(values, pass).step(static_cast<DualState*>(memory)[pass], {*position, *velocity}, period_s);
      *force = result.a;
      for (std::size_t i = pass * width; i < count && i < (pass + 1) * width; ++i)
        derivatives[i] = result.v[i % width];
    }
  }

  static inline std::size_t count = 0;  ///< of parameters
  const std::string name_{Value::name};
  const std::string equation_{Value::equation};
  const std::vector<models::ParameterInfo> infos_;
  const std::vector<double> initial_;
  std::vector<kerf_law_parameter_v1> parameters_;
  kerf_law_v1 law_{};
};

}  // namespace kerf::plugin

/// Ends the header of a law. Of its own it is nothing, so that tests can include it; `kerf law build` and the
/// CMake file of `kerf law new` define KERF_BUILD_LAW.
#ifdef KERF_BUILD_LAW
#define KERF_LAW(Law)                                               \
  extern "C" KERF_LAW_EXPORT const kerf_law_v1* kerf_plugin_law() { \
    return kerf::plugin::Described<Law>::law();                     \
  }
#else
#define KERF_LAW(Law) static_assert(sizeof(Law<double>) > 0)
#endif
