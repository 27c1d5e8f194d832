#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "plan/sweep_plan.h"

namespace kerf::bench {

/// A column of what comes out of cells.
struct CellColumn {
  std::string name;
  std::string unit = "1";
  friend bool operator==(const CellColumn&, const CellColumn&) = default;
};

/// What came of a cell: a row of numbers in a table. NaN is what is not known.
struct CellNumbers {
  std::string table;
  std::vector<CellColumn> columns;
  std::vector<double> values;

  void add(std::string name, std::string unit, double value) {
    columns.push_back({.name = std::move(name), .unit = std::move(unit)});
    values.push_back(value);
  }
};

/// Computes cells, one after the other, in a worker. What several cells need it keeps.
class CellWork {
 public:
  CellWork() = default;
  CellWork(const CellWork&) = delete;
  CellWork& operator=(const CellWork&) = delete;
  virtual ~CellWork() = default;
  /// A pure function of the cell.
  /// @throws std::invalid_argument for a cell that has no answer, in one line that says why.
  [[nodiscard]] virtual CellNumbers compute(const SweepCell& cell) = 0;
};

/// A verb that a sweep runs: what it takes, and what works on its cells. Each stands in a file of its own.
struct SweepVerb {
  std::string_view name;
  std::string_view what;
  /// The last one changes fastest in a product; what is a file stands first, if anything is.
  std::vector<SweepInput> (*inputs)();
  std::unique_ptr<CellWork> (*begin)(const SweepPlan& plan);
};

extern const SweepVerb sweep_of_checks;
extern const SweepVerb sweep_of_choices;
extern const SweepVerb sweep_of_fits;
extern const SweepVerb sweep_of_identify;
extern const SweepVerb sweep_of_regressions;
extern const SweepVerb sweep_of_stability;

/// Verbs that plans may name.
using SweepVerbs = std::span<const SweepVerb* const>;
/// Those of this room. Who sees other rooms too hands in theirs beside them.
[[nodiscard]] SweepVerbs sweep_verbs();
/// @throws std::invalid_argument that lists them.
[[nodiscard]] const SweepVerb& sweep_verb_called(std::string_view name, SweepVerbs verbs);

}  // namespace kerf::bench
