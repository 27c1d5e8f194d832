#include "registered/experiment_state.h"

#include <algorithm>
#include <charconv>
#include <map>
#include <span>
#include <stdexcept>

#include <fmt/format.h>

#include "sealed/session_facts.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// A session file of the folder.
struct FoundSession {
  fs::path file;
  Json facts;
};

std::vector<FoundSession> sessions_in(const fs::path& folder, std::vector<std::string>& problems,
                                      const std::vector<std::string>& expected) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder.empty() ? fs::path(".") : folder)) {
    if (entry.path().extension() == ".h5" && entry.is_regular_file())
      files.push_back(folder / entry.path().filename());
  }
  std::ranges::sort(files);
  std::vector<FoundSession> found;
  for (const fs::path& file : files) {
    try {
      found.push_back({.file = file, .facts = session_facts(file)});
    } catch (const std::exception& error) {
      // What is no session is none of ours, unless it has the name of one.
      if (std::ranges::count(expected, file.filename().string()) != 0) problems.emplace_back(error.what());
    }
  }
  return found;
}

bool has_entry(const Json& facts, std::string_view kind) {
  return std::ranges::any_of(facts["entries"], [&](const Json& entry) { return entry["kind"] == kind; });
}

void take_facts(const FoundSession& found, AssignedSession& session) {
  session.file = found.file;
  session.is_there = true;
  session.begun = has_entry(found.facts, "run") || has_entry(found.facts, "rehearsal");
  session.rehearsed = has_entry(found.facts, "rehearsal");
  session.finished = found.facts["finished"].get<bool>();
  session.trials = found.facts["trials"].get<std::size_t>();
}

/// Of those that were noted in a session while it was still to come; 0: none.
std::size_t last_look_in(const Json& facts) {
  std::size_t last = 0;
  for (const Json& entry : facts["entries"]) {
    const auto text = entry["text"].get<std::string>();
    if (entry["kind"] != "look" || !text.starts_with("look ")) continue;
    std::size_t number = 0;
    std::from_chars(text.data() + 5, text.data() + text.size(), number);
    last = std::max(last, number);
  }
  return last;
}

std::string name_in(const fs::path& file) { return file.filename().string(); }

/// What the log says, line by line.
class LogReader {
 public:
  LogReader(const fs::path& folder, ExperimentState& state) : folder_(folder), state_(state) {}

  void take(const LogLine& line) {
    const Json& facts = line.facts;
    const auto text = [&](const char* key) { return facts.value(key, std::string()); };
    if (line.kind == "assigned") assign(facts);
    if (line.kind == "dropped" || line.kind == "excluded") {
      Participant& who = participant(text("participant"));
      (line.kind == "dropped" ? who.dropped : who.excluded) = true;
      who.reason = text("reason");
      who.rule = text("rule");
      who.after_look = !state_.looks.empty();
    }
    if (line.kind == "look")
      state_.looks.push_back({.time = line.time,
                              .participants = facts.at("participants").get<std::vector<std::string>>(),
                              .paid = facts.at("paid").get<bool>(),
                              .reason = text("reason")});
    if (line.kind == "opened")
      state_.openings.push_back(
          fmt::format("{} was opened by itself at {}: {}", text("participant"), line.time, text("reason")));
    if (line.kind == "run") {
      state_.receipts.push_back(text("receipt"));
      entries_[text("session")] = facts.at("entries").get<std::size_t>();
    }
  }

  [[nodiscard]] std::size_t entries_of(const std::string& uuid) const {
    const auto known = entries_.find(uuid);
    return known == entries_.end() ? 0 : known->second;
  }

 private:
  Participant& participant(const std::string& code) {
    const auto known = std::ranges::find(state_.participants, code, &Participant::code);
    if (known != state_.participants.end()) return *known;
    throw std::invalid_argument(fmt::format("experiment.log names {:?}, who was assigned nothing", code));
  }

  void assign(const Json& facts) {
    const auto code = facts.at("participant").get<std::string>();
    if (state_.find(code) == nullptr) {
      state_.participants.push_back({.code = code,
                                     .group = facts.value("group", std::string()),
                                     .number = facts.at("number").get<std::size_t>(),
                                     .replaces = facts.value("replaces", std::string())});
      if (const std::string& left = state_.participants.back().replaces; !left.empty())
        participant(left).replaced_by = code;
    }
    participant(code).sessions.push_back({.file = folder_ / facts.at("file").get<std::string>(),
                                          .uuid = facts.at("session").get<std::string>(),
                                          .visit = facts.at("visit").get<std::size_t>()});
  }

  const fs::path& folder_;
  ExperimentState& state_;
  std::map<std::string, std::size_t> entries_;  ///< of a session, when it was last run
};

/// The files of the folder, each dealt to the session that it is.
class FileMatcher {
 public:
  FileMatcher(ExperimentState& state, std::vector<FoundSession> found)
      : state_(state), found_(std::move(found)) {}

  void match(const LogReader& log) {
    for (Participant& each : state_.participants) {
      for (AssignedSession& session : each.sessions) take(each, session, log.entries_of(session.uuid));
    }
    for (const FoundSession& one : found_) {
      if (one.facts.is_null()) continue;
      problem("{}: a session of {} that this experiment assigned to nobody; it is not counted",
              one.file.string(), one.facts["subject"].get<std::string>());
    }
  }

 private:
  template <typename... Arguments>
  void problem(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    state_.problems.push_back(fmt::format(format, std::forward<Arguments>(arguments)...));
  }

  void take(const Participant& who, AssignedSession& session, std::size_t entries_before) {
    const fs::path assigned = session.file;
    std::vector<FoundSession*> copies;
    for (FoundSession& one : found_) {
      if (!one.facts.is_null() && one.facts["uuid"] == session.uuid) copies.push_back(&one);
    }
    std::ranges::stable_sort(copies, {}, [&](const FoundSession* one) { return one->file != assigned; });
    if (copies.empty()) {
      problem("{}: the session of {} is missing", assigned.string(), who.code);
      return;
    }
    take_facts(*copies.front(), session);
    if (session.file != assigned)
      problem("{}: the session of {} was {} when it was assigned", session.file.string(), who.code,
              name_in(assigned));
    for (const FoundSession* copy : std::span(copies).subspan(1))
      problem("{}: the session of {} is there twice; {} alone is counted", copy->file.string(), who.code,
              name_in(session.file));
    const std::size_t entries = copies.front()->facts["entries"].size();
    if (entries < entries_before)
      problem("{}: has {} entries, and had {}: it was cut short, or an older copy was put back",
              session.file.string(), entries, entries_before);
    if (const std::size_t last = last_look_in(copies.front()->facts); last > state_.looks.size())
      problem("{}: knows of look {}, and experiment.log has {}: its end was cut off", session.file.string(),
              last, state_.looks.size());
    for (FoundSession* copy : copies) copy->facts = nullptr;
  }

  ExperimentState& state_;
  std::vector<FoundSession> found_;
};

}  // namespace

std::string_view stage_of(const Participant& who) noexcept {
  if (who.dropped) return "dropped";
  if (who.excluded) return "excluded";
  if (who.completed()) return "completed";
  return who.begun() ? "begun" : "assigned";
}

bool Participant::begun() const {
  return std::ranges::any_of(sessions, [](const auto& each) { return each.begun; });
}

bool Participant::completed() const {
  return !sessions.empty() && std::ranges::all_of(sessions, [](const auto& each) { return each.finished; });
}

const Participant* ExperimentState::find(std::string_view code) const {
  const auto known = std::ranges::find(participants, code, &Participant::code);
  return known == participants.end() ? nullptr : &*known;
}

bool ExperimentState::is_over() const {
  const ReplacementRule rule = experiment.participants.replace;
  return std::ranges::all_of(participants, [&](const Participant& each) {
    if (!each.replaced_by.empty()) return true;
    if (each.dropped) return rule == ReplacementRule::never;
    if (each.excluded) return rule != ReplacementRule::dropped_or_excluded;
    return each.completed();
  });
}

ExperimentState experiment_state(const fs::path& experiment_file, const ExperimentLog& log) {
  ExperimentState state;
  const fs::path folder = experiment_file.parent_path();
  try {
    state.experiment = parse_experiment(log.registered().facts.at("experiment").get<std::string>(),
                                        log_of(experiment_file).string() + " (registered)");
    LogReader reader(folder, state);
    for (const LogLine& line : log.lines()) reader.take(line);
    std::vector<std::string> expected;
    for (const Participant& each : state.participants) {
      for (const AssignedSession& session : each.sessions) expected.push_back(name_in(session.file));
    }
    auto found = sessions_in(folder, state.problems, expected);
    FileMatcher(state, std::move(found)).match(reader);
  } catch (const Json::exception& error) {
    throw std::invalid_argument(fmt::format("{}: is no log of an experiment of this version: {}",
                                            log_of(experiment_file).string(), error.what()));
  }
  return state;
}

std::string to_entry(const SessionMembership& membership) {
  return Json{{"experiment", membership.experiment},
              {"participant", membership.participant},
              {"visit", membership.visit}}
      .dump();
}

std::optional<SessionMembership> membership_of(const schema::Session& session) {
  const auto entry = std::ranges::find(session.entries, "registered", &schema::SessionEntry::kind);
  if (entry == session.entries.end()) return std::nullopt;
  const Json facts = Json::parse(entry->text, nullptr, false);
  if (!facts.is_object()) return SessionMembership();
  return SessionMembership{.experiment = facts.value("experiment", std::string()),
                           .participant = facts.value("participant", std::string()),
                           .visit = facts.value("visit", std::size_t{1})};
}

std::vector<FlowCounts> flow_of(const ExperimentState& state) {
  std::vector<FlowCounts> flow(1);
  for (const std::string& group : state.experiment.participants.groups) flow.push_back({.group = group});
  for (FlowCounts& counts : flow) {
    for (const Participant& each : state.participants) {
      if (&counts != &flow.front() && each.group != counts.group) continue;
      ++counts.assigned;
      counts.begun += each.begun() ? 1 : 0;
      counts.completed += each.completed() ? 1 : 0;
      counts.dropped += each.dropped ? 1 : 0;
      counts.replaced += each.replaced_by.empty() ? 0 : 1;
      counts.excluded += each.excluded ? 1 : 0;
      counts.analysed += each.completed() && !each.is_out() ? 1 : 0;
    }
  }
  return flow;
}

}  // namespace kerf::bench
