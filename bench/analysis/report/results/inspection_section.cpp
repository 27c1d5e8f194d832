#include <string>
#include <vector>

#include "html/html.h"
#include "report/fit_view.h"
#include "report/results/sections.h"

namespace kerf::bench {
namespace {

using json = nlohmann::ordered_json;

/// "yes", "no", or that nobody knows.
std::string known(const json& value) {
  return value.is_boolean() ? (value.get<bool>() ? "yes" : "no") : "not known";
}

/// At which ends of its range a signal is clipped.
std::string clipped_ends(const json& signal) {
  std::string ends;
  bool all_known = true;
  for (const auto& [end, name] : {std::pair{"least", "low"}, std::pair{"most", "high"}}) {
    const json& clipped = signal.at(end).at("clipped");
    all_known = all_known && clipped.is_boolean();
    if (clipped == true) ends += (ends.empty() ? "" : ", ") + std::string(name);
  }
  return !ends.empty() ? ends : all_known ? "no" : "not known";
}

std::string signal_table(const json& signals) {
  std::vector<std::vector<std::string>> rows{{"signal", "unit", "quantum", "noise", "rows at 0", "dead zone",
                                              "clipped", "single rows that stand out"}};
  for (const auto& [name, value] : signals.items()) {
    const json& signal = value;
    rows.push_back({name, signal.at("unit").get<std::string>(), number_text(signal.at("quantum")),
                    number_text(signal.at("noise")), number_text(signal.at("zeros").at("rows"), "{:.0f}"),
                    signal.contains("dead_zone") ? known(signal.at("dead_zone")) : "", clipped_ends(signal),
                    number_text(signal.at("outliers"), "{:.0f}")});
  }
  return html_table(rows);
}

}  // namespace

std::string inspection_section(const FoundResult& result) {
  const json& inspection = result.json;
  std::string html = "<h2>What it is worth</h2>\n" + whose(result);
  for (const json& warning : inspection.at("warnings"))
    html += "<p>" + escaped(warning.get<std::string>()) + ".</p>\n";
  return html + signal_table(inspection.at("signals"));
}

}  // namespace kerf::bench
