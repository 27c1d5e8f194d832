#include "registered/experiment.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "files/named_file.h"
#include "protocol/protocol_parts.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;
using psychophysics::SpendingFunction;

constexpr const char* file_name = "experiment.toml";
constexpr double most_participants = 1000.0;
constexpr std::size_t most_texts = 50;
using ReplacementWord = std::pair<std::string_view, ReplacementRule>;
constexpr std::array replacement_words{
    ReplacementWord{"never", ReplacementRule::never}, ReplacementWord{"dropped", ReplacementRule::dropped},
    ReplacementWord{"dropped-or-excluded", ReplacementRule::dropped_or_excluded}};

/// Different texts of one line.
std::vector<std::string> read_texts(const Place& place, const toml::table& table, std::string_view key) {
  std::vector<std::string> texts;
  const toml::node* node = table.get(key);
  if (node == nullptr) return texts;
  const toml::array* all = node->as_array();
  if (all == nullptr || all->size() > most_texts || (!all->empty() && !all->is_homogeneous<std::string>()))
    place.refuse(*node, "'{}' must be an array of at most {} texts, such as [\"one\", \"two\"]", key,
                 most_texts);
  for (const toml::node& each : *all) {
    const toml::table one{{"name", **each.as_string()}};
    try {
      texts.push_back(read_name(Place("it"), one, "one of them"));
    } catch (const std::invalid_argument& error) {
      place.refuse(each, "'{}': {}", key, error.what());
    }
    if (std::ranges::count(texts, texts.back()) > 1)
      place.refuse(each, "'{}' names {:?} twice", key, texts.back());
  }
  return texts;
}

std::optional<double> read_optional(const Place& place, const toml::table& table, PlainNumber about) {
  if (!table.contains(about.key)) return std::nullopt;
  return read_plain_number(place, table, about);
}

ParticipantPlan read_participants(const Place& place, const toml::table& root) {
  if (!root.contains("participants"))
    place.refuse(root, "an experiment needs a table [participants] with their number, 'target'");
  const toml::table& table = place.table(root, "participants");
  place.allow_only(table, {"target", "visits", "groups", "replace"}, "[participants]");
  if (!table.contains("target")) place.refuse(table, "[participants] needs 'target', how many are analysed");
  ParticipantPlan plan;
  plan.target = read_count(place, table, {.key = "target", .lower = 1.0, .upper = most_participants});
  plan.visits = read_count(place, table, {.key = "visits", .standard = 1.0, .lower = 1.0, .upper = 20.0});
  plan.groups = read_texts(place, table, "groups");
  if (!plan.groups.empty() && plan.target % plan.groups.size() != 0)
    place.refuse(*table.get("target"), "'target' is {}, expected a multiple of the {} groups", plan.target,
                 plan.groups.size());
  plan.replace = read_choice(place, table, "replace", plan.replace,
                             {replacement_words[0], replacement_words[1], replacement_words[2]});
  return plan;
}

void read_looks(const Place& place, const toml::table& table, std::size_t target, StoppingRule& rule) {
  const toml::node* node = table.get("looks");
  if (node == nullptr) return;
  const toml::array* all = node->as_array();
  if (all == nullptr)
    place.refuse(*node, "'looks' must be an array of numbers of participants, such as [6, 9]");
  for (const toml::node& each : *all) {
    const double at = place.number(each, "a look");
    const double before = rule.looks.empty() ? 0.0 : static_cast<double>(rule.looks.back());
    if (at != std::floor(at) || at <= before || at >= static_cast<double>(target))
      place.refuse(each,
                   "a look at {:g} participants cannot be; expected whole numbers that ascend, below the "
                   "target of {}, which is the last look",
                   at, target);
    rule.looks.push_back(static_cast<std::size_t>(at));
  }
}

StoppingRule read_stopping(const Place& place, const toml::table& analysis, std::size_t target) {
  StoppingRule rule;
  if (!analysis.contains("stopping")) return rule;
  const toml::table& table = place.table(analysis, "stopping");
  place.allow_only(table, {"rule", "spending", "looks", "evidence"}, "[analysis.stopping]");
  rule.kind = read_choice(place, table, "rule", rule.kind,
                          {{"fixed", StoppingKind::fixed},
                           {"alpha-spending", StoppingKind::alpha_spending},
                           {"bayes-factor", StoppingKind::bayes_factor}});
  const auto only_for = [&](const char* key, bool holds, const char* whom) {
    if (table.contains(key) && !holds)
      place.refuse(*table.get(key), "'{}' is for the rule {}, and this is \"{}\"", key, whom,
                   name_of(rule.kind));
  };
  only_for("spending", rule.kind == StoppingKind::alpha_spending, "\"alpha-spending\"");
  only_for("evidence", rule.kind == StoppingKind::bayes_factor, "\"bayes-factor\"");
  only_for("looks", rule.kind != StoppingKind::fixed, "\"alpha-spending\" or \"bayes-factor\"");
  rule.spending = read_choice(
      place, table, "spending", rule.spending,
      {{"obrien-fleming", SpendingFunction::obrien_fleming}, {"pocock", SpendingFunction::pocock}});
  rule.evidence = read_plain_number(
      place, table, {.key = "evidence", .standard = rule.evidence, .lower = 1.5, .upper = 1e6});
  read_looks(place, table, target, rule);
  if (rule.kind != StoppingKind::fixed && rule.looks.empty())
    place.refuse(table, "the rule \"{}\" needs 'looks', numbers of participants below the target of {}",
                 name_of(rule.kind), target);
  return rule;
}

void read_margins(const Place& place, const toml::table& table, AnalysisPlan& plan) {
  plan.margin = read_optional(place, table, {.key = "margin", .lower = 0.001, .upper = 0.5});
  plan.d_prime = read_optional(place, table, {.key = "d_prime", .lower = 0.01, .upper = 10.0});
  const toml::node* node = table.get("jnd_margins");
  if (node == nullptr) return;
  const toml::array* both = node->as_array();
  if (both == nullptr || both->size() != 2)
    place.refuse(*node, "'jnd_margins' must be two numbers, such as [0.05, 0.2]");
  const psychophysics::Interval margins{.lower = place.number((*both)[0], "the lower margin"),
                                        .upper = place.number((*both)[1], "the upper margin")};
  if (!(margins.lower >= 0.0 && margins.lower < margins.upper && std::isfinite(margins.upper)))
    place.refuse(*node, "'jnd_margins' are {:g} and {:g}, expected 0 or more and the larger one last",
                 margins.lower, margins.upper);
  plan.jnd_margins = margins;
}

AnalysisPlan read_analysis(const Place& place, const toml::table& root, std::size_t target) {
  AnalysisPlan plan;
  if (!root.contains("analysis")) return plan;
  const toml::table& table = place.table(root, "analysis");
  place.allow_only(table, {"test", "alpha", "margin", "d_prime", "jnd_margins", "exclude", "stopping"},
                   "[analysis]");
  plan.test =
      read_choice(place, table, "test", plan.test,
                  {{"difference", PrimaryTest::difference}, {"equivalence", PrimaryTest::equivalence}});
  plan.alpha =
      read_plain_number(place, table, {.key = "alpha", .standard = plan.alpha, .lower = 0.001, .upper = 0.2});
  read_margins(place, table, plan);
  if (table.contains("exclude")) {
    const toml::table& exclude = place.table(table, "exclude");
    place.allow_only(exclude, {"faulty", "unfelt", "catch_right", "rules"}, "[analysis.exclude]");
    plan.exclude.faulty = read_optional(place, exclude, {.key = "faulty", .lower = 0.0, .upper = 1.0});
    plan.exclude.unfelt = read_optional(place, exclude, {.key = "unfelt", .lower = 0.0, .upper = 1.0});
    plan.exclude.catch_right =
        read_optional(place, exclude, {.key = "catch_right", .lower = 0.0, .upper = 1.0});
    plan.exclude.rules = read_texts(place, exclude, "rules");
  }
  plan.stopping = read_stopping(place, table, target);
  return plan;
}

}  // namespace

std::vector<std::size_t> Experiment::planned_looks() const {
  std::vector<std::size_t> looks = analysis.stopping.looks;
  looks.push_back(participants.target);
  return looks;
}

fs::path experiment_file(const fs::path& file_or_folder) {
  std::error_code ignored;
  const fs::path file =
      fs::is_directory(file_or_folder, ignored) ? file_or_folder / file_name : file_or_folder;
  if (!fs::exists(file, ignored))
    throw std::invalid_argument(
        fmt::format("{}: there is no such file; 'kerf session plan PROTOCOL -o {}' begins an experiment",
                    file.string(), file.string()));
  return file;
}

bool is_experiment(const fs::path& file_or_folder) {
  std::error_code ignored;
  return file_or_folder.filename().string().ends_with(file_name) || fs::is_directory(file_or_folder, ignored);
}

Experiment parse_experiment(const std::string& text, const std::string& name) {
  const toml::table root = parse_toml(text, name);
  const Place place(name);
  place.allow_only(root, {"name", "protocol", "participants", "analysis"}, "an experiment");
  Experiment experiment;
  experiment.toml = text;
  experiment.name = read_name(place, root, "an experiment");
  experiment.protocol = read_plain_text(place, root, "protocol");
  if (experiment.protocol.empty())
    place.refuse(node_or_table(root, "protocol"),
                 "an experiment needs a 'protocol', such as \"abx.protocol.toml\"");
  experiment.participants = read_participants(place, root);
  experiment.analysis = read_analysis(place, root, experiment.participants.target);
  return experiment;
}

Experiment read_experiment(const fs::path& file) {
  return parse_experiment(read_named_file(file), file.string());
}

Protocol protocol_of(const Experiment& experiment, const fs::path& file) {
  Protocol protocol = read_protocol((file.parent_path() / experiment.protocol).lexically_normal());
  require_fits(experiment, protocol, file.string());
  return protocol;
}

bool is_two_sided(const Protocol& protocol, PrimaryTest test) noexcept {
  return test == PrimaryTest::difference &&
         (protocol.design == Design::preference || asks_numbers(protocol.design));
}

std::string_view name_of(PrimaryTest test) noexcept {
  return test == PrimaryTest::difference ? "difference" : "equivalence";
}

std::string_view name_of(StoppingKind kind) noexcept {
  if (kind == StoppingKind::fixed) return "fixed";
  return kind == StoppingKind::alpha_spending ? "alpha-spending" : "bayes-factor";
}

std::string_view name_of(SpendingFunction function) noexcept {
  return function == SpendingFunction::pocock ? "pocock" : "obrien-fleming";
}

std::string_view name_of(ReplacementRule rule) noexcept {
  return replacement_words[static_cast<std::size_t>(rule)].first;
}

}  // namespace kerf::bench
