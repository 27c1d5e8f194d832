#include "kerf/drivers/toml_text.h"

#include <cmath>
#include <sstream>

#include <fmt/format.h>
#include <toml++/toml.h>

namespace kerf::drivers {

std::string toml_text(std::string_view text) {
  std::ostringstream stream;
  const toml::value<std::string> value{std::string(text)};
  stream << toml::toml_formatter(
      value, toml::toml_formatter::default_flags & ~toml::format_flags::allow_multi_line_strings);
  return stream.str();
}

std::string toml_number(double number) {
  return number == 0.0 && std::signbit(number) ? "-0.0" : fmt::format("{}", number);
}

}  // namespace kerf::drivers
