#pragma once

#include <array>
#include <filesystem>

#include <kerf/schema/sweep_tables.h>

namespace kerf::test {

/// Two tables of a sweep over recordings and seeds.
inline void write_sample_sweep(const std::filesystem::path& file) {
  using Type = schema::SweepColumn::Type;
  schema::SweepTablesWriter writer(file);
  writer.describe("plan_sha256", "12ab");
  writer.describe("plan", R"({"verb": "fit"})");
  writer.describe("software", "kerf 0.1.0");
  writer.describe("cells", "4 computed, 1 failed, 0 missing");
  writer.add_values("recording", {"a.h5", "b.h5"});
  const std::array<double, 3> cells{0.0, 1.0, 4.0};
  const std::array<double, 3> codes{0.0, 0.0, 1.0};
  const std::array<double, 3> stiffness{300.0, 301.5, 299.0};
  const auto kelvin = writer.add_table("kelvin", cells.size(),
                                       {{.name = "cell", .type = Type::whole},
                                        {.name = "recording", .type = Type::code},
                                        {.name = "stiffness", .unit = "N/m"}});
  writer.append(kelvin, 0, cells);
  writer.append(kelvin, 1, codes);
  writer.append(kelvin, 2, stiffness);
  const auto other = writer.add_table("other", 1, {{.name = "cell", .type = Type::whole}});
  writer.append(other, 0, std::array{2.0});
  writer.commit(schema::Existing::replace);
}

}  // namespace kerf::test
