#include "experiment/new_experiment.h"

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "experiment/session_log.h"
#include "files/whole_file.h"
#include "registered/assignment.h"
#include "sealed/journal.h"
#include "session/study_folder.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

void tell_assigned(const fs::path& folder, const ExperimentLog::Facts& facts, std::size_t trials,
                   const Protocol& protocol, Context& context) {
  const std::string file = (folder / facts.at("file").get<std::string>()).string();
  const auto participant = facts.at("participant").get<std::string>();
  context.result["sessions"].push_back(
      {{"file", file},
       {"subject", participant},
       {"visit", facts.at("visit")},
       {"replaces", facts.value("replaces", nlohmann::ordered_json(nullptr))},
       {"trials", trials}});
  context.say(fmt::format("{}: participant {}{}, {}{} trials, sealed", file, participant,
                          facts.contains("replaces")
                              ? fmt::format(", in the order of {}", facts.at("replaces").get<std::string>())
                              : std::string(),
                          is_adaptive(protocol.design) ? "at most " : "", trials));
}

/// What stands there is nobody's to replace. @throws std::invalid_argument.
void require_free(const fs::path& file) {
  if (fs::exists(file))
    throw std::invalid_argument(fmt::format(
        "{}: exists already; the sessions of an experiment are made in a folder that has none of their names",
        file.string()));
  require_output(file, false);
}

void register_experiment(const NewExperimentArguments& arguments, const fs::path& file, KeyArguments& key,
                         Context& context) {
  if (fs::exists(log_of(file)))
    throw std::invalid_argument(
        fmt::format("{}: the experiment is registered, and its sessions are made; "
                    "--replaces makes one for whoever takes the place of somebody who left",
                    log_of(file).string()));
  const Experiment experiment = read_experiment(file);
  Protocol protocol = protocol_of(experiment, file);
  arguments.prepare(protocol);
  const std::vector<Assignment> assignments = assignments_of(experiment, protocol, arguments.seed);
  std::vector<std::string> names;
  for (const Assignment& each : assignments) names.push_back(each.file_name(experiment));
  const fs::path folder = fs::absolute(file).parent_path();
  for (const std::string& name : names) require_free(folder / name);
  StudyFolder study(folder, names, false);
  ExperimentLog::Lines lines;
  for (const Assignment& each : assignments) {
    const schema::KeyDerivation derivation = new_derivation(key.key_file.empty());
    lines.emplace_back("assigned",
                       create_assigned(study.path() / each.file_name(experiment), each, experiment, protocol,
                                       new_key_for(key, derivation), derivation));
  }
  const schema::KeyDerivation derivation = new_derivation(key.key_file.empty());
  write_whole_file(log_of(study.path() / "experiment.toml"),
                   ExperimentLog::begun(new_key_for(key, derivation), derivation,
                                        registered_facts(experiment, protocol), lines));
  study.commit();
  for (std::size_t i = 0; i < lines.size(); ++i)
    tell_assigned(file.parent_path(), lines[i].second, assignments[i].plan.size(), protocol, context);
  context.say(
      fmt::format("{}: the plan is registered; what differs from it later is told", log_of(file).string()));
}

/// The order of whoever left, seen by nobody.
void replace_participant(const NewExperimentArguments& arguments, KeyArguments& key, Context& context) {
  OpenedExperiment opened = open_experiment(arguments.experiment, key);
  const Experiment& experiment = opened.state.experiment;
  const std::string code = replacement_code(opened.state, arguments.replaces, arguments.participant);
  const Participant& left = *opened.state.find(arguments.replaces);
  const fs::path folder = opened.file.parent_path();
  for (const AssignedSession& session : left.sessions) {
    if (!session.is_there)
      throw std::invalid_argument(fmt::format(
          "{}: the session of {} is missing, and with it the order that {} would take; put it back",
          session.file.string(), left.code, code));
  }
  std::vector<std::pair<ExperimentLog::Facts, std::size_t>> made;
  for (const AssignedSession& session : left.sessions) {
    const SessionStore store(session.file, key_for(key, derivation_of(session.file)),
                             SessionStore::Purpose::read);
    const Assignment assignment{.participant = code,
                                .group = left.group,
                                .number = left.number,
                                .visit = session.visit,
                                .replaces = left.code,
                                .plan = store.plan()};
    const fs::path file = folder / assignment.file_name(experiment);
    require_free(file);
    const schema::KeyDerivation derivation = new_derivation(key.key_file.empty());
    made.emplace_back(create_assigned(file, assignment, experiment, store.protocol(),
                                      new_key_for(key, derivation), derivation),
                      assignment.plan.size());
    opened.log.append("assigned", made.back().first);
    tell_assigned(folder, made.back().first, made.back().second, store.protocol(), context);
  }
}

}  // namespace

void make_experiment(const NewExperimentArguments& arguments, KeyArguments& key, Context& context) {
  context.result = {{"experiment", arguments.experiment}, {"sessions", nlohmann::ordered_json::array()}};
  if (!arguments.replaces.empty()) {
    replace_participant(arguments, key, context);
  } else {
    register_experiment(arguments, experiment_file(arguments.experiment), key, context);
  }
}

}  // namespace kerf::bench
