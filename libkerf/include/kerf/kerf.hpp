#pragma once

// libkerf for C++20: kerf.h with owners and spans. Exceptions at set-up alone; a step never throws.

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include <kerf/kerf.h>

namespace kerf {

/// What was wrong at set-up, in one line.
class Error : public std::runtime_error {
 public:
  Error(kerf_status status, const std::string& text) : std::runtime_error(text), status_(status) {}
  /// KERF_BAD_INPUT or KERF_SYSTEM.
  [[nodiscard]] kerf_status status() const noexcept { return status_; }

 private:
  kerf_status status_;
};

namespace detail {

/// Calls `make(&handle, text, room)`. @throws Error.
template <typename Handle, typename Make>
Handle* made(Make&& make) {
  Handle* handle = nullptr;
  std::string text(2048, '\0');
  const kerf_status status = make(&handle, text.data(), text.size());
  if (status != KERF_OK) throw Error(status, text.c_str());
  return handle;
}

template <auto destroy>
struct Destroy {
  template <typename Handle>
  void operator()(Handle* handle) const noexcept {
    destroy(handle);
  }
};

}  // namespace detail

/// A force and what happened on the way: bits of kerf.h, 0 if nothing did.
struct Force {
  double force = 0.0;
  std::uint32_t flags = 0;
};

/// Loads a plug-in as kerf_plugin_load() says, and gives the name of its law. @throws Error.
inline std::string_view load_plugin(const std::string& path) {
  return detail::made<const char>([&](const char** model, char* error, std::size_t size) {
    return kerf_plugin_load(path.c_str(), model, error, size);
  });
}

/// A law: immutable, shared by any number of threads and states. Moved, not copied.
class Law {
 public:
  /// @throws Error as kerf_law_open() says.
  [[nodiscard]] static Law open(const std::string& path) {
    return Law(detail::made<kerf_law>([&](kerf_law** law, char* error, std::size_t size) {
      return kerf_law_open(path.c_str(), law, error, size);
    }));
  }
  /// @throws Error as kerf_law_parse() says.
  [[nodiscard]] static Law parse(std::string_view text, const std::string& name) {
    return Law(detail::made<kerf_law>([&](kerf_law** law, char* error, std::size_t size) {
      return kerf_law_parse(text.data(), text.size(), name.c_str(), law, error, size);
    }));
  }
  /// @throws Error as kerf_law_make() says.
  [[nodiscard]] static Law make(const std::string& model, std::span<const kerf_value> values,
                                std::span<const kerf_option> options = {}) {
    return Law(detail::made<kerf_law>([&](kerf_law** law, char* error, std::size_t size) {
      return kerf_law_make(model.c_str(), values.data(), values.size(), options.data(), options.size(), law,
                           error, size);
    }));
  }

  [[nodiscard]] std::string_view model() const noexcept { return kerf_law_model(get()); }
  [[nodiscard]] std::string_view equation() const noexcept { return kerf_law_equation(get()); }
  [[nodiscard]] std::string_view text() const noexcept { return kerf_law_text(get()); }
  [[nodiscard]] std::string_view sha256() const noexcept { return kerf_law_sha256(get()); }
  [[nodiscard]] bool is_spatial() const noexcept { return kerf_law_is_spatial(get()) != 0; }
  [[nodiscard]] kerf_contact contact() const noexcept { return kerf_law_contact(get()); }
  [[nodiscard]] std::size_t axis_count() const noexcept { return kerf_law_axis_count(get()); }
  /// @throws Error beyond the last.
  [[nodiscard]] kerf_axis axis(std::size_t index) const {
    kerf_axis axis{};
    if (const kerf_status status = kerf_law_axis(get(), index, &axis)) throw Error(status, "no such axis");
    return axis;
  }
  [[nodiscard]] std::size_t parameter_count() const noexcept { return kerf_law_parameter_count(get()); }
  /// @throws Error beyond the last.
  [[nodiscard]] kerf_parameter parameter(std::size_t index) const {
    kerf_parameter parameter{};
    if (const kerf_status status = kerf_law_parameter(get(), index, &parameter))
      throw Error(status, "no such parameter");
    return parameter;
  }
  [[nodiscard]] std::size_t option_count() const noexcept { return kerf_law_option_count(get()); }
  /// @throws Error beyond the last.
  [[nodiscard]] kerf_option_info option(std::size_t index) const {
    kerf_option_info option{};
    if (const kerf_status status = kerf_law_option(get(), index, &option))
      throw Error(status, "no such option");
    return option;
  }
  /// For functions of kerf.h.
  [[nodiscard]] const kerf_law* get() const noexcept { return law_.get(); }

 private:
  explicit Law(kerf_law* law) noexcept : law_(law) {}
  std::unique_ptr<kerf_law, detail::Destroy<&kerf_law_close>> law_;
};

/// What one tool has lived through with a law. Of one thread at a time. A copy is a state of its own.
class State {
 public:
  /// @throws Error as kerf_state_create() says.
  explicit State(const Law& law)
      : state_(detail::made<kerf_state>([&](kerf_state** state, char* error, std::size_t size) {
          return kerf_state_create(law.get(), state, error, size);
        })) {}
  /// @throws Error as kerf_state_copy() says.
  State(const State& other)
      : state_(detail::made<kerf_state>([&](kerf_state** copy, char* error, std::size_t size) {
          return kerf_state_copy(other.get(), copy, error, size);
        })) {}
  State& operator=(const State& other) = delete;  // assign() takes no memory and says whether it could
  State(State&&) noexcept = default;
  State& operator=(State&&) noexcept = default;
  ~State() = default;

  /// Saves and restores; false if `other` is of another law. For the loop.
  [[nodiscard]] bool assign(const State& other) noexcept {
    return kerf_state_assign(get(), other.get()) == KERF_OK;
  }
  void reset() noexcept { kerf_state_reset(get()); }
  [[nodiscard]] double energy() const noexcept { return kerf_state_energy(state_.get()); }

  /// One tick, as kerf_step() says; NaN stands for a velocity or a time that the host does not have.
  [[nodiscard]] Force step(double position, double velocity, double elapsed_s) noexcept {
    Force result;
    result.flags = kerf_step(get(), position, velocity, elapsed_s, &result.force);
    return result;
  }
  [[nodiscard]] Force step_depth(double penetration, double velocity, double elapsed_s) noexcept {
    Force result;
    result.flags = kerf_step_depth(get(), penetration, velocity, elapsed_s, &result.force);
    return result;
  }
  /// One number an axis of the law; `velocity` may be empty: none.
  [[nodiscard]] std::uint32_t step(std::span<const double> position, std::span<const double> velocity,
                                   double elapsed_s, std::span<double> force) noexcept {
    assert(velocity.empty() || velocity.size() == position.size());
    return kerf_step_axes(get(), position.data(), velocity.empty() ? nullptr : velocity.data(), elapsed_s,
                          force.data());
  }
  [[nodiscard]] kerf_state* get() noexcept { return state_.get(); }
  [[nodiscard]] const kerf_state* get() const noexcept { return state_.get(); }

 private:
  std::unique_ptr<kerf_state, detail::Destroy<&kerf_state_destroy>> state_;
};

/// What stands between laws and a hand; as kerf_safety_create() and what follows it say.
class Safety {
 public:
  /// `limits`: one an axis of the law. @throws Error.
  Safety(const Law& law, std::span<const kerf_limits> limits, const kerf_safety_options* options = nullptr) {
    if (limits.size() != law.axis_count())
      throw Error(KERF_BAD_INPUT, "safety: " + std::to_string(limits.size()) + " limits for a law of " +
                                      std::to_string(law.axis_count()) + " axes");
    safety_.reset(detail::made<kerf_safety>([&](kerf_safety** safety, char* error, std::size_t size) {
      return kerf_safety_create(law.get(), limits.data(), options, safety, error, size);
    }));
  }

  /// State::step() within the limits.
  [[nodiscard]] std::uint32_t step(State& state, std::span<const double> position,
                                   std::span<const double> velocity, double elapsed_s,
                                   std::span<double> force) noexcept {
    assert(velocity.empty() || velocity.size() == position.size());
    return kerf_step_safely(get(), state.get(), position.data(), velocity.empty() ? nullptr : velocity.data(),
                            elapsed_s, force.data());
  }
  void confirm() noexcept { kerf_safety_confirm(get()); }
  void reset() noexcept { kerf_safety_reset(get()); }
  /// For kerf_safety_judge() and kerf_safety_apply().
  [[nodiscard]] kerf_safety* get() noexcept { return safety_.get(); }

 private:
  std::unique_ptr<kerf_safety, detail::Destroy<&kerf_safety_destroy>> safety_;
};

}  // namespace kerf
