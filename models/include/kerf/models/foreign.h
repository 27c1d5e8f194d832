#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <kerf/law.h>
#include <kerf/models/law.h>

namespace kerf::models {

/// Where a law of a plug-in comes from.
struct PluginFile {
  std::string path;    ///< as it was given
  std::string name;    ///< of the file
  std::string sha256;  ///< of its content
};

/// What a state is stepped for.
enum class SteppedFor : std::uint8_t { forces, derivatives };

class ForeignLaw;

/// A state of a plug-in's law: its bytes, and a canary behind them.
class ForeignState {
 public:
  /// @throws std::invalid_argument where the plug-in says that these values make no law.
  ForeignState(const ForeignLaw& law, SteppedFor kind, std::span<const double> values);
  ForeignState(const ForeignState& other);
  ForeignState(ForeignState&&) noexcept = default;
  ForeignState& operator=(const ForeignState&) = delete;
  ForeignState& operator=(ForeignState&&) noexcept = default;
  ~ForeignState() = default;

  /// Takes over the bytes of a state of the same law and kind; takes no memory.
  void assign(const ForeignState& other) noexcept;
  [[nodiscard]] void* bytes() noexcept { return memory_.get(); }
  [[nodiscard]] const void* bytes() const noexcept { return memory_.get(); }
  /// Whether nobody wrote behind its bytes.
  [[nodiscard]] bool is_intact() const noexcept;

 private:
  struct Release {
    std::size_t alignment;
    void operator()(std::byte* memory) const noexcept {
      ::operator delete(memory, std::align_val_t(alignment));
    }
  };
  using Memory = std::unique_ptr<std::byte, Release>;
  static Memory memory_of(std::size_t size, std::size_t alignment);

  std::size_t size_;  ///< without the canary
  Memory memory_;
};

/// The law of a plug-in: what its kerf_law_v1 says, checked and copied, and its steps, guarded. A step that
/// throws or has written behind its state gives no number, which Law::step() turns into zero force and a
/// fault.
class ForeignLaw {
 public:
  static constexpr std::size_t max_parameters = 32;

  /// @throws std::invalid_argument in one line that says what of the description is wrong: the version, a
  ///         size, a name (also one of the house's laws), a unit, bounds.
  ForeignLaw(const kerf_law_v1& law, PluginFile from);
  ForeignLaw(const ForeignLaw&) = delete;
  ForeignLaw& operator=(const ForeignLaw&) = delete;

  [[nodiscard]] LawInfo info() const;
  [[nodiscard]] const LawFacts& facts() const noexcept { return facts_; }
  [[nodiscard]] const std::vector<ParameterInfo>& parameters() const noexcept { return parameters_; }
  [[nodiscard]] const std::vector<double>& initial() const noexcept { return initial_; }
  [[nodiscard]] bool is_searched(std::size_t parameter) const {
    return (flags_[parameter] & KERF_SEARCHED) != 0;
  }
  [[nodiscard]] bool is_linear(std::size_t parameter) const { return (flags_[parameter] & KERF_LINEAR) != 0; }
  [[nodiscard]] const std::vector<LawAxis>& axes() const noexcept { return axes_; }
  [[nodiscard]] const PluginFile& plugin() const noexcept { return plugin_; }
  [[nodiscard]] bool has_derivatives() const noexcept { return law_.step_derivatives != nullptr; }
  [[nodiscard]] const kerf_law_v1& description() const noexcept { return law_; }

  /// Forces along its axes, not a number where it breaks.
  void step(const double* values, ForeignState& state, const double* position, const double* velocity,
            double period_s, double* force) const noexcept;
  /// Force of a law along one axis, and its derivatives by all parameters.
  [[nodiscard]] double step_with_derivatives(const double* values, ForeignState& state, const Motion& motion,
                                             double period_s, double* derivatives) const noexcept;
  /// Not a number where the law does not say.
  [[nodiscard]] double stored_energy(const double* values, const ForeignState& state) const noexcept;

 private:
  void read_parameters(const kerf_law_v1& law);
  void read_axes(const kerf_law_v1& law);

  kerf_law_v1 law_;
  PluginFile plugin_;
  std::string name_, equation_, position_unit_, force_unit_;
  std::vector<ParameterInfo> parameters_;
  std::vector<double> initial_;
  std::vector<std::uint32_t> flags_;
  std::vector<LawAxis> axes_;
  LawFacts facts_;
};

/// Puts a law beside those of the registry for the rest of the program's life: law_info(), Law::make() and
/// whatever goes through registry() know it from now on. To be called at set-up. A law that is there already,
/// from the same content, is that law.
/// @throws std::invalid_argument as ForeignLaw does, and where another plug-in has a law of this name.
const ForeignLaw& register_law(const kerf_law_v1& law, const PluginFile& from);

/// A law of a plug-in by its name; nothing for a law of the house, or one that nobody registered.
[[nodiscard]] const ForeignLaw* foreign_law(std::string_view model) noexcept;
/// All of them, in the order in which they were registered.
[[nodiscard]] std::vector<const ForeignLaw*> foreign_laws();

/// The law whose code this thread runs: who is to blame for a crash. Nothing outside a step of a plug-in. May
/// be called by a signal handler.
[[nodiscard]] const ForeignLaw* running_foreign_law() noexcept;

}  // namespace kerf::models
