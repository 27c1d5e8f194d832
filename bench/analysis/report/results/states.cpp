#include "report/results/states.h"

#include <optional>

#include <fmt/core.h>

#include <kerf/models/motion.h>

#include "recordings/provenance.h"
#include "report/charts.h"

namespace kerf::bench {
namespace {

using json = nlohmann::ordered_json;

/// What a result keeps of the recording: a fit of several keeps it of each. Nothing if it keeps nothing.
const json* kept_by(const FoundResult& result, const std::string& uuid) {
  if (result.kind != ResultKind::fits) return &result.json;
  const auto all = result.json.find("recordings");
  if (all == result.json.end() || !all->is_array()) return nullptr;
  for (const json& one : *all) {
    if (one.is_object() && one.value("uuid", std::string()) == uuid) return &one;
  }
  return nullptr;
}

std::optional<models::Contact> contact_in(const json& kept) {
  const auto contact = kept.find("contact");
  if (contact == kept.end() || !contact->is_object() || !contact->contains("position") ||
      !contact->contains("direction"))
    return std::nullopt;
  return models::Contact{.position = contact->at("position").get<double>(),
                         .direction = contact->at("direction").get<double>()};
}

}  // namespace

void tell_states(std::vector<FoundResult>& results, const schema::RecordedRows& rows) {
  std::string content;  // takes all rows: only if anybody keeps one
  for (FoundResult& result : results) {
    if (result.belongs != Belongs::here) continue;
    const json* const kept = kept_by(result, rows.about().header.uuid);
    if (kept == nullptr || !kept->is_object() || !kept->contains("cycles_sha256")) continue;
    if (content.empty()) content = content_sha256_of(rows);
    result.state = state_of(*kept, rows.about(), content);
  }
}

std::string outdated_in_words(const FoundResult& result) {
  const char* of = result.state == ResultState::other_samples ? "of other samples than the recording has now"
                   : result.state == ResultState::before_cycles ? "from before cycles were saved"
                                                                : "of earlier cycles";
  return fmt::format("{}: run {} again", of, verb_of(result.kind));
}

std::string contacts_apart(const std::vector<FoundResult>& results, const schema::Recording& about,
                           std::size_t axis) {
  const DrawnUnit unit = drawn_position(about.axes[axis]);
  std::string first;
  std::string list;
  bool apart = false;
  for (const FoundResult& result : results) {
    const bool takes_one = result.kind == ResultKind::fits || result.kind == ResultKind::chart;
    const json* const kept =
        takes_one && result.belongs == Belongs::here ? kept_by(result, about.header.uuid) : nullptr;
    if (kept == nullptr || kept->value("axis", std::string()) != about.axes[axis].name) continue;
    const auto contact = contact_in(*kept);
    if (!contact) continue;
    const std::string text = fmt::format("{:.6g} {} ({})", unit.factor * contact->position, unit.unit,
                                         contact->direction > 0.0 ? "increasing" : "decreasing");
    if (first.empty()) first = text;
    apart = apart || text != first;
    list += fmt::format("{}{} at {}", list.empty() ? "" : ", ", verb_of(result.kind), text);
  }
  if (!apart) return "";
  return "The tissue does not begin at one place, so that laws and their errors differ: " + list +
         "; --contact and --direction of these verbs make it one";
}

}  // namespace kerf::bench
