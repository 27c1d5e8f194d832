#include "reproduce/reproduce.h"

#include <stdexcept>

#include <fmt/core.h>

namespace kerf::bench {

Reproduction reproduce(const std::string& paper, std::uint64_t seed) {
  if (paper == "000") return reproduce_000(seed);
  if (paper == "001") return reproduce_001(seed);
  if (paper == "002") return reproduce_002(seed);
  if (paper == "003") return reproduce_003(seed);
  if (paper == "004") return reproduce_004(seed);
  throw std::invalid_argument(fmt::format("no paper '{}'; the papers are 000, 001, 002, 003 and 004", paper));
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
  return {
      {"paper", reproduction.paper}, {"title", reproduction.title}, {"claims", claims}, {"figures", figures}};
}

std::string as_markdown(const Reproduction& reproduction) {
  std::string text = fmt::format("# {}: {}\n\n| claim | where | measured | verdict |\n|---|---|---|---|\n",
                                 reproduction.paper, reproduction.title);
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
