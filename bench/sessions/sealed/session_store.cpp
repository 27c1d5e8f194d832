#include "sealed/session_store.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
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

Json to_json(const GainOrigin& origin) {
  return {{"hand", origin.hand},
          {"stands_for", origin.stands_for},
          {"fallback", origin.fallback},
          {"tolerance", origin.tolerance},
          {"felt_N", origin.felt_n}};
}

/// None of a session of an earlier version. @throws std::invalid_argument: it is none.
std::optional<GainOrigin> gain_origin_from(const Json& plan) {
  if (!plan.contains("gain_origin")) return std::nullopt;
  try {
    const Json& json = plan["gain_origin"];
    return GainOrigin{.hand = json.at("hand").get<std::string>(),
                      .stands_for = json.at("stands_for").get<std::string>(),
                      .fallback = json.at("fallback").get<std::string>(),
                      .tolerance = json.at("tolerance").get<double>(),
                      .felt_n = json.at("felt_N").get<std::vector<double>>()};
  } catch (const Json::exception& error) {
    throw std::invalid_argument(fmt::format("how the gains were found is not said: {}", error.what()));
  }
}

/// Those that were in force when the session was made; of a session of an earlier version English.
/// @throws std::invalid_argument: they are none.
std::shared_ptr<const SubjectTexts> texts_from(const Json& plan) {
  if (!plan.contains("texts")) return english_texts();
  try {
    return kept_texts(plan["texts"].get<std::map<std::string, std::string>>());
  } catch (const Json::exception& error) {
    throw std::invalid_argument(fmt::format("the subject's texts are none: {}", error.what()));
  }
}

/// Plan, gains and texts, filled up with blanks so that the length depends on how many trials and samples
/// there are, and on what the subject reads.
std::vector<std::uint8_t> plan_bytes(const SessionSetUp& set_up) {
  constexpr std::size_t bytes_of_a_trial = 256;
  constexpr std::size_t bytes_of_a_sample = 64;
  constexpr std::size_t page = 4096;
  Json json = Json::parse(to_json_text(set_up.plan));
  json["gains"] = Json::array();
  for (const SessionSample& sample : set_up.protocol.samples) json["gains"].push_back(sample.gain);
  if (set_up.protocol.gain_origin) json["gain_origin"] = to_json(*set_up.protocol.gain_origin);
  const auto& texts = set_up.protocol.texts->all();
  std::size_t bytes_of_texts = 0;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    json["texts"][std::string(text_names[i])] = texts[i];
    bytes_of_texts += text_names[i].size() + 2 * texts[i].size();
  }
  std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  const std::size_t room = page + bytes_of_a_trial * set_up.plan.size() +
                           bytes_of_a_sample * set_up.protocol.samples.size() + bytes_of_texts;
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

/// As many bytes whatever was answered.
std::vector<std::uint8_t> questionnaire_bytes(const FilledQuestionnaire& filled) {
  constexpr std::size_t bytes = 1024;
  std::string text = Json{{"tissue", filled.tissue}, {"scores", filled.scores}, {"at", filled.at}}.dump();
  text.resize(std::max(bytes, text.size()), ' ');
  return {text.begin(), text.end()};
}

FilledQuestionnaire questionnaire_from(std::span<const std::uint8_t> content) {
  const Json json = Json::parse(content.begin(), content.end(), nullptr, false);
  try {
    return {.tissue = json.at("tissue").get<std::size_t>(),
            .scores = json.at("scores").get<std::vector<double>>(),
            .at = json.at("at").get<std::string>()};
  } catch (const Json::exception& error) {
    throw std::invalid_argument(fmt::format("a sealed questionnaire is none: {}", error.what()));
  }
}

/// A number where one is asked for, and none where none is.
bool is_number_answered(const RecordedTrial& trial, const Protocol& protocol) {
  const std::optional<NumberRange> range = written_numbers_of(protocol);
  return range ? range->holds(trial.number) : !std::isfinite(trial.number);
}

}  // namespace

struct SessionStore::State {
  State(std::filesystem::path path, const SealKey& key, Purpose purpose)
      : file(std::move(path)),
        entries(file, key, purpose == Purpose::run ? SealedEntries::For::run : SealedEntries::For::read,
                [this](std::size_t number, const schema::SessionEntry& entry,
                       std::span<const std::uint8_t> content) { process(number, entry, content); }) {
    protocol = parse_protocol(
        entries.session().protocol, fmt::format("{} (its protocol)", file.string()),
        [this](const std::string& name) { return law_called(name); }, texts);
    if (gains.size() != protocol.samples.size()) {
      refuse(file, 0, fmt::format("found {} gains, expected one a sample", gains.size()));
    }
    for (std::size_t i = 0; i < gains.size(); ++i) protocol.samples[i].gain = gains[i];
    protocol.gain_origin = gain_origin;
    for (const TrialPlan& trial : plan) {
      if (!fits(trial, protocol)) refuse(file, 0, "found a trial that the protocol does not know");
    }
    for (const FilledQuestionnaire& filled : questionnaires) {
      if (filled.tissue >= protocol.tissues.size() ||
          filled.scores.size() != protocol.questionnaire.items.size())
        refuse(file, 0, "found a questionnaire that the protocol does not know");
    }
    for (std::size_t i = 0; i < trials.size(); ++i) {
      const bool is_taken_back = trials[i].is_void() && trials[i].answer == no_answer;
      const bool is_answered =
          trials[i].answer < choices_of(protocol) && is_number_answered(trials[i], protocol);
      if (fits(trials[i].what, protocol) && (is_taken_back || is_answered)) continue;
      refuse(file, entry_of_trial[i], "found a trial that the protocol does not know");
    }
  }

  void process(std::size_t number, const schema::SessionEntry& entry, std::span<const std::uint8_t> content) {
    try {
      if (entry.kind == "plan") read_plan(content);
      if (entry.kind == "questionnaire") questionnaires.push_back(questionnaire_from(content));
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
    gain_origin = gain_origin_from(json);
    texts = texts_from(json);
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
  std::optional<GainOrigin> gain_origin;
  std::shared_ptr<const SubjectTexts> texts;
  std::vector<RecordedTrial> trials;
  std::vector<FilledQuestionnaire> questionnaires;
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
                         .number = trial.number,
                         .response_s = trial.response_s,
                         .answerable_s = trial.answerable_s,
                         .switches = trial.switches,
                         .void_reasons = trial.void_reasons,
                         .at = trial.at,
                         .axes = trial.axes,
                         .trace = {},
                         .channels = trial.channels};
  state.take(std::move(answered), entry);
}

const std::vector<FilledQuestionnaire>& SessionStore::questionnaires() const noexcept {
  return state_->questionnaires;
}

void SessionStore::append(const FilledQuestionnaire& filled) {
  State& state = *state_;
  state.entries.append("questionnaire", fmt::format("questionnaire {}", state.questionnaires.size() + 1),
                       questionnaire_bytes(filled));
  state.questionnaires.push_back(filled);
}

void SessionStore::note(const std::string& kind, const std::string& text) {
  if (kind == "plan" || kind == "trial" || kind == "questionnaire") {
    throw std::invalid_argument(fmt::format("'{}' is no note of a session", kind));
  }
  state_->entries.append(kind, text, {});
}

void SessionStore::close() { state_->entries.close(); }

schema::KeyDerivation derivation_of(const std::filesystem::path& file) {
  return schema::read_session_facts(file).key;
}

}  // namespace kerf::bench
