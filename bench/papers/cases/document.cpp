#include "cases/document.h"

#include <stdexcept>
#include <string_view>

#include <fmt/format.h>

namespace kerf::bench {
namespace {

std::string verdict(const CaseOutcome& outcome) {
  return fmt::format("{}: {}", outcome.holds ? "holds" : "fails", outcome.figure);
}

}  // namespace

std::string cases_as_markdown(const std::vector<NamedCase>& cases, const ControlCosts& costs,
                              const std::string& folder) {
  std::string text = "| case | where | without its remedy | with it |\n|---|---|---|---|\n";
  const auto out = std::back_inserter(text);
  for (const NamedCase& each : cases) {
    fmt::format_to(out, "| [{0}](#{0}) | {1} | {2} | {3} |\n", each.name, each.where, verdict(each.without),
                   verdict(each.with));
  }
  for (const NamedCase& each : cases) {
    fmt::format_to(out, "\n### {}\n\n{}\n\n**Remedy.** {}\n\n", each.name, each.what, each.remedy);
    if (!each.theory.empty()) fmt::format_to(out, "**Theory.** {}\n\n", each.theory);
    fmt::format_to(out, "Measured: {}, at most {:g} {}. Without the remedy it {}; with it, it {}.\n\n",
                   each.quantity, each.limit, each.without.unit, verdict(each.without), verdict(each.with));
    fmt::format_to(out, "![{}]({}/{}.svg)\n", each.picture.title, folder, each.name);
  }
  text +=
      "\n### What passivity control costs\n\n"
      "A tap of 2 mm at up to 0.19 m/s on walls from half to four times the passive stiffness. A difference "
      "of "
      "1 JND is 7 % of\nthe force, or 0.05 N where that is more. A wall holds if a weight of 4 N that falls "
      "on "
      "it comes to rest. All are\nmeasured with a perfect encoder but the last.\n\n"
      "| K over 2 b / T | K [N/m] | holds alone | holds controlled | rms [N] | worst [N] | rms [JND] | worst "
      "[JND] | worst with the encoder [N] |\n|---|---|---|---|---|---|---|---|---|\n";
  for (const ControlCost& row : costs.rows) {
    fmt::format_to(out, "| {:g} | {:.0f} | {} | {} | {:.3f} | {:.3f} | {:.2f} | {:.2f} | {:.3f} |\n",
                   row.share, row.stiffness_n_per_m, row.holds_without ? "yes" : "no",
                   row.holds_with ? "yes" : "no", row.rms_n, row.worst_n, row.rms_jnd, row.worst_jnd,
                   row.worst_with_encoder_n);
  }
  fmt::format_to(out, "\n![{}]({}/control_cost.svg)\n", costs.picture.title, folder);
  return text;
}

std::string with_cases(const std::string& document, const std::string& cases) {
  const std::size_t begin = document.find(cases_begin);
  const std::size_t end = document.find(cases_end);
  if (begin == std::string::npos || end == std::string::npos || end < begin) {
    throw std::invalid_argument(
        fmt::format("the document has no place for the cases; it needs the lines '{}' and '{}'",
                    std::string_view(cases_begin).substr(0, std::string_view(cases_begin).size() - 1),
                    std::string_view(cases_end).substr(0, std::string_view(cases_end).size() - 1)));
  }
  const std::size_t after = begin + std::string_view(cases_begin).size();
  return document.substr(0, after) + "\n" + cases + "\n" + document.substr(end);
}

}  // namespace kerf::bench
