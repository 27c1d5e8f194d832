#include "regress/stored_facts.h"

#include <cmath>

#include <fmt/core.h>

namespace kerf::bench {
namespace {

using Json = nlohmann::ordered_json;

Json facts_of(const schema::StoredForces& one) {
  Json facts{{"name", one.name},     {"model", one.model},        {"reason", one.reason},
             {"date", one.date},     {"software", one.software},  {"ticks", one.rows()},
             {"faults", one.faults}, {"channels", Json::object()}};
  const std::size_t channels = one.channels.size();
  for (std::size_t channel = 0; channel < channels; ++channel) {
    double peak = 0.0;
    for (std::size_t i = channel; i < one.force.size(); i += channels) {
      peak = std::max(peak, std::abs(one.force[i]));
    }
    facts["channels"][one.channels[channel].name] = {{"unit", one.channels[channel].unit}, {"peak", peak}};
  }
  if (one.tick_cost) facts["tick_cost"] = *one.tick_cost;
  return facts;
}

}  // namespace

Json stored_facts(const std::vector<schema::StoredForces>& cases) {
  Json facts{{"schema", schema::regression_schema_name},
             {"schema_version", schema::regression_schema_version},
             {"cases", Json::array()},
             {"warnings", Json::array()}};
  for (const schema::StoredForces& one : cases) facts["cases"].push_back(facts_of(one));
  return facts;
}

std::string stored_facts_table(const Json& facts) {
  std::string table =
      fmt::format("{:<32}{:<16}{:>8}  {:<22}{}\n", "case", "model", "ticks", "stored", "reason");
  for (const Json& one : facts["cases"]) {
    table += fmt::format("{:<32}{:<16}{:>8}  {:<22}{}\n", one["name"].get<std::string>(),
                         one["model"].get<std::string>(), one["ticks"].get<std::size_t>(),
                         one["date"].get<std::string>(), one["reason"].get<std::string>());
  }
  table.pop_back();
  return table;
}

}  // namespace kerf::bench
