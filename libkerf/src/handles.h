#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <kerf/drivers/velocity_filter.h>
#include <kerf/kerf.h>
#include <kerf/models/law.h>

#include "laws/law_file.h"
#include "loop/safety.h"

namespace kerf {

/// A law with all that can be asked of it, as C has it: texts that end in a zero and live as long as it does.
struct OpenedLaw {
  OpenedLaw(bench::LawFile read, std::string from);

  bench::LawFile file;
  models::Law::State initial;
  std::vector<models::LawAxis> axes;
  std::vector<models::ParameterInfo> parameters;
  std::vector<models::OptionInfo> options;
  std::vector<std::string> units;  ///< one a parameter
  std::string model;
  std::string equation;
  std::string text;
  std::string sha256;
  bool spatial;
};

/// Seconds between the steps of a host that has no time of its own.
class StepClock {
 public:
  /// Since the call before; the first one, and one after restart(), is a tick at 1 kHz.
  [[nodiscard]] double elapsed_s() noexcept;
  void restart() noexcept { last_ns_ = 0; }

 private:
  std::int64_t last_ns_ = 0;
};

/// Puts a message into a caller's room, cut between two characters of UTF-8.
void say(std::string_view message, char* error, std::size_t size) noexcept;

/// Does what may throw at set-up, and turns what it throws into a status and one line.
template <typename Action>
kerf_status at_set_up(char* error, std::size_t size, Action&& action) noexcept {
  say("", error, size);
  try {
    std::forward<Action>(action)();
    return KERF_OK;
  } catch (const std::invalid_argument& refused) {
    say(refused.what(), error, size);
    return KERF_BAD_INPUT;
  } catch (const std::bad_alloc&) {
    say("no memory left", error, size);
  } catch (const std::exception& failed) {
    say(failed.what(), error, size);
  } catch (...) {
    say("failed for an unknown reason", error, size);
  }
  return KERF_SYSTEM;
}

/// What kerf_step_axes() does for a state's law.
using StepAxes = std::uint32_t (*)(kerf_state* state, const double* position, const double* velocity,
                                   double elapsed_s, double* force) noexcept;
[[nodiscard]] StepAxes step_axes_of(const OpenedLaw& law) noexcept;

}  // namespace kerf

// The handles of the header: of C, and so of no namespace.

struct kerf_law {
  std::shared_ptr<const kerf::OpenedLaw> opened;
};

struct kerf_state {
  explicit kerf_state(std::shared_ptr<const kerf::OpenedLaw> of)
      : opened(std::move(of)),
        axes(opened->axes.size()),
        step_axes(kerf::step_axes_of(*opened)),
        memory(opened->initial) {}

  /// Goes on by the time of a step.
  void pass(double elapsed_s) noexcept {
    if (elapsed_s > 0.0 && elapsed_s <= std::numeric_limits<double>::max()) [[likely]]
      now_s += elapsed_s;
  }

  std::shared_ptr<const kerf::OpenedLaw> opened;
  std::size_t axes;  ///< how many
  kerf::StepAxes step_axes;
  kerf::models::Law::State memory;
  kerf::drivers::VelocityFilter filter{};
  alignas(64) kerf::models::SpatialMotion
      motion{};        ///< of the last step by axes; those that the law has not stay zero
  double now_s = 0.0;  ///< the sum of the elapsed times
  kerf::StepClock clock{};
};

namespace kerf {

/// The motion of a state's axes, with the velocities that the host lacks. `velocity` may be null. It is kept
/// in the state: to clear one anew takes longer than to step some laws.
const models::SpatialMotion& motion_of(kerf_state& state, const double* position,
                                       const double* velocity) noexcept;

/// One tick along the state's axes; the time has been taken by elapse().
[[nodiscard]] std::uint32_t step_axes(kerf_state& state, const models::SpatialMotion& motion,
                                      double elapsed_s, double* force) noexcept;

}  // namespace kerf
