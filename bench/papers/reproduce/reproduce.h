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
  std::string paper;  ///< "000"
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

// One paper each. Deterministic for a seed, but for the times that 003 measures.
[[nodiscard]] Reproduction reproduce_000(std::uint64_t seed);  ///< blade and tissue (Henry)
[[nodiscard]] Reproduction reproduce_001(std::uint64_t seed);  ///< orthogonal decomposition (Sepulveda)
[[nodiscard]] Reproduction reproduce_002(std::uint64_t seed);  ///< fuzzy-Kelvin hybrid
[[nodiscard]] Reproduction reproduce_003(std::uint64_t seed);  ///< two-mesh scissors (Weiss)
[[nodiscard]] Reproduction reproduce_004(std::uint64_t seed);  ///< the haptic scissors (Okamura)

/// @throws std::invalid_argument for a paper that is none of 000 to 004.
[[nodiscard]] Reproduction reproduce(const std::string& paper, std::uint64_t seed);

[[nodiscard]] const char* name_of(ClaimVerdict verdict);
[[nodiscard]] nlohmann::ordered_json to_json(const Reproduction& reproduction);
/// The claims as a Markdown table.
[[nodiscard]] std::string as_markdown(const Reproduction& reproduction);

}  // namespace kerf::bench
