#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <kerf/drivers/velocity_filter.h>
#include <kerf/models/law.h>

#include "held_law.h"
#include "laws/plugin_laws.h"
#include "laws/sampled_motion.h"
#include "module.h"

namespace kerf::python {
namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

/// What one tool has lived through with a law. One thread at a time: the others are refused.
struct HeldState {
  explicit HeldState(SharedLaw of) : law(std::move(of)), memory(law->file.law.initial_state()) {}
  HeldState(const HeldState& other)
      : law(other.law), memory(other.memory), filter(other.filter), now_s(other.now_s) {}

  SharedLaw law;
  models::Law::State memory;
  drivers::VelocityFilter filter{};
  double now_s = 0.0;
  std::atomic_flag taken;
};

/// Takes a state for as long as it lives.
class Taken {
 public:
  explicit Taken(HeldState& state) : state_(state) {
    if (state_.taken.test_and_set())
      throw std::invalid_argument(
          "the state is stepped by another thread; give each thread a state of its own");
  }
  Taken(const Taken&) = delete;
  Taken& operator=(const Taken&) = delete;
  ~Taken() { state_.taken.clear(); }

 private:
  HeldState& state_;
};

enum class OnFault : std::uint8_t { nan, zero, error };

OnFault on_fault_of(const std::string& word) {
  if (word == "nan") return OnFault::nan;
  if (word == "zero") return OnFault::zero;
  if (word == "raise") return OnFault::error;
  throw std::invalid_argument("on_fault: '" + word + "' is none of nan, zero, raise");
}

/// A trajectory as it lies in arrays: axes numbers a row.
struct Trajectory {
  std::size_t rows = 0;
  std::size_t axes = 1;
  const double* position = nullptr;
  const double* velocity = nullptr;  ///< none: derived
  const double* elapsed_s = nullptr;
  bool one_period = false;  ///< elapsed_s is one number for all rows

  [[nodiscard]] double period_s(std::size_t row) const noexcept { return elapsed_s[one_period ? 0 : row]; }
  [[nodiscard]] std::span<const double> periods(std::size_t first, std::size_t count) const noexcept {
    return one_period ? std::span(elapsed_s, 1) : std::span(elapsed_s + first, count);
  }
};

/// As kerf_step() of libkerf derives velocities that its host lacks.
void derive(HeldState& state, const double* position, std::size_t axes, double* velocity) noexcept {
  const bool finite = std::all_of(position, position + axes, [](double one) { return std::isfinite(one); });
  for (std::size_t axis = 0; axis < axes; ++axis)
    velocity[axis] = finite ? state.filter.update(axis, position[axis], state.now_s) : 0.0;
  if (finite) state.filter.advance(state.now_s);
}

bool any_is_nan(std::span<const double> values) noexcept {
  bool any = false;
  for (const double one : values) any |= std::isnan(one);
  return any;
}

/// Rows of a law along one axis; not a number where the law faults. @returns whether it does.
bool step_line(HeldState& state, const Trajectory& along, bool resisting, double* force) noexcept {
  constexpr std::size_t most = 512;  // as many as stay in the first cache
  std::array<models::Motion, most> motion;
  const bench::LawFile& file = state.law->file;
  const models::Contact contact = file.contact;
  bool any_fault = false;
  for (std::size_t first = 0; first < along.rows; first += most) {
    const std::size_t count = std::min(most, along.rows - first);
    const double* const position = along.position + first;
    const std::span<const double> periods = along.periods(first, count);
    if (along.velocity != nullptr) {
      for (std::size_t i = 0; i < count; ++i)
        motion[i] = contact.motion(position[i], along.velocity[first + i]);
      state.now_s += along.one_period ? static_cast<double>(count) * periods[0]
                                      : std::accumulate(periods.begin(), periods.end(), 0.0);
    } else {
      for (std::size_t i = 0; i < count; ++i) {
        double velocity = 0.0;
        state.now_s += along.period_s(first + i);
        derive(state, position + i, 1, &velocity);
        motion[i] = contact.motion(position[i], velocity);
      }
    }
    const std::span<double> block(force + first, count);
    file.law.steps(state.memory, std::span(motion).first(count), periods, block);
    any_fault |= any_is_nan(block);
    if (resisting) continue;
    for (double& one : block) one = contact.force_on_axis(one);
  }
  return any_fault;
}

/// Rows of a law in space; not a number where the law faults. @returns whether it does.
bool step_space(HeldState& state, const Trajectory& along, double* force) noexcept {
  bool any_fault = false;
  for (std::size_t row = 0; row < along.rows; ++row) {
    const double period_s = along.period_s(row);
    state.now_s += period_s;
    const std::size_t at = row * along.axes;
    models::SpatialMotion motion;
    std::copy_n(along.position + at, along.axes, motion.position.begin());
    if (along.velocity == nullptr)
      derive(state, along.position + at, along.axes, motion.velocity.data());
    else
      std::copy_n(along.velocity + at, along.axes, motion.velocity.begin());
    const models::SpatialResponse response = state.law->file.law.step(state.memory, motion, period_s);
    any_fault |= response.fault;
    if (response.fault)
      std::fill_n(force + at, along.axes, no_number);
    else
      std::copy_n(response.force.begin(), along.axes, force + at);
  }
  return any_fault;
}

/// Does with rows in which the law faulted what was asked for. @returns the first of them.
std::optional<std::size_t> find_faults(const Trajectory& along, OnFault on_fault, double zero,
                                       std::span<double> force) noexcept {
  std::optional<std::size_t> first;
  for (std::size_t at = 0; at < force.size(); ++at) {
    if (!std::isnan(force[at])) continue;
    if (!first) first = at / along.axes;
    if (on_fault != OnFault::zero) break;
    force[at] = zero;
  }
  return first;
}

void require_periods(const Trajectory& along, const char* name) {
  for (std::size_t row = 0; row < (along.one_period ? 1 : along.rows); ++row) {
    const double period_s = along.period_s(row);
    if (!(period_s > 0.0 && std::isfinite(period_s)))
      throw std::invalid_argument(fmt::format(
          "{}: the time that passes before row {} is {} s; expected more than 0", name, row, period_s));
  }
}

/// Arrays of a trajectory, and what is to be known of them.
class Arrays {
 public:
  Arrays(const HeldLaw& law, const py::object& position, const py::object& velocity)
      : position_(numbers_of(position, "position")) {
    const std::size_t axes = law.axes.size();
    const bool flat = !law.spatial && position_.ndim() == 1;
    if (!flat && !(position_.ndim() == 2 && position_.shape(1) == static_cast<py::ssize_t>(axes)))
      throw std::invalid_argument(fmt::format(
          "position: its shape is {}; expected {}, a column for each of {}", shape_of(position_),
          law.spatial ? fmt::format("(N, {})", axes) : "(N,) or (N, 1)", bench::names_in(law.axes)));
    along_.rows = static_cast<std::size_t>(position_.shape(0));
    along_.axes = axes;
    along_.position = position_.data();
    if (velocity.is_none()) return;
    velocity_ = numbers_of(velocity, "velocity");
    require_shape(velocity_, position_, "velocity");
    along_.velocity = velocity_.data();
  }

  void take_elapsed(const py::object& elapsed) {
    elapsed_ = numbers_of(elapsed, "elapsed");
    along_.one_period = elapsed_.ndim() == 0;
    if (!along_.one_period) require_rows(elapsed_, "elapsed");
    along_.elapsed_s = elapsed_.data();
    require_periods(along_, "elapsed");
  }

  /// As the rows of a recording without ticks: each takes the time since the row before.
  void take_time(const py::object& time) {
    elapsed_ = numbers_of(time, "time");
    require_rows(elapsed_, "time");
    const std::vector<double> periods = bench::periods_of({elapsed_.data(), along_.rows});
    elapsed_ = Numbers(static_cast<py::ssize_t>(along_.rows), periods.data());
    along_.elapsed_s = elapsed_.data();
    require_periods(along_, "time");
  }

  [[nodiscard]] const Trajectory& along() const noexcept { return along_; }
  [[nodiscard]] Numbers like_position() const {
    return Numbers(std::vector<py::ssize_t>(position_.shape(), position_.shape() + position_.ndim()));
  }

 private:
  static void require_shape(const Numbers& given, const Numbers& expected, const char* name) {
    if (given.ndim() == expected.ndim() &&
        std::equal(given.shape(), given.shape() + given.ndim(), expected.shape()))
      return;
    throw std::invalid_argument(fmt::format("{}: its shape is {}; expected that of position, {}", name,
                                            shape_of(given), shape_of(expected)));
  }
  void require_rows(const Numbers& given, const char* name) const {
    if (given.ndim() == 1 && static_cast<std::size_t>(given.shape(0)) == along_.rows) return;
    throw std::invalid_argument(
        fmt::format("{}: its shape is {}; expected ({},), a number for each row of position", name,
                    shape_of(given), along_.rows));
  }

  Numbers position_;
  Numbers velocity_;
  Numbers elapsed_;
  Trajectory along_;
};

[[noreturn]] void refuse_fault(const Trajectory& along, std::size_t row) {
  for (std::size_t axis = 0; axis < along.axes; ++axis) {
    const std::size_t at = row * along.axes + axis;
    if (!std::isfinite(along.position[at]))
      throw std::invalid_argument(fmt::format("position: row {} is {}", row, along.position[at]));
    if (along.velocity != nullptr && !std::isfinite(along.velocity[at]))
      throw std::invalid_argument(fmt::format("velocity: row {} is {}", row, along.velocity[at]));
  }
  throw std::invalid_argument(fmt::format("the law gives no finite force in row {}", row));
}

Numbers render(HeldState& state, const py::object& position, const py::object& velocity,
               const py::object& time, const py::object& elapsed, bool resisting,
               const std::string& on_fault) {
  const HeldLaw& law = *state.law;
  if (resisting && law.spatial)
    throw std::invalid_argument("resisting: a law in space has no direction into the tissue");
  if (time.is_none() == elapsed.is_none()) throw std::invalid_argument("give either time or elapsed");
  const OnFault otherwise = on_fault_of(on_fault);
  Arrays arrays(law, position, velocity);
  if (time.is_none())
    arrays.take_elapsed(elapsed);
  else
    arrays.take_time(time);
  Numbers force = arrays.like_position();
  double* const to = force.mutable_data();
  const Trajectory& along = arrays.along();
  // As a loop has it: on an axis that grows into the tissue its sign is negative.
  const double zero = law.spatial || resisting ? 0.0 : law.file.contact.force_on_axis(0.0);
  std::optional<std::size_t> fault;
  {
    const Taken one_at_a_time(state);
    const py::gil_scoped_release others_may_run;
    if (law.spatial ? step_space(state, along, to) : step_line(state, along, resisting, to))
      fault = find_faults(along, otherwise, zero, {to, along.rows * along.axes});
  }
  if (fault && otherwise == OnFault::error) refuse_fault(along, *fault);
  return force;
}

py::object option_of(const models::OptionValue& value) {
  return std::visit([](const auto& one) -> py::object { return py::cast(one); }, value);
}

py::dict options_of_law(const models::Law& law) {
  py::dict all;
  for (const models::OptionInfo& info : models::Law::options(law.model())) {
    const auto given = law.options().find(info.name);
    all[py::str(info.name)] = option_of(given == law.options().end() ? info.standard : given->second);
  }
  return all;
}

/// (name, value, unit, meaning, lower, upper, std_error) each.
py::list parameters_of_law(const bench::LawFile& file) {
  py::list all;
  const std::vector<models::ParameterInfo> parameters = file.law.parameters();
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const models::ParameterInfo& one = parameters[i];
    all.append(py::make_tuple(
        one.name, file.law.values()[i], models::unit_of(one.quantity, file.force_unit, file.position_unit),
        one.meaning, one.lower, one.upper, file.std_errors.empty() ? no_number : file.std_errors[i]));
  }
  return all;
}

models::OptionValue option_value(const std::string& name, const py::handle& value) {
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>();
  if (py::isinstance<py::str>(value)) return value.cast<std::string>();
  if (py::isinstance<py::float_>(value) || py::isinstance<py::int_>(value)) return value.cast<double>();
  throw py::type_error("option '" + name + "': expected a truth value, a number or a text");
}

std::vector<double> values_of_law(const std::string& model, const py::dict& given,
                                  const models::Options& options) {
  std::vector<double> values;
  std::string known;
  const std::vector<models::ParameterInfo> parameters = models::Law::parameters(model, options);
  for (const models::ParameterInfo& info : parameters) {
    known += (known.empty() ? "" : ", ") + info.name;
    if (given.contains(info.name)) values.push_back(given[py::str(info.name)].cast<double>());
  }
  if (values.size() < parameters.size())
    throw std::invalid_argument(fmt::format("law '{}': {} of {} parameters are missing; the law takes {}",
                                            model, parameters.size() - values.size(), parameters.size(),
                                            known));
  if (values.size() < given.size()) {
    for (const auto& [name, value] : given) {
      const auto word = py::str(name).cast<std::string>();
      if (std::none_of(parameters.begin(), parameters.end(),
                       [&](const auto& one) { return one.name == word; }))
        throw std::invalid_argument(
            fmt::format("law '{}': unknown parameter '{}'; the law takes {}", model, word, known));
    }
  }
  return values;
}

SharedLaw made_law(const std::string& model, const py::dict& given, const py::dict& chosen, double contact,
                   double direction, const std::string& axis, const std::string& position_unit,
                   const std::string& force_unit) {
  models::Options options;
  for (const auto& [name, value] : chosen) {
    const auto word = py::str(name).cast<std::string>();
    options.emplace(word, option_value(word, value));
  }
  const models::LawInfo info = models::law_info(model);
  bench::LawFile file{.law = models::Law::make(model, values_of_law(model, given, options), options),
                      .contact = {.position = contact, .direction = direction},
                      .axis = axis,
                      .fit = {}};
  file.position_unit = !info.position_unit.empty() ? std::string(info.position_unit) : position_unit;
  file.force_unit = !info.force_unit.empty() ? std::string(info.force_unit) : force_unit;
  // What a law file may not say is refused in its words.
  return std::make_shared<HeldLaw>(bench::parse_law_file(bench::to_toml(file), "law '" + model + "'"));
}

py::list axes_of_law(const HeldLaw& law) {
  py::list all;
  for (const models::LawAxis& axis : law.axes)
    all.append(py::make_tuple(axis.name, axis.position_unit, axis.force_unit));
  return all;
}

py::dict provenance_of(const bench::FitProvenance& fit) {
  py::dict all;
  if (fit.date.empty() && fit.recording_uuid.empty()) return all;
  all["recording_uuid"] = fit.recording_uuid;
  all["recording_sha256"] = fit.recording_sha256;
  all["recording_content"] = fit.recording_content;
  all["rmse"] = fit.rmse_n;
  all["date"] = fit.date;
  all["software"] = fit.software;
  return all;
}

}  // namespace

void add_laws(py::module_& module) {
  py::class_<HeldLaw, SharedLaw>(module, "HeldLaw")
      .def_property_readonly("model", [](const HeldLaw& law) { return std::string(law.file.law.model()); })
      .def_property_readonly("name", [](const HeldLaw& law) { return text_of(law.file.name); })
      .def_property_readonly(
          "equation",
          [](const HeldLaw& law) { return std::string(models::law_info(law.file.law.model()).equation); })
      .def_property_readonly("toml", [](const HeldLaw& law) { return text_of(bench::to_toml(law.file)); })
      .def_readonly("spatial", &HeldLaw::spatial)
      .def_property_readonly("axes", &axes_of_law)
      .def_property_readonly("parameters", [](const HeldLaw& law) { return parameters_of_law(law.file); })
      .def_property_readonly("options", [](const HeldLaw& law) { return options_of_law(law.file.law); })
      .def_property_readonly("contact",
                             [](const HeldLaw& law) {
                               return py::make_tuple(law.file.contact.position, law.file.contact.direction);
                             })
      .def_property_readonly("fit", [](const HeldLaw& law) { return provenance_of(law.file.fit); })
      .def("write", [](const HeldLaw& law, const std::filesystem::path& file, bool replace) {
        bench::write_law_file(file, law.file, schema::existing_if(replace));
      });
  py::class_<HeldState>(module, "HeldState")
      .def(py::init<SharedLaw>())
      .def("copy",
           [](HeldState& state) {
             const Taken one_at_a_time(state);
             return std::make_unique<HeldState>(state);
           })
      .def_property_readonly("law", [](const HeldState& state) { return state.law; })
      .def_property_readonly("stored_energy",
                             [](HeldState& state) {
                               const Taken one_at_a_time(state);
                               return state.law->file.law.stored_energy(state.memory);
                             })
      .def("render", &render);
  module.def("read_law", [](const std::filesystem::path& file) {
    return std::make_shared<HeldLaw>(bench::read_law_file(file));
  });
  module.def("parse_law", [](const std::string& text, const std::string& name) {
    return std::make_shared<HeldLaw>(bench::parse_law_file(text, name));
  });
  module.def("make_law", &made_law);
  module.def("models", [] {
    py::list all;
    for (const models::LawInfo& info : models::registry()) all.append(std::string(info.name));
    return all;
  });
}

}  // namespace kerf::python
