#include "registered/assignment.h"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

#include <kerf/psychophysics/random.h>

namespace kerf::bench {

std::string code_of(std::size_t number, std::size_t subjects) {
  const std::size_t digits = std::max<std::size_t>(2, std::to_string(subjects).size());
  return fmt::format("S{:0{}}", number, digits);
}

std::string Assignment::file_name(const Experiment& experiment) const {
  if (experiment.participants.visits == 1) return participant + ".h5";
  return fmt::format("{}-{}.h5", participant, visit);
}

std::vector<Assignment> assignments_of(const Experiment& experiment, const Protocol& protocol,
                                       std::uint64_t seed) {
  const ParticipantPlan& people = experiment.participants;
  const std::size_t groups = std::max<std::size_t>(1, people.groups.size());
  const std::size_t each = people.target / groups;
  psychophysics::Random random(seed);
  std::vector<Assignment> assignments;
  for (std::size_t visit = 1; visit <= people.visits; ++visit) {
    for (std::size_t group = 0; group < groups; ++group) {
      std::vector<Plan> plans = make_plans(protocol, each, random.below(SIZE_MAX));
      for (std::size_t i = 0; i < each; ++i) {
        const std::size_t number = group * each + i + 1;
        assignments.push_back({.participant = code_of(number, people.target),
                               .group = people.groups.empty() ? std::string() : people.groups[group],
                               .number = number,
                               .visit = visit,
                               .plan = std::move(plans[i])});
      }
    }
  }
  return assignments;
}

ExperimentLog::Facts create_assigned(const std::filesystem::path& file, const Assignment& assignment,
                                     const Experiment& experiment, const Protocol& protocol,
                                     const SealKey& key, const schema::KeyDerivation& derivation) {
  SessionStore::create(file,
                       {.protocol = protocol,
                        .subject = assignment.participant,
                        .number = assignment.number,
                        .subjects = experiment.participants.target,
                        .plan = assignment.plan},
                       key, derivation, false);
  SessionStore store(file, key, SessionStore::Purpose::run);
  store.note("registered", to_entry({.experiment = digest_of(experiment.toml),
                                     .participant = assignment.participant,
                                     .visit = assignment.visit}));
  ExperimentLog::Facts facts{
      {"participant", assignment.participant}, {"number", assignment.number}, {"visit", assignment.visit}};
  if (!assignment.group.empty()) facts["group"] = assignment.group;
  if (!assignment.replaces.empty()) facts["replaces"] = assignment.replaces;
  facts["file"] = assignment.file_name(experiment);
  facts["session"] = store.session().uuid;
  store.close();
  return facts;
}

ExperimentLog::Facts registered_facts(const Experiment& experiment, const Protocol& protocol) {
  ExperimentLog::Facts laws = ExperimentLog::Facts::object();
  for (const SessionSample& sample : protocol.samples) laws[sample.law_name] = digest_of(sample.law_toml);
  return {{"experiment", experiment.toml}, {"protocol", digest_of(protocol.toml)}, {"laws", std::move(laws)}};
}

std::string replacement_code(const ExperimentState& state, const std::string& leaving,
                             const std::string& code) {
  const auto refuse = [](const std::string& what) { throw std::invalid_argument(what); };
  const Participant* left = state.find(leaving);
  if (left == nullptr)
    refuse(fmt::format("--replaces: there is no participant {} in this experiment", leaving));
  if (!left->is_out())
    refuse(fmt::format("--replaces: {} takes part; 'kerf session drop' says who left, and why", leaving));
  if (!left->replaced_by.empty())
    refuse(fmt::format("--replaces: {} was replaced by {} already", leaving, left->replaced_by));
  const ReplacementRule rule = state.experiment.participants.replace;
  const bool may =
      left->dropped ? rule != ReplacementRule::never : rule == ReplacementRule::dropped_or_excluded;
  if (!may)
    refuse(fmt::format("--replaces: {} was {}, and the registered rule is replace = \"{}\"", leaving,
                       left->dropped ? "dropped" : "excluded", name_of(rule)));
  if (!code.empty()) {
    if (state.find(code) != nullptr)
      refuse(
          fmt::format("--subject: the code {} is taken in this experiment; nobody takes part twice", code));
    return code;
  }
  std::size_t number = state.participants.size() + 1;
  while (state.find(code_of(number, state.experiment.participants.target)) != nullptr) ++number;
  return code_of(number, state.experiment.participants.target);
}

}  // namespace kerf::bench
