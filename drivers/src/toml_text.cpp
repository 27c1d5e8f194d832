#include "kerf/drivers/toml_text.h"

#include <cmath>
#include <sstream>

#include <fmt/format.h>
#include <toml++/toml.h>

namespace kerf::drivers {

std::string toml_text(std::string_view text) {
  using Flags = toml::format_flags;
  auto flags = toml::toml_formatter::default_flags;
  if (text.find_first_of("\r\n") != std::string_view::npos)
    flags &= ~(Flags::allow_multi_line_strings | Flags::allow_literal_strings);
  const toml::value<std::string> value{std::string(text)};
  std::ostringstream stream;
  stream << toml::toml_formatter(value, flags);
  return stream.str();
}

std::string toml_number(double number) {
  return number == 0.0 && std::signbit(number) ? "-0.0" : fmt::format("{}", number);
}

}  // namespace kerf::drivers
