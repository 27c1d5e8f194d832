#include "cases/case_findings.h"

#include <fmt/core.h>

#include "html/html.h"
#include "tables/csv.h"

namespace kerf::bench {
namespace {

using json = nlohmann::ordered_json;

json as_json(const CaseOutcome& outcome) {
  return {{"holds", outcome.holds}, {"measured", outcome.measured}, {"unit", outcome.unit}};
}

json as_json(const ControlCost& cost) {
  return {{"share", cost.share},
          {"K", cost.stiffness_n_per_m},
          {"holds_without", cost.holds_without},
          {"holds_with", cost.holds_with},
          {"rms_n", cost.rms_n},
          {"worst_n", cost.worst_n},
          {"rms_jnd", cost.rms_jnd},
          {"worst_jnd", cost.worst_jnd},
          {"worst_with_encoder_n", cost.worst_with_encoder_n}};
}

}  // namespace

Findings findings_of(const std::vector<NamedCase>& cases, const std::optional<ControlCosts>& costs) {
  Findings found;
  found.json = {{"study", "cases"}, {"cases", json::array()}};
  found.csv = "case,quantity,unit,limit,without,without_holds,with,with_holds\n";
  for (const NamedCase& each : cases) {
    found.json["cases"].push_back({{"name", each.name},
                                   {"where", each.where},
                                   {"what", each.what},
                                   {"remedy", each.remedy},
                                   {"quantity", each.quantity},
                                   {"limit", each.limit},
                                   {"theory", each.theory},
                                   {"without", as_json(each.without)},
                                   {"with", as_json(each.with)}});
    found.csv += fmt::format("{},{},{},{:.8g},{:.8g},{:d},{:.8g},{:d}\n", each.name,
                             csv_quoted(each.quantity), each.with.unit, each.limit, each.without.measured,
                             each.without.holds, each.with.measured, each.with.holds);
    found.lines.push_back(fmt::format("{}: without its remedy it {} ({}); with it, it {} ({})", each.name,
                                      each.without.holds ? "HOLDS" : "fails", each.without.figure,
                                      each.with.holds ? "holds" : "FAILS", each.with.figure));
    found.figures.push_back({each.name, each.picture});
    found.html += fmt::format(
        "<h2>{}</h2>\n<p>{} <span class=\"soft\">({})</span></p>\n<p><strong>Remedy.</strong> {}</p>\n",
        escaped(each.name), escaped(each.what), escaped(each.where), escaped(each.remedy));
    found.html += "<!--" + each.name + "-->\n";
    if (!each.theory.empty()) found.html += "<p><strong>Theory.</strong> " + escaped(each.theory) + "</p>\n";
  }
  if (costs) {
    found.figures.push_back({"control_cost", costs->picture});
    found.html += "<h2>What passivity control costs</h2>\n<!--control_cost-->\n";
    found.json["passivity_control"] = json::array();
    for (const ControlCost& cost : costs->rows) found.json["passivity_control"].push_back(as_json(cost));
  }
  return found;
}

bool behave(const std::vector<NamedCase>& cases) {
  for (const NamedCase& each : cases) {
    if (each.without.holds || !each.with.holds) return false;
  }
  return true;
}

}  // namespace kerf::bench
