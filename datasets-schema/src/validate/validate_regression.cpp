#include <cmath>

#include "in_process.h"
#include "layout/regression_layout.h"
#include "validate/validators.h"

namespace kerf::schema {
namespace {

void check_force(TreeCheck& tree, const std::string& path) {
  const auto extent = tree.extent_of(path, "float64", 2);
  if (!extent) return;
  if ((*extent)[1] == 0) return tree.fail(path, "no column", "one an axis");
  for (const char* name : {"channels", "units"}) {
    static_cast<void>(tree.has_attribute(path, {.name = name, .type = "text", .list = (*extent)[1]}));
  }
  tree.only_attributes(path, {"channels", "units"});
}

void check_case(TreeCheck& tree, const std::string& name) {
  const std::string path = group_of_cases + '/' + name;
  if (!tree.has_group(path)) return;
  std::vector<std::string_view> known{"faults", "tick_cost", "tick_cost_build", "renderer", "made_with"};
  for (const CaseText& text : texts_of_a_case) {
    known.emplace_back(text.name);
    static_cast<void>(tree.has_attribute(path, {.name = text.name, .type = "text", .fatal = false}));
  }
  static_cast<void>(tree.has_attribute(path, {.name = "faults", .type = "uint64", .fatal = false}));
  static_cast<void>(
      tree.has_attribute(path, {.name = "renderer", .type = "text", .required = false, .fatal = false}));
  static_cast<void>(
      tree.has_attribute(path, {.name = "made_with", .type = "text", .required = false, .fatal = false}));
  const bool timed =
      tree.has_attribute(path, {.name = "tick_cost", .type = "float64", .required = false, .fatal = false});
  static_cast<void>(tree.has_attribute(
      path, {.name = "tick_cost_build", .type = "text", .required = timed, .fatal = false}));
  tree.only_attributes(path, known);
  tree.only_children(path, {"force", "compute_time"});
  check_force(tree, path + "/force");
  const std::string times = path + "/compute_time";
  if (!h5::is_dataset(tree.file(), times) || !tree.extent_of(times, "float64", 1)) return;
  static_cast<void>(tree.has_attribute(times, {.name = "of", .type = "text", .fatal = false}));
  tree.only_attributes(times, {"of"});
}

void check_trajectory(TreeCheck& tree, const std::string& sha256) {
  const std::string path = group_of_trajectories + '/' + sha256;
  if (!tree.has_group(path)) return;
  const auto rows = tree.extent_of(path + "/time", "float64", 1);
  const auto extent = tree.extent_of(path + "/position", "float64", 2);
  if (!rows || !extent) return;
  if ((*extent)[0] != (*rows)[0])
    return tree.fail(path, "other numbers of rows in 'time' and 'position'", "one row a tick");
  for (const char* name : {"axes", "units"})
    static_cast<void>(tree.has_attribute(path, {.name = name, .type = "text", .list = (*extent)[1]}));
  tree.only_attributes(path, {"axes", "units"});
  tree.only_children(path, {"time", "position"});
}

void check_content(const StoredForces& one, std::vector<Violation>& violations) {
  const std::string path = group_of_cases + '/' + one.name;
  if (!one.date.empty() && !is_utc_time(one.date)) {
    violations.push_back(
        {path + " attribute 'date'", '\'' + one.date + '\'', std::string(expected_utc_time)});
  }
  for (const ForceChannel& channel : one.channels) {
    if (channel.unit == "N" || channel.unit == "N·m") continue;
    violations.push_back({path + "/force attribute 'units'", '\'' + channel.unit + '\'', "'N' or 'N·m'"});
  }
  for (std::size_t i = 0; i < one.force.size(); ++i) {
    if (std::isfinite(one.force[i])) continue;
    violations.push_back({path + "/force",
                          "no finite number in row " + std::to_string(i / one.channels.size()),
                          "finite forces"});
    return;
  }
}

}  // namespace

void validate_regression(const std::filesystem::path& file, std::vector<Violation>& violations) {
  {
    TreeCheck tree(file);
    if (tree.is(regression_schema_name, regression_schema_version)) {
      tree.only_attributes("/", {"schema", "schema_version"});
      tree.only_children("/", {"cases", "trajectories"});
      if (h5::is_group(tree.file(), group_of_trajectories)) {
        for (const std::string& sha256 : h5::children(h5::open(tree.file(), group_of_trajectories).id()))
          check_trajectory(tree, sha256);
      }
      if (tree.has_group(group_of_cases)) {
        tree.only_attributes(group_of_cases, {});
        const auto names = h5::children(h5::open(tree.file(), group_of_cases).id());
        for (const std::string& name : names) check_case(tree, name);
      }
    }
    for (const Finding& finding : tree.findings()) violations.push_back(finding.violation);
    if (tree.first_fatal() != nullptr) return;
  }
  for (const StoredForces& one : in_process::read_regression(file)) check_content(one, violations);
}

}  // namespace kerf::schema
