#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "choose/candidates.h"

namespace kerf::bench {

struct Candidate;

enum class Matter {
  matters,      ///< left out, the error exceeds the JND; taken in, it falls
  replaceable,  ///< the law that serves has it, and a richer law does without
  does_not,     ///< laws without it stay within the JND
  not_known,    ///< neither with it nor without is a law within the JND, and it mends less than that
};
[[nodiscard]] std::string_view name_of(Matter matter) noexcept;

/// Whether an effect matters in a recording, by the best law with it and the best without.
struct EffectVerdict {
  Effect effect = Effect::loop;
  Matter matter = Matter::does_not;
  double without_n = std::numeric_limits<double>::infinity();  ///< least held-out error
  double with_n = std::numeric_limits<double>::infinity();
  std::string without_law;
  std::string with_law;
  std::string why;
};

/// Every effect that any of the candidates knows. `taken`: the place of the law that serves.
[[nodiscard]] std::vector<EffectVerdict> judge_effects(std::span<const Candidate> candidates,
                                                       std::optional<std::size_t> taken, double jnd_n);

}  // namespace kerf::bench
