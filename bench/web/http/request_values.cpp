#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "http/routes.h"

namespace kerf::bench {
namespace {

constexpr std::size_t longest_text = 1 << 16;

[[noreturn]] void refuse(const std::string& why) { throw RequestError(400, why); }

template <typename Number>
Number parsed(std::string_view text, const std::string& name, const char* expected) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || text.empty())
    refuse(fmt::format("parameter '{}' is not {}", name, expected));
  return value;
}

double within(double value, const std::string& name, double lower, double upper) {
  if (!(value >= lower && value <= upper))
    refuse(fmt::format("parameter '{}' is not a number from {} to {}", name, lower, upper));
  return value;
}

const nlohmann::json& member(const nlohmann::json& object, const std::string& name) {
  const auto found = object.find(name);
  if (found == object.end()) refuse(fmt::format("'{}' is missing", name));
  return *found;
}

}  // namespace

std::string text_in_query(const HttpRequest& request, const std::string& name) {
  const auto found = request.query.find(name);
  if (found == request.query.end()) refuse(fmt::format("parameter '{}' is missing", name));
  return found->second;
}

double number_in_query(const HttpRequest& request, const std::string& name, double lower, double upper) {
  return within(parsed<double>(text_in_query(request, name), name, "a number"), name, lower, upper);
}

std::size_t count_in_query(const HttpRequest& request, const std::string& name, std::size_t at_most) {
  const auto value = parsed<std::size_t>(text_in_query(request, name), name, "a whole number");
  if (value > at_most) refuse(fmt::format("parameter '{}' is greater than {}", name, at_most));
  return value;
}

std::vector<std::size_t> counts_in_query(const HttpRequest& request, const std::string& name,
                                         std::size_t at_most) {
  constexpr std::size_t most = 64;
  const std::string list = text_in_query(request, name);
  std::vector<std::size_t> values;
  for (std::string_view rest = list; !rest.empty();) {
    const std::size_t end = rest.find(',');
    const auto value = parsed<std::size_t>(rest.substr(0, end), name, "whole numbers with commas");
    if (value > at_most) refuse(fmt::format("parameter '{}' has a number greater than {}", name, at_most));
    values.push_back(value);
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  }
  if (values.empty() || values.size() > most)
    refuse(fmt::format("parameter '{}' is not 1 to {} whole numbers with commas", name, most));
  return values;
}

nlohmann::json json_in(const HttpRequest& request) {
  if (!request.header("content-type").starts_with("application/json"))
    throw RequestError(415, "the body of a request is JSON");
  nlohmann::json json = nlohmann::json::parse(request.body, nullptr, false);
  if (!json.is_object()) refuse("the body of a request is a JSON object");
  return json;
}

std::string text_in(const nlohmann::json& object, const std::string& name) {
  const nlohmann::json& value = member(object, name);
  if (!value.is_string()) refuse(fmt::format("'{}' is not a text", name));
  auto text = value.get<std::string>();
  if (text.size() > longest_text || text.find('\0') != std::string::npos)
    refuse(fmt::format("'{}' is too long, or has a zero byte", name));
  return text;
}

double number_in(const nlohmann::json& object, const std::string& name, double lower, double upper) {
  const nlohmann::json& value = member(object, name);
  if (!value.is_number()) refuse(fmt::format("'{}' is not a number", name));
  const auto number = value.get<double>();
  if (!(number >= lower && number <= upper))
    refuse(fmt::format("'{}' is not a number from {} to {}", name, lower, upper));
  return number;
}

std::string text_or(const nlohmann::json& object, const std::string& name, const std::string& otherwise) {
  return object.contains(name) ? text_in(object, name) : otherwise;
}

double number_or(const nlohmann::json& object, const std::string& name, double otherwise, double lower,
                 double upper) {
  return object.contains(name) ? number_in(object, name, lower, upper) : otherwise;
}

bool flag_in(const nlohmann::json& object, const std::string& name, bool otherwise) {
  const auto found = object.find(name);
  if (found == object.end()) return otherwise;
  if (!found->is_boolean()) refuse(fmt::format("'{}' is not true or false", name));
  return found->get<bool>();
}

std::vector<double> numbers_in(const nlohmann::json& object, const std::string& name, std::size_t at_most) {
  const nlohmann::json& value = member(object, name);
  if (!value.is_array() || value.size() > at_most)
    refuse(fmt::format("'{}' is not a list of at most {} numbers", name, at_most));
  std::vector<double> numbers;
  for (const nlohmann::json& it : value) {
    if (!it.is_number() || !std::isfinite(it.get<double>())) refuse(fmt::format("'{}' has no number", name));
    numbers.push_back(it.get<double>());
  }
  return numbers;
}

}  // namespace kerf::bench
