#include "merge/merged_facts.h"

#include <algorithm>

#include <fmt/format.h>

namespace kerf::bench {
namespace {

using Json = nlohmann::ordered_json;

std::string_view name_of(schema::SweepColumn::Type type) {
  switch (type) {
    case schema::SweepColumn::Type::whole:
      return "whole number";
    case schema::SweepColumn::Type::code:
      return "text";
    case schema::SweepColumn::Type::number:
      break;
  }
  return "number";
}

/// Of the plan within; null where it is none.
Json verb_of(const std::string& plan) {
  const Json all = Json::parse(plan, nullptr, false);
  return all.is_object() && all.contains("verb") ? all["verb"] : Json(nullptr);
}

Json facts_of(const schema::SweepTable& table) {
  Json columns = Json::array();
  for (const schema::SweepColumn& column : table.columns)
    columns.push_back({{"name", column.name}, {"unit", column.unit}, {"type", name_of(column.type)}});
  return {{"name", table.name}, {"rows", table.rows}, {"columns", std::move(columns)}};
}

}  // namespace

Json merged_facts(const schema::SweepTablesFacts& facts) {
  Json tables = Json::array();
  for (const schema::SweepTable& table : facts.tables) tables.push_back(facts_of(table));
  Json texts = Json::object();
  for (const auto& [input, all] : facts.texts) texts[input] = all.size();
  return {{"schema", schema::sweep_tables_name},
          {"schema_version", schema::sweep_tables_version},
          {"verb", verb_of(facts.plan)},
          {"cells", facts.cells},
          {"plan_sha256", facts.plan_sha256},
          {"software", facts.software},
          {"tables", std::move(tables)},
          {"texts", std::move(texts)},
          {"warnings", Json::array()}};
}

std::string merged_facts_table(const Json& facts) {
  std::string lines =
      fmt::format("a sweep of '{}': {}\n", facts["verb"].is_string() ? facts["verb"].get<std::string>() : "?",
                  facts["cells"].get<std::string>());
  lines += fmt::format("  plan {}, computed by {}\n", facts["plan_sha256"].get<std::string>(),
                       facts["software"].get<std::string>());
  for (const Json& table : facts["tables"]) {
    lines +=
        fmt::format("  {}: {} rows of", table["name"].get<std::string>(), table["rows"].get<std::uint64_t>());
    for (const Json& column : table["columns"]) {
      const auto unit = column["unit"].get<std::string>();
      lines += fmt::format("{} {}{}", &column == &table["columns"].front() ? "" : ",",
                           column["name"].get<std::string>(), unit == "1" ? "" : " [" + unit + "]");
    }
    lines += '\n';
  }
  lines.pop_back();
  return lines;
}

}  // namespace kerf::bench
