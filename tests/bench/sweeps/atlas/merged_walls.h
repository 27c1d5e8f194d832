#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <kerf/schema/sweep_tables.h>

#include "bench/sweeps/swept.h"

namespace kerf::test {

/// Twenty walls as they would be merged: two masses, ten stiffnesses, and numbers that the test gives.
class MergedWalls : public SweepFolder {
 protected:
  struct Numbers {
    double energy = 0.0;
    double lower = 0.0;
    double upper = 0.0;
  };

  /// `cells`: those that have a row; the others failed, where failed.csv says so, or are missing.
  std::filesystem::path merged(const std::vector<std::size_t>& cells,
                               const std::function<Numbers(std::size_t cell)>& numbers) const {
    const bench::PlanFile plan = plan_of(walls());
    const std::filesystem::path folder = file("w.merged");
    std::filesystem::create_directories(folder);
    schema::SweepTablesWriter writer(folder / "sweep.h5");
    writer.describe("plan_sha256", plan.sha256);
    writer.describe("plan", plan.plan.as_json().dump());
    writer.describe("software", "kerf test");
    writer.describe("cells", std::to_string(cells.size()) + " computed");
    writer.add_values("grip", {"none"});
    std::vector<schema::SweepColumn> columns{{.name = "cell", .type = schema::SweepColumn::Type::whole}};
    for (const bench::SweepInput& input : plan.plan.inputs)
      columns.push_back(
          {.name = input.name,
           .unit = input.unit,
           .type = input.is_text() ? schema::SweepColumn::Type::code : schema::SweepColumn::Type::number});
    for (const char* name : {"energy", "lower", "upper"}) columns.push_back({.name = name, .unit = "J"});
    const std::size_t table = writer.add_table("walls", cells.size(), columns);
    for (const std::size_t cell : cells) {
      const bench::SweepCell inputs = plan.plan.cell(cell);
      std::vector<double> row{static_cast<double>(cell)};
      for (const auto& value : inputs.values())
        row.push_back(value && std::holds_alternative<double>(*value) ? std::get<double>(*value) : 0.0);
      const Numbers found = numbers(cell);
      row.insert(row.end(), {found.energy, found.lower, found.upper});
      for (std::size_t i = 0; i < row.size(); ++i) writer.append(table, i, {&row[i], 1});
    }
    writer.commit(schema::Existing::replace);
    return folder;
  }
  /// Says that a cell has failed, with a reason of two lines.
  void fail(std::size_t cell) const {
    write_text(file("w.merged/failed.csv"),
               "cell,name\n" + std::to_string(cell) +
                   ",0123456789abcdef0123456789abcdef,0.1,crashed,\"one line\n5,another\"\n");
  }
  static std::vector<std::size_t> first(std::size_t count) {
    std::vector<std::size_t> cells(count);
    for (std::size_t i = 0; i < count; ++i) cells[i] = i;
    return cells;
  }
};

}  // namespace kerf::test
