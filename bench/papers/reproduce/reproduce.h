#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "plot/plot.h"

namespace kerf::bench {

/// What became of a claim of a paper. A question that a paper left open is answered by a number.
enum class ClaimVerdict { holds, fails, answered };

struct Claim {
  std::string claim;     ///< in the paper's sense
  std::string where;     ///< section or figure of the paper
  std::string measured;  ///< with units
  ClaimVerdict verdict = ClaimVerdict::holds;
};

/// A paper's experiments, run in virtual time.
struct Reproduction {
  std::string paper;  ///< its number: "000"
  std::string key;    ///< in docs/bibliography.md: "Henry2004"
  std::string title;
  std::vector<Claim> claims;
  std::vector<Figure> figures;

  void add(std::string claim, std::string where, std::string measured, bool holds) {
    claims.push_back({std::move(claim), std::move(where), std::move(measured),
                      holds ? ClaimVerdict::holds : ClaimVerdict::fails});
  }
  void answer(std::string question, std::string where, std::string measured) {
    claims.push_back({std::move(question), std::move(where), std::move(measured), ClaimVerdict::answered});
  }
};

// One paper each, in a namespace of its own. Deterministic for a seed, but for the times that [Weiss2004] is
// answered with.
namespace henry2004 {
[[nodiscard]] Reproduction run(std::uint64_t seed);  ///< blade and tissue
}
namespace sepulveda2008 {
[[nodiscard]] Reproduction run(std::uint64_t seed);  ///< orthogonal decomposition
}
namespace fuzzy_kelvin {
[[nodiscard]] Reproduction run(std::uint64_t seed);  ///< fuzzy-Kelvin hybrid
}
namespace weiss2004 {
[[nodiscard]] Reproduction run(std::uint64_t seed);  ///< two-mesh scissors
}
namespace okamura2003 {
[[nodiscard]] Reproduction run(std::uint64_t seed);  ///< the haptic scissors
}

/// `paper`: its number or its key, the latter in brackets or not.
/// @throws std::invalid_argument for any other.
[[nodiscard]] Reproduction reproduce(const std::string& paper, std::uint64_t seed);

[[nodiscard]] const char* name_of(ClaimVerdict verdict);
[[nodiscard]] nlohmann::ordered_json to_json(const Reproduction& reproduction);
/// The claims as a Markdown table.
[[nodiscard]] std::string as_markdown(const Reproduction& reproduction);

}  // namespace kerf::bench
