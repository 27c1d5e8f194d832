// Simulated drawers with a known truth: kerf_population_study coverage|alarms|power STUDIES prints a line of
// JSON a cell.
#include <cstdio>
#include <cstdlib>
#include <string>

#include "fitting/population/drawer.h"

namespace {

using namespace kerf::population;

struct Cell {
  std::string name;
  Drawer drawer;
};

Drawer drawer_of(double between, int specimens) {
  Drawer drawer;
  drawer.between = {between, between, between};
  drawer.specimens = {specimens, specimens, specimens};
  return drawer;
}

std::vector<Cell> coverage_cells() {
  std::vector<Cell> cells;
  for (const double between : {0.0, 0.1, 0.3}) {
    for (const int specimens : {2, 3, 5, 8})
      cells.push_back({"2 to 4 recordings", drawer_of(between, specimens)});
  }
  for (const double between : {0.0, 0.1, 0.3}) {
    Drawer uneven = drawer_of(between, 5);
    uneven.recordings = {1, 8, 2, 1, 6};
    cells.push_back({"1 to 8 recordings", uneven});
    Drawer rough = drawer_of(between, 5);
    rough.error = 0.2;
    cells.push_back({"errors of 0.2", rough});
    Drawer once = drawer_of(between, 5);
    once.recordings = {1};
    cells.push_back({"1 recording each", once});
  }
  Drawer unlike = drawer_of(0.1, 3);
  unlike.between = {0.3, 0.05, 0.1};
  unlike.specimens = {3, 8, 5};
  cells.push_back({"3 specimens beside 8 of a sixth of the spread", unlike});
  return cells;
}

void print_coverage(const Cell& cell, const Held& held) {
  std::printf(
      "{\"cell\": \"%s\", \"between\": %g, \"specimens\": %d, \"trials\": %d, \"mean\": %d, "
      "\"between_held\": %d, "
      "\"within\": %d, \"next\": %d, \"tissues\": %d, \"speeds\": %d, \"has_within\": %s}\n",
      cell.name.c_str(), cell.drawer.between[0], cell.drawer.specimens[0], held.studies, held.mean,
      held.between, held.within, held.next, held.tissues, held.speeds,
      cell.drawer.recordings.size() > 1 ? "true" : "false");
}

void tell(const std::string& name, const Drawer& drawer, int studies, const CompareOptions& options = {}) {
  const Found f = found(drawer, studies, 7, options);
  std::printf(
      "{\"cell\": \"%s\", \"between\": %g, \"specimens\": %d, \"trials\": %d, \"any\": %d, \"tissues\": %d, "
      "\"speeds\": %d, \"told_tissues\": %d, \"told_speeds\": %d, \"cannot\": %d}\n",
      name.c_str(), drawer.between[0], drawer.specimens[0], studies, f.any, f.tissues, f.speeds,
      f.told_tissues, f.told_speeds, f.cannot_be_told);
  std::fflush(stdout);
}

/// Fewer permutations than a study tries: the rates are the same, for an eighth of the time.
CompareOptions quick() {
  CompareOptions options;
  options.draws = 999;
  options.most_exact = 1000;
  return options;
}

void alarms(int studies) {
  const CompareOptions options = quick();
  CompareOptions groups = options;
  groups.exchanges_recordings = false;
  for (const double between : {0.0, 0.1, 0.3}) {
    for (const int specimens : {3, 5, 8})
      tell("nothing differs", drawer_of(between, specimens), studies, options);
  }
  Drawer reacting = drawer_of(0.1, 8);
  reacting.interaction = 0.1;
  tell("specimens react to speed by sd 0.1, its mean 0", reacting, studies, options);
  tell("the same, whole groups exchanged", reacting, studies, groups);
  Drawer unlike = drawer_of(0.1, 5);
  unlike.between = {0.3, 0.05, 0.1};
  unlike.specimens = {3, 8, 5};
  tell("3 specimens beside 8 of a sixth of the spread", unlike, studies, options);
}

void power(int studies) {
  for (const double ratio : {1.2, 1.5, 2.0}) {
    for (const double between : {0.1, 0.3}) {
      for (const int specimens : {5, 8}) {
        Drawer drawer = drawer_of(between, specimens);
        drawer.tissues = {std::log(ratio), 0.0, 0.0};
        drawer.speed = std::log(ratio);
        char name[32];
        std::snprintf(name, sizeof name, "ratio %.1f", ratio);
        tell(name, drawer, studies, quick());
      }
    }
  }
}

}  // namespace

int main(int count, char** arguments) {
  const std::string what = count > 2 ? arguments[1] : "";
  const int studies = count > 2 ? std::atoi(arguments[2]) : 0;
  if (studies < 1 || (what != "coverage" && what != "alarms" && what != "power")) {
    std::fputs("usage: kerf_population_study coverage|alarms|power STUDIES\n", stderr);
    return 2;
  }
  if (what == "alarms") alarms(studies);
  if (what == "power") power(studies);
  if (what != "coverage") return 0;
  std::uint64_t seed = 100;
  for (const Cell& cell : coverage_cells()) {
    print_coverage(cell, coverage(cell.drawer, studies, ++seed));
    std::fflush(stdout);
  }
  return 0;
}
