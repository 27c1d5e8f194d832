#include "results/asked_fit_json.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/core.h>

#include "http/routes.h"

namespace kerf::bench {
namespace {

constexpr std::size_t most_texts = 32;
constexpr std::array<std::string_view, 2> of_the_order{"models", "recording"};  // read elsewhere

[[noreturn]] void refuse_option(std::string_view name, std::string_view expected) {
  throw RequestError(400, fmt::format("'{}' is not {}", name, expected));
}

std::string read_text(const std::string& name, const nlohmann::json& value) {
  if (!value.is_string()) refuse_option(name, "a text");
  return value.get<std::string>();
}

double read_number(const std::string& name, const nlohmann::json& value) {
  if (!value.is_number() || !std::isfinite(value.get<double>())) refuse_option(name, "a number");
  return value.get<double>();
}

std::size_t read_count(const std::string& name, const nlohmann::json& value) {
  if (!value.is_number_unsigned()) refuse_option(name, "a whole number");
  return value.get<std::size_t>();
}

std::vector<std::string> read_texts(const std::string& name, const nlohmann::json& value) {
  if (!value.is_array() || value.size() > most_texts)
    refuse_option(name, fmt::format("a list of at most {} texts", most_texts));
  std::vector<std::string> all;
  for (const nlohmann::json& one : value) all.push_back(read_text(name, one));
  return all;
}

using Take = std::function<void(AskedFit&, const std::string&, const nlohmann::json&)>;

/// Puts a value where it belongs, once it is read.
template <typename Place, typename Read>
Take into(Place place, Read read) {
  return [place, read](AskedFit& asked, const std::string& name, const nlohmann::json& value) {
    place(asked) = read(name, value);
  };
}

const std::map<std::string, Take, std::less<>>& option_takers() {
  static const std::map<std::string, Take, std::less<>> all{
      {"axis", into(
                   [](AskedFit & it) -> auto& { return it.axis; }, read_text)},
      {"rows", into(
                   [](AskedFit & it) -> auto& { return it.rows; }, read_text)},
      {"cycles", into(
                     [](AskedFit & it) -> auto& { return it.cycles; }, read_text)},
      {"contact", into(
                      [](AskedFit & it) -> auto& { return it.contact.position; }, read_number)},
      {"direction", into(
                        [](AskedFit & it) -> auto& { return it.contact.direction; }, read_text)},
      {"rate", into(
                   [](AskedFit & it) -> auto& { return it.options.loop_rate_hz; }, read_number)},
      {"noise", [](AskedFit& it, const std::string& name,
                   const nlohmann::json& value) { it.noise = {read_number(name, value)}; }},
      {"segments", into(
                       [](AskedFit & it) -> auto& { return it.segments; }, read_text)},
      {"points_per_segment",
       into(
           [](AskedFit & it) -> auto& { return it.options.fit.points_per_segment; }, read_count)},
      {"breakpoints", into(
                          [](AskedFit & it) -> auto& { return it.breakpoints; }, read_texts)},
      {"arms", into(
                   [](AskedFit & it) -> auto& { return it.arms; }, read_count)},
      {"memberships", into(
                          [](AskedFit & it) -> auto& { return it.memberships; }, read_count)},
      {"thickness", into(
                        [](AskedFit & it) -> auto& { return it.thickness; }, read_number)},
      {"option", into(
                     [](AskedFit & it) -> auto& { return it.options.law_options; }, read_texts)},
      {"folds",
       [](AskedFit& it, const std::string& name, const nlohmann::json& value) {
         it.options.fit.folds = read_count(name, value);
         it.no_folds = it.options.fit.folds == 0;
       }},
      {"test_share", into(
                         [](AskedFit & it) -> auto& { return it.options.fit.test_share; }, read_number)},
      {"loss", into(
                   [](AskedFit & it) -> auto& { return it.loss; }, read_text)},
      {"loss_scale", into(
                         [](AskedFit & it) -> auto& { return it.options.fit.loss_scale_n; }, read_number)},
      {"confidence", into(
                         [](AskedFit & it) -> auto& { return it.options.fit.confidence; }, read_number)},
      {"profile",
       [](AskedFit& it, const std::string& name, const nlohmann::json& value) {
         if (!value.is_boolean()) refuse_option(name, "true or false");
         it.options.fit.profile = value.get<bool>();
       }},
      {"weber", into(
                    [](AskedFit & it) -> auto& { return it.jnd.weber_fraction; }, read_number)},
      {"threshold", into(
                        [](AskedFit & it) -> auto& { return it.jnd.threshold; }, read_number)}};
  return all;
}

}  // namespace

AskedFit asked_fit_in(const nlohmann::json& given) {
  AskedFit asked;
  for (const auto& [name, value] : given.items()) {
    if (std::ranges::find(of_the_order, name) != of_the_order.end()) continue;
    const auto take = option_takers().find(name);
    if (take == option_takers().end())
      throw RequestError(400, fmt::format("a fit has no option '{}'; 'kerf fit --help' lists them", name));
    take->second(asked, name, value);
  }
  return asked;
}

}  // namespace kerf::bench
