#include "reproduce/reproduce.h"

#include <array>
#include <stdexcept>
#include <string_view>

#include <fmt/core.h>

namespace kerf::bench {
namespace {

struct Paper {
  std::string_view number;
  std::string_view key;
  Reproduction (*run)(std::uint64_t seed);
};

constexpr std::array papers{
    Paper{"000", "Henry2004", henry2004::run}, Paper{"001", "Sepulveda2008", sepulveda2008::run},
    Paper{"002", "FuzzyKelvin", fuzzy_kelvin::run}, Paper{"003", "Weiss2004", weiss2004::run},
    Paper{"004", "Okamura2003", okamura2003::run}};

}  // namespace

Reproduction reproduce(const std::string& paper, std::uint64_t seed) {
  std::string_view name = paper;
  if (name.starts_with('[') && name.ends_with(']')) name = name.substr(1, name.size() - 2);
  std::string known;
  for (const Paper& one : papers) {
    if (name == one.number || name == one.key) return one.run(seed);
    known += fmt::format("{}{} ({})", known.empty() ? "" : ", ", one.key, one.number);
  }
  throw std::invalid_argument(fmt::format("no paper '{}'; the papers are {}", paper, known));
}

const char* name_of(ClaimVerdict verdict) {
  switch (verdict) {
    case ClaimVerdict::holds:
      return "holds";
    case ClaimVerdict::fails:
      return "does not hold";
    case ClaimVerdict::answered:
      return "answered";
  }
  return "";
}

nlohmann::ordered_json to_json(const Reproduction& reproduction) {
  nlohmann::ordered_json claims = nlohmann::ordered_json::array();
  for (const Claim& claim : reproduction.claims) {
    claims.push_back({{"claim", claim.claim},
                      {"where", claim.where},
                      {"measured", claim.measured},
                      {"verdict", name_of(claim.verdict)}});
  }
  nlohmann::ordered_json figures = nlohmann::ordered_json::array();
  for (const Figure& figure : reproduction.figures) figures.push_back(figure.name + ".svg");
  return {{"paper", reproduction.paper},
          {"key", reproduction.key},
          {"title", reproduction.title},
          {"claims", claims},
          {"figures", figures}};
}

std::string as_markdown(const Reproduction& reproduction) {
  std::string text = fmt::format("# [{}]: {}\n\n| claim | where | measured | verdict |\n|---|---|---|---|\n",
                                 reproduction.key, reproduction.title);
  for (const Claim& claim : reproduction.claims) {
    text += fmt::format("| {} | {} | {} | {} |\n", claim.claim, claim.where, claim.measured,
                        name_of(claim.verdict));
  }
  for (const Figure& figure : reproduction.figures) {
    text += fmt::format("\n![{}]({}.svg)\n", figure.chart.title, figure.name);
  }
  return text;
}

}  // namespace kerf::bench
