#include "atlas/atlas_question.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <fmt/format.h>

namespace kerf::bench {
namespace {

using Relation = AtlasCondition::Relation;

constexpr std::array<std::string_view, 5> statistic_names{"mean", "median", "smallest", "largest", "share"};
// The longer ones first: "<=" begins with "<".
constexpr std::array<std::pair<std::string_view, Relation>, 4> relations{
    {{"<=", Relation::at_most}, {">=", Relation::at_least}, {"<", Relation::less}, {">", Relation::greater}}};

std::string_view trimmed(std::string_view text) {
  const auto begin = text.find_first_not_of(' ');
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(' ') - begin + 1);
}

AtlasCondition parse_condition(std::string_view text) {
  for (const auto& [sign, relation] : relations) {
    const auto at = text.find(sign);
    if (at == std::string_view::npos) continue;
    const std::string_view left = trimmed(text.substr(0, at));
    const std::string_view right = trimmed(text.substr(at + sign.size()));
    if (left.empty() || right.empty()) break;
    AtlasCondition condition{.column = std::string(left), .relation = relation, .other = {}};
    const auto [end, error] = std::from_chars(right.data(), right.data() + right.size(), condition.number);
    if (error != std::errc{} || end != right.data() + right.size()) condition.other = std::string(right);
    return condition;
  }
  throw std::invalid_argument(
      fmt::format("'{}' is no condition; expected such as damping <= 12, with <, <=, > or >=", text));
}

double bound_from(const nlohmann::json& value, double otherwise) {
  return value.is_null() ? otherwise : value.get<double>();
}

AtlasFilter filter_from(const std::string& column, const nlohmann::json& value) {
  AtlasFilter filter{.column = column};
  if (value.size() == 2 && !value[0].is_string() && !value[1].is_string()) {
    filter.lower = bound_from(value[0], filter.lower);
    filter.upper = bound_from(value[1], filter.upper);
  } else {
    filter.among = value.get<std::vector<std::string>>();
  }
  return filter;
}

}  // namespace

std::string_view name_of(AtlasStatistic statistic) noexcept {
  return statistic_names[static_cast<std::size_t>(statistic)];
}

AtlasStatistic statistic_called(std::string_view name) {
  const auto found = std::ranges::find(statistic_names, name);
  if (found == statistic_names.end())
    throw std::invalid_argument(
        fmt::format("'{}' is no statistic; expected {}", name, fmt::join(statistic_names, ", ")));
  return static_cast<AtlasStatistic>(found - statistic_names.begin());
}

std::vector<AtlasCondition> parse_conditions(std::string_view text) {
  std::vector<AtlasCondition> conditions;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find('&', begin), text.size());
    conditions.push_back(parse_condition(trimmed(text.substr(begin, end - begin))));
    begin = end + 1;
  }
  return conditions;
}

std::string in_words(const std::vector<AtlasCondition>& conditions) {
  std::string text;
  for (const AtlasCondition& condition : conditions) {
    const auto sign = std::ranges::find(relations, condition.relation,
                                        [](const auto& relation) { return relation.second; });
    text += fmt::format("{}{} {} {}", text.empty() ? "" : " and ", condition.column, sign->first,
                        condition.other.empty() ? fmt::format("{}", condition.number) : condition.other);
  }
  return text;
}

AtlasQuestion question_from_json(const nlohmann::json& given) try {
  AtlasQuestion question;
  question.table = given.at("table").get<std::string>();
  question.by = given.at("by").get<std::vector<std::string>>();
  if (given.contains("share")) {
    question.statistic = AtlasStatistic::share;
    question.share = parse_conditions(given.at("share").get<std::string>());
  } else {
    question.of = given.at("of").get<std::string>();
    question.statistic = statistic_called(given.value("statistic", std::string("mean")));
    if (question.is_share()) throw std::invalid_argument("a share needs its condition as 'share'");
  }
  question.bins = given.value("bins", AtlasQuestion::usual_bins);
  if (given.contains("where")) {
    for (const auto& [column, value] : given.at("where").items())
      question.where.push_back(filter_from(column, value));
  }
  if (question.by.size() > AtlasQuestion::most_parts || question.bins < 2 || question.bins > 400)
    throw std::invalid_argument(
        fmt::format("expected up to {} columns in 'by' and 2 to 400 bins", AtlasQuestion::most_parts));
  return question;
} catch (const nlohmann::json::exception&) {
  throw std::invalid_argument("a question about a sweep has 'table', 'by', and 'of' or 'share'");
}

}  // namespace kerf::bench
