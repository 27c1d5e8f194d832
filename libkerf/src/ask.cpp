#include <algorithm>
#include <limits>
#include <variant>

#include <kerf/schema/recording.h>
#include <kerf/version.h>

#include "handles.h"
#include "plugins.h"

// What can be asked of the library and of a law.

namespace {

constexpr bool is_bit(std::uint32_t ours, kerf::schema::Flag of_rows) { return ours == of_rows; }
static_assert(is_bit(KERF_FORCE_LIMITED, kerf::schema::flag_force_limited));
static_assert(is_bit(KERF_SLEW_LIMITED, kerf::schema::flag_slew_limited));
static_assert(is_bit(KERF_SOFT_START, kerf::schema::flag_soft_start));
static_assert(is_bit(KERF_LAW_FAULT, kerf::schema::flag_law_fault));
static_assert(is_bit(KERF_DEVICE_FAULT, kerf::schema::flag_device_fault));
static_assert(is_bit(KERF_POSITION_JUMP, kerf::schema::flag_position_jump));
static_assert(is_bit(KERF_WATCHDOG, kerf::schema::flag_watchdog));
static_assert(is_bit(KERF_ZERO_HELD, kerf::schema::flag_zero_held));
static_assert(KERF_MAX_AXES == kerf::models::max_law_axes && KERF_MAX_AXES == kerf::drivers::max_axes);

constexpr std::uint32_t told = KERF_FORCE_LIMITED | KERF_SLEW_LIMITED | KERF_SOFT_START | KERF_LAW_FAULT |
                               KERF_DEVICE_FAULT | KERF_POSITION_JUMP | KERF_WATCHDOG | KERF_ZERO_HELD;

/// As C has it; made when the library is loaded.
const std::string whole_name = kerf::software();
const std::string version_number(kerf::version());
const std::vector<std::string> model_names = [] {
  std::vector<std::string> names;
  for (const kerf::models::LawInfo& info : kerf::models::registry()) names.emplace_back(info.name);
  return names;
}();

kerf_option as_option(const std::string& name, const kerf::models::OptionValue& value) {
  kerf_option option{.name = name.c_str(), .kind = KERF_OPTION_NUMBER, .number = 0.0, .text = nullptr};
  if (const bool* const flag = std::get_if<bool>(&value)) {
    option.kind = KERF_OPTION_FLAG;
    option.number = *flag ? 1.0 : 0.0;
  } else if (const std::string* const text = std::get_if<std::string>(&value)) {
    option.kind = KERF_OPTION_TEXT;
    option.text = text->c_str();
  } else {
    option.number = std::get<double>(value);
  }
  return option;
}

}  // namespace

uint32_t kerf_abi_version() { return KERF_ABI_VERSION; }
const char* kerf_version() { return version_number.c_str(); }
const char* kerf_software() { return whole_name.c_str(); }
double kerf_none() { return std::numeric_limits<double>::quiet_NaN(); }

const char* kerf_status_text(kerf_status status) {
  switch (status) {
    case KERF_OK:
      return "no error";
    case KERF_BAD_INPUT:
      return "bad input";
    case KERF_SYSTEM:
      return "the system refused";
    default:
      return "an unknown status";
  }
}

const char* kerf_flag_text(uint32_t flag) {
  // The texts of the table are whole literals, and so end in a zero.
  for (const kerf::schema::FlagInfo& info : kerf::schema::flag_table) {
    if (info.flag == flag && (flag & told) != 0) return info.meaning.data();
  }
  return nullptr;
}

size_t kerf_model_count() { return model_names.size() + kerf::plugin_count(); }
const char* kerf_model_name(size_t model) {
  if (model < model_names.size()) return model_names[model].c_str();
  return kerf::plugin_model(model - model_names.size());
}

const char* kerf_law_model(const kerf_law* law) { return law->opened->model.c_str(); }
const char* kerf_law_equation(const kerf_law* law) { return law->opened->equation.c_str(); }
const char* kerf_law_text(const kerf_law* law) { return law->opened->text.c_str(); }
const char* kerf_law_sha256(const kerf_law* law) { return law->opened->sha256.c_str(); }
int32_t kerf_law_is_spatial(const kerf_law* law) { return law->opened->spatial ? 1 : 0; }

size_t kerf_law_axis_count(const kerf_law* law) { return law->opened->axes.size(); }
kerf_status kerf_law_axis(const kerf_law* law, size_t index, kerf_axis* axis) {
  const auto& axes = law->opened->axes;
  if (index >= axes.size()) return KERF_BAD_INPUT;
  *axis = {.name = axes[index].name.c_str(),
           .position_unit = axes[index].position_unit.c_str(),
           .force_unit = axes[index].force_unit.c_str()};
  return KERF_OK;
}

kerf_contact kerf_law_contact(const kerf_law* law) {
  const kerf::models::Contact& contact = law->opened->file.contact;
  return {.position = contact.position, .direction = contact.direction};
}

size_t kerf_law_parameter_count(const kerf_law* law) { return law->opened->parameters.size(); }
kerf_status kerf_law_parameter(const kerf_law* law, size_t index, kerf_parameter* parameter) {
  const kerf::OpenedLaw& of = *law->opened;
  if (index >= of.parameters.size()) return KERF_BAD_INPUT;
  const kerf::models::ParameterInfo& info = of.parameters[index];
  *parameter = {.name = info.name.c_str(),
                .unit = of.units[index].c_str(),
                .meaning = info.meaning.c_str(),
                .value = of.file.law.values()[index],
                .lower = info.lower,
                .upper = info.upper,
                .std_error = of.file.std_errors.empty() ? kerf_none() : of.file.std_errors[index]};
  return KERF_OK;
}

size_t kerf_law_option_count(const kerf_law* law) { return law->opened->options.size(); }
kerf_status kerf_law_option(const kerf_law* law, size_t index, kerf_option_info* option) {
  const kerf::OpenedLaw& of = *law->opened;
  if (index >= of.options.size()) return KERF_BAD_INPUT;
  const kerf::models::OptionInfo& info = of.options[index];
  const kerf::models::Options& given = of.file.law.options();
  const auto found = given.find(info.name);
  *option = {.meaning = info.meaning.c_str(),
             .value = as_option(info.name, found == given.end() ? info.standard : found->second),
             .standard = as_option(info.name, info.standard)};
  return KERF_OK;
}
