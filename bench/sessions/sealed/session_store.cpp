#include "sealed/session_store.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "recordings/provenance.h"
#include "sealed/sealed_entries.h"
#include "sealed/trials/trial_bytes.h"

namespace kerf::bench {
namespace {

using Json = nlohmann::ordered_json;

void require_subject(const SessionSetUp& set_up) {
  constexpr std::size_t longest = 16;
  constexpr std::string_view allowed = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-";
  const std::string& code = set_up.subject;
  if (code.empty() || code.size() > longest || code.find_first_not_of(allowed) != std::string::npos) {
    throw std::invalid_argument(fmt::format(
        "subject '{}': expected a code of 1 to {} of A-Z a-z 0-9 _ -, and no name", code, longest));
  }
  if (set_up.number < 1 || set_up.number > set_up.subjects) {
    throw std::invalid_argument(
        fmt::format("subject {} of {}: expected a number from 1 to that of all subjects", set_up.number,
                    set_up.subjects));
  }
}

std::vector<schema::SessionLaw> laws_of(const Protocol& protocol) {
  std::vector<schema::SessionLaw> laws;
  for (const SessionSample& sample : protocol.samples) {
    const auto same = std::ranges::find(laws, sample.law_name, &schema::SessionLaw::name);
    if (same == laws.end()) laws.push_back({sample.law_name, sample.law_toml});
  }
  return laws;
}

/// Plan and gains, filled up with blanks so that the length depends on how many trials and samples there are.
std::vector<std::uint8_t> plan_bytes(const SessionSetUp& set_up) {
  constexpr std::size_t bytes_of_a_trial = 256;
  constexpr std::size_t bytes_of_a_sample = 64;
  constexpr std::size_t page = 4096;
  Json json = Json::parse(to_json_text(set_up.plan));
  json["gains"] = Json::array();
  for (const SessionSample& sample : set_up.protocol.samples) json["gains"].push_back(sample.gain);
  std::string text = json.dump();
  const std::size_t room =
      page + bytes_of_a_trial * set_up.plan.size() + bytes_of_a_sample * set_up.protocol.samples.size();
  text.resize(std::max(room, (text.size() + page - 1) / page * page), ' ');
  return {text.begin(), text.end()};
}

/// What the key holder alone can have written: a program of another version, say.
[[noreturn]] void refuse(const std::filesystem::path& file, std::size_t entry, const std::string& what) {
  throw schema::FormatError(fmt::format("{}: entry {}: {}", file.string(), entry, what));
}

bool fits(const TrialPlan& trial, const Protocol& protocol) {
  return trial.tissue < protocol.tissues.size() &&
         std::ranges::all_of(trial.pair, [&](std::size_t one) { return one < protocol.samples.size(); }) &&
         std::ranges::all_of(trial.slots, [](std::uint8_t one) { return one < 2; });
}

}  // namespace

struct SessionStore::State {
  State(std::filesystem::path path, const SealKey& key, Purpose purpose)
      : file(std::move(path)),
        entries(file, key, purpose == Purpose::run ? SealedEntries::For::run : SealedEntries::For::read,
                [this](std::size_t number, const schema::SessionEntry& entry,
                       std::span<const std::uint8_t> content) { process(number, entry, content); }) {
    protocol = parse_protocol(entries.session().protocol, fmt::format("{} (its protocol)", file.string()),
                              [this](const std::string& name) { return law_called(name); });
    if (gains.size() != protocol.samples.size()) {
      refuse(file, 0, fmt::format("found {} gains, expected one a sample", gains.size()));
    }
    for (std::size_t i = 0; i < gains.size(); ++i) protocol.samples[i].gain = gains[i];
    for (const TrialPlan& trial : plan) {
      if (!fits(trial, protocol)) refuse(file, 0, "found a trial that the protocol does not know");
    }
    for (std::size_t i = 0; i < trials.size(); ++i) {
      if (fits(trials[i].what, protocol) && trials[i].answer < answers_of(protocol.design)) continue;
      refuse(file, entry_of_trial[i], "found a trial that the protocol does not know");
    }
  }

  void process(std::size_t number, const schema::SessionEntry& entry, std::span<const std::uint8_t> content) {
    try {
      if (entry.kind == "plan") read_plan(content);
      if (entry.kind == "trial") take(trial_from(content, TraceToo::no), number);
    } catch (const std::invalid_argument& error) {
      refuse(file, number, error.what());
    }
  }

  void read_plan(std::span<const std::uint8_t> content) {
    const std::string_view text(reinterpret_cast<const char*>(content.data()), content.size());
    plan = plan_from_json(text);
    const Json json = Json::parse(text);
    if (!json.contains("gains") || !json["gains"].is_array()) throw std::invalid_argument("found no gains");
    gains.clear();
    for (const Json& gain : json["gains"]) {
      if (!gain.is_number()) throw std::invalid_argument("found a gain that is no number");
      gains.push_back(gain.get<double>());
    }
  }

  void take(RecordedTrial trial, std::size_t entry) {
    trial.trace.clear();
    trial.trace.shrink_to_fit();
    trials.push_back(std::move(trial));
    entry_of_trial.push_back(entry);
  }

  std::string law_called(const std::string& name) const {
    const auto& laws = entries.session().laws;
    const auto law = std::ranges::find(laws, name, &schema::SessionLaw::name);
    if (law != laws.end()) return law->toml;
    throw std::invalid_argument(fmt::format("{}: holds no law '{}'", file.string(), name));
  }

  std::filesystem::path file;
  Plan plan;
  std::vector<double> gains;
  std::vector<RecordedTrial> trials;
  std::vector<std::size_t> entry_of_trial;
  SealedEntries entries;  // after those that its constructor fills
  Protocol protocol;
};

void SessionStore::create(const std::filesystem::path& file, const SessionSetUp& set_up, const SealKey& key,
                          const schema::KeyDerivation& derivation, bool replace) {
  require_subject(set_up);
  const schema::Header header = schema::new_header(software());
  SealedEntries::create(file,
                        {.uuid = header.uuid,
                         .created = header.created,
                         .software = header.software,
                         .subject = set_up.subject,
                         .number = static_cast<std::uint32_t>(set_up.number),
                         .subjects = static_cast<std::uint32_t>(set_up.subjects),
                         .protocol = set_up.protocol.toml,
                         .laws = laws_of(set_up.protocol),
                         .key = derivation,
                         .entries = {}},
                        plan_bytes(set_up), key, replace);
}

SessionStore::SessionStore(std::filesystem::path file, const SealKey& key, Purpose purpose)
    : state_(std::make_unique<State>(std::move(file), key, purpose)) {}

SessionStore::~SessionStore() = default;

const Protocol& SessionStore::protocol() const noexcept { return state_->protocol; }
const Plan& SessionStore::plan() const noexcept { return state_->plan; }
const schema::Session& SessionStore::session() const noexcept { return state_->entries.session(); }
const std::vector<RecordedTrial>& SessionStore::trials() const noexcept { return state_->trials; }

RecordedTrial SessionStore::trial(std::size_t index) const {
  return trial_from(state_->entries.content(state_->entry_of_trial.at(index)), TraceToo::yes);
}

bool SessionStore::finished() const {
  return std::ranges::find(session().entries, "finished", &schema::SessionEntry::kind) !=
         session().entries.end();
}

std::vector<std::string> SessionStore::early_openings() const {
  std::vector<std::string> openings;
  for (const schema::SessionEntry& entry : session().entries) {
    if (entry.kind == "finished") break;
    if (entry.kind == "opened") openings.push_back(fmt::format("{}: {}", entry.time, entry.text));
  }
  return openings;
}

const Digest& SessionStore::chain_after(std::size_t entries) const {
  return state_->entries.chain_after(entries);
}

const std::vector<std::string>& SessionStore::warnings() const noexcept { return state_->entries.warnings(); }

void SessionStore::append(const RecordedTrial& trial) {
  State& state = *state_;
  const std::size_t entry = session().entries.size();
  state.entries.append("trial", fmt::format("trial {}", state.trials.size() + 1), trial_bytes(trial));
  RecordedTrial answered{.what = trial.what,
                         .answer = trial.answer,
                         .response_s = trial.response_s,
                         .answerable_s = trial.answerable_s,
                         .switches = trial.switches,
                         .at = trial.at,
                         .axes = trial.axes,
                         .trace = {},
                         .channels = trial.channels};
  state.take(std::move(answered), entry);
}

void SessionStore::note(const std::string& kind, const std::string& text) {
  if (kind == "plan" || kind == "trial") {
    throw std::invalid_argument(fmt::format("'{}' is no note of a session", kind));
  }
  state_->entries.append(kind, text, {});
}

void SessionStore::close() { state_->entries.close(); }

schema::KeyDerivation derivation_of(const std::filesystem::path& file) {
  return schema::read_session_facts(file).key;
}

}  // namespace kerf::bench
