#include "kerf/models/foreign.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <mutex>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "kerf/models/foreign_call.h"

namespace kerf::models {
namespace {

constexpr std::size_t longest_text = 1000;
constexpr std::size_t largest_state = std::size_t{64} << 20U;
constexpr std::size_t largest_alignment = 4096;
constexpr int after_the_house = 1000;  // of `usual`: behind every law of the registry

template <typename... Parts>
[[noreturn]] void refuse(const Parts&... parts) {
  std::ostringstream message;
  (message << ... << parts);
  throw std::invalid_argument(message.str());
}

std::string text_of(const char* text, std::string_view what) {
  if (text == nullptr) refuse(what, " is missing");
  const std::size_t length = strnlen(text, longest_text + 1);
  if (length == 0) refuse(what, " is empty");
  if (length > longest_text) refuse(what, " is longer than ", longest_text, " bytes");
  std::string copy(text, length);
  if (std::ranges::any_of(copy, [](char c) { return static_cast<unsigned char>(c) < ' '; }))
    refuse(what, " has a line break or another control character");
  return copy;
}

bool is_name(std::string_view name) {
  const auto is_letter = [](char c) { return c >= 'a' && c <= 'z'; };
  return !name.empty() && name.size() <= 60 && is_letter(name.front()) &&
         std::ranges::all_of(name,
                             [&](char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '_'; });
}

std::string name_of(const char* text, const std::string& what) {
  std::string name = text_of(text, what);
  if (!is_name(name))
    refuse(what, " is '", name, "', expected a to z, 0 to 9 and _, first a letter, at most 60 of them");
  return name;
}

/// As the house writes it: "N*s/m^2" is N·s/m².
std::string unit_text(std::string text) {
  const auto replace = [&](std::string_view from, std::string_view to) {
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
      text.replace(at, from.size(), to);
  };
  replace("*", "·");
  replace("^2", "²");
  replace("^3", "³");
  return text;
}

/// One of two units; none: either.
std::string axis_unit(const char* unit, std::string_view first, std::string_view second,
                      const std::string& what, bool may_be_missing) {
  if (unit == nullptr && may_be_missing) return "";
  std::string text = unit_text(text_of(unit, what));
  if (text != first && text != second) refuse(what, " is '", text, "', expected ", first, " or ", second);
  return text;
}

Quantity quantity_of(const std::string& given, const std::string& what, std::string_view force_unit,
                     std::string_view position_unit) {
  const std::string unit = unit_text(given);
  std::string known;
  for (int i = 0; i <= static_cast<int>(Quantity::surface_stiffness); ++i) {
    const auto quantity = static_cast<Quantity>(i);
    const std::string one = unit_of(quantity, force_unit, position_unit);
    if (one == unit) return quantity;
    if (known.find(" " + one + ",") == std::string::npos) known += " " + one + ",";
  }
  known.pop_back();
  refuse(what, ": its unit '", given, "' is none of", known);
}

/// The alignment of a state that can be.
std::size_t checked_alignment(std::size_t size, std::size_t alignment, std::string_view what) {
  if (size > largest_state) refuse(what, "_size is ", size, " bytes, expected at most ", largest_state);
  if (alignment == 0) return alignof(double);
  if (!std::has_single_bit(alignment) || alignment > largest_alignment)
    refuse(what, "_alignment is ", alignment, ", expected a power of two up to ", largest_alignment,
           ", or 0");
  return alignment;
}

const kerf_law_v1& of_this_version(const kerf_law_v1& law) {
  if (law.abi != KERF_LAW_ABI) {
    refuse("it is made for version ", law.abi, " of kerf/law.h, and this program reads version ",
           KERF_LAW_ABI, ": build it anew with the header of this program");
  }
  if (law.size != sizeof(kerf_law_v1)) {
    refuse("its description is of ", law.size, " bytes, expected ", sizeof(kerf_law_v1),
           ": set size to sizeof(kerf_law_v1)");
  }
  return law;
}

KnownEffects effects_of(std::uint32_t tells) {
  const auto has = [tells](std::uint32_t bit) { return (tells & bit) != 0; };
  KnownEffects effects;
  if (has(KERF_TELLS_LOOP)) effects.add(Effect::loop);
  if (has(KERF_TELLS_RELAXATION)) effects.add(Effect::relaxation);
  if (has(KERF_TELLS_CUTTING)) effects.add(Effect::cutting);
  if (has(KERF_TELLS_RATE)) effects.add(Effect::rate);
  if (has(KERF_TELLS_STIFFENING)) effects.add(Effect::stiffening);
  return effects;
}

LawFacts facts_of(const kerf_law_v1& law) {
  LawFacts facts;
  if (law.axis_count > 0) return facts;
  facts.search = Search::descent;
  facts.usual = after_the_house;
  facts.charted = true;
  facts.variants = {Variant{.effects = effects_of(law.tells)}};
  return facts;
}

// Of the memory that a thread begins with: a library that is loaded later would take it at the first step.
[[gnu::tls_model("initial-exec")]] thread_local const ForeignLaw* running = nullptr;

/// What others see of a thread: in a line of the cache of its own.
struct alignas(64) Watched {
  std::atomic<const ForeignLaw*> law{nullptr};
  std::atomic<std::uint64_t> begun{0};
};
std::array<Watched, watched_threads> watched;
std::atomic<std::size_t> threads{0};
[[gnu::tls_model("initial-exec")]] thread_local Watched* seen_of_this = nullptr;

Watched& seen() noexcept {
  if (seen_of_this == nullptr)
    seen_of_this = &watched[threads.fetch_add(1, std::memory_order_relaxed) % watched_threads];
  return *seen_of_this;
}

/// While a plug-in's code runs.
class Running {
 public:
  explicit Running(const ForeignLaw& law) noexcept : seen_(seen()) {
    running = &law;
    seen_.begun.store(seen_.begun.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
    seen_.law.store(&law, std::memory_order_relaxed);
  }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;
  ~Running() {
    seen_.law.store(nullptr, std::memory_order_relaxed);
    running = nullptr;
  }

 private:
  Watched& seen_;
};

/// Never taken apart: laws, and views of their names, live as long as the program.
struct Registration {
  Registration(const kerf_law_v1& description, PluginFile from, const Registration* before_it)
      : law(description, std::move(from)), before(before_it) {}
  const ForeignLaw law;
  const Registration* const before;
};
std::atomic<const Registration*> latest{nullptr};
std::mutex registering;

}  // namespace

ForeignLaw::ForeignLaw(const kerf_law_v1& law, PluginFile from)
    : law_(of_this_version(law)),
      plugin_(std::move(from)),
      name_(name_of(law.name, "the law's name")),
      equation_(text_of(law.equation, "the law's equation")),
      position_unit_(axis_unit(law.position_unit, "m", "rad", "position_unit", true)),
      force_unit_(axis_unit(law.force_unit, "N", "N·m", "force_unit", true)),
      facts_(facts_of(law)) {
  const auto is_its_name = [&](const LawInfo& one) { return one.name == name_; };
  if (foreign_law(name_) == nullptr && std::ranges::any_of(models::registry(), is_its_name))
    refuse("its law is called '", name_, "' as one of Kerf's own; give it another name");
  if (law.step == nullptr) refuse("it has no step()");
  if (law.reserved != 0 || law.tells > 31)
    refuse("'tells' or 'reserved' has bits that version 1 does not know");
  law_.state_alignment = checked_alignment(law.state_size, law.state_alignment, "state");
  if (law.step_derivatives != nullptr) {
    if (law.axis_count > 0)
      refuse("step_derivatives() is for laws along one axis, and this has axes of its own");
    law_.derivatives_state_alignment =
        checked_alignment(law.derivatives_state_size, law.derivatives_state_alignment, "derivatives_state");
  } else if (law.init_derivatives != nullptr) {
    refuse("it has init_derivatives() without step_derivatives()");
  }
  read_axes(law);
  read_parameters(law);
}

void ForeignLaw::read_parameters(const kerf_law_v1& law) {
  if (law.parameter_count == 0 || law.parameter_count > max_parameters || law.parameters == nullptr)
    refuse("it has ", law.parameter_count, " parameters, expected 1 to ", max_parameters);
  bool any_is_searched = false;
  for (const kerf_law_parameter_v1& one : std::span(law.parameters, law.parameter_count)) {
    const std::string name =
        name_of(one.name, "the name of parameter " + std::to_string(parameters_.size() + 1));
    const std::string what = "parameter '" + name + "'";
    if (std::ranges::find(parameters_, name, &ParameterInfo::name) != parameters_.end())
      refuse("two parameters are called '", name, "'");
    if (one.flags > 7) refuse(what, ": its flags have bits that version 1 does not know");
    if (!std::isfinite(one.lower) || !std::isfinite(one.upper) || !(one.lower < one.upper))
      refuse(what, ": its bounds are ", one.lower, " and ", one.upper,
             ", expected a smaller and a larger number");
    if (!(one.initial >= one.lower && one.initial <= one.upper))
      refuse(what, ": its initial value ", one.initial, " is not from ", one.lower, " to ", one.upper);
    const bool logarithmic = (one.flags & KERF_LOGARITHMIC) != 0;
    if (logarithmic && !(one.lower > 0.0))
      refuse(what, " is logarithmic, and its lower bound is ", one.lower, ", expected more than 0");
    parameters_.push_back({.name = name,
                           .quantity = quantity_of(text_of(one.unit, what + ": its unit"), what,
                                                   force_unit_.empty() ? "N" : force_unit_,
                                                   position_unit_.empty() ? "m" : position_unit_),
                           .lower = one.lower,
                           .upper = one.upper,
                           .scale = logarithmic ? Scale::logarithmic : Scale::linear,
                           .meaning = text_of(one.meaning, what + ": its meaning")});
    initial_.push_back(one.initial);
    flags_.push_back(one.flags);
    any_is_searched = any_is_searched || (one.flags & KERF_SEARCHED) != 0;
  }
  if (!any_is_searched && axes_.empty())
    refuse("none of its parameters is searched: flag those that a fit finds");
}

void ForeignLaw::read_axes(const kerf_law_v1& law) {
  if (law.axis_count > max_law_axes || (law.axis_count > 0) != (law.axes != nullptr))
    refuse("it has ", law.axis_count, " axes", law.axes == nullptr ? " and no list of them" : "",
           ", expected none or a list of up to ", max_law_axes);
  for (std::size_t i = 0; i < law.axis_count; ++i) {
    const std::string name = name_of(law.axes[i].name, "the name of axis " + std::to_string(i + 1));
    if (std::ranges::find(axes_, name, &LawAxis::name) != axes_.end())
      refuse("two axes are called '", name, "'");
    const std::string what = "axis '" + name + "': its unit";
    axes_.push_back({.name = name,
                     .position_unit = axis_unit(law.axes[i].position_unit, "m", "rad", what, false),
                     .force_unit = axis_unit(law.axes[i].force_unit, "N", "N·m", what, false)});
  }
}

LawInfo ForeignLaw::info() const {
  return {.name = name_, .equation = equation_, .position_unit = position_unit_, .force_unit = force_unit_};
}

void ForeignLaw::step(const double* values, ForeignState& state, const double* position,
                      const double* velocity, double period_s, double* force) const noexcept {
  constexpr double broken = std::numeric_limits<double>::quiet_NaN();
  try {
    const Running here(*this);
    law_.step(values, state.bytes(), position, velocity, period_s, force);
  } catch (...) {
    force[0] = broken;
  }
  if (!state.is_intact()) force[0] = broken;
}

double ForeignLaw::step_with_derivatives(const double* values, ForeignState& state, const Motion& motion,
                                         double period_s, double* derivatives) const noexcept {
  double force = std::numeric_limits<double>::quiet_NaN();
  try {
    const Running here(*this);
    law_.step_derivatives(values, state.bytes(), &motion.penetration, &motion.velocity, period_s, &force,
                          derivatives);
  } catch (...) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  return state.is_intact() ? force : std::numeric_limits<double>::quiet_NaN();
}

double ForeignLaw::stored_energy(const double* values, const ForeignState& state) const noexcept {
  if (law_.stored_energy == nullptr) return std::numeric_limits<double>::quiet_NaN();
  try {
    const Running here(*this);
    return law_.stored_energy(values, state.bytes());
  } catch (...) {
    return std::numeric_limits<double>::quiet_NaN();
  }
}

const ForeignLaw& register_law(const kerf_law_v1& law, const PluginFile& from) {
  const std::lock_guard lock(registering);
  auto made = std::make_unique<Registration>(law, from, latest.load());
  if (const ForeignLaw* const there = foreign_law(made->law.info().name)) {
    if (there->plugin().sha256 == from.sha256) return *there;
    refuse("its law is called '", there->info().name, "' as that of ", there->plugin().path,
           "; one of them at a time, or give it another name");
  }
  const ForeignLaw& registered = made->law;
  latest = made.release();
  return registered;
}

const ForeignLaw* foreign_law(std::string_view model) noexcept {
  for (const Registration* one = latest.load(); one != nullptr; one = one->before) {
    if (one->law.info().name == model) return &one->law;
  }
  return nullptr;
}

std::vector<const ForeignLaw*> foreign_laws() {
  std::vector<const ForeignLaw*> all;
  for (const Registration* one = latest.load(); one != nullptr; one = one->before) all.push_back(&one->law);
  std::ranges::reverse(all);
  return all;
}

const ForeignLaw* running_foreign_law() noexcept { return running; }

ForeignCall foreign_call(std::size_t thread) noexcept {
  const Watched& one = watched[thread];
  return {.law = one.law.load(std::memory_order_relaxed), .begun = one.begun.load(std::memory_order_relaxed)};
}

}  // namespace kerf::models
