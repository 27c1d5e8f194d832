#include "choose/choose_on_device.h"

#include <optional>
#include <utility>

#include "choose/choice_files.h"
#include "segment/result_state.h"

namespace kerf::bench {
namespace {

using json = nlohmann::ordered_json;

void add_warnings(const std::optional<LoopChecks>& checks, TriedBy tried_by, LawChoice& choice) {
  if (!checks) return;
  if (checks->model()) {
    for (const std::string& doubt : checks->model()->doubts) choice.warnings.push_back(doubt);
  }
  if (!checks->placed_in_words().empty()) choice.warnings.push_back(checks->placed_in_words());
  if (tried_by == TriedBy::virtual_time) {
    choice.warnings.emplace_back(
        "no law was run by the wall clock, so that nothing is said of deadlines but what a tick costs; "
        "'kerf choose' tries them while no other loop runs");
  } else if (!checks->simulated()) {
    choice.warnings.emplace_back(
        "on a real device the closed loop is judged by its deadlines alone, and stability by what is known "
        "of its mass and friction");
  }
}

}  // namespace

void connect(const LoopChecks& checks, TriedBy tried_by, CandidateSearchOptions& search) {
  if (tried_by == TriedBy::wall_clock)
    search.deadline = [&checks](const LawFile& law) { return checks.deadline(law); };
  search.stability = [&checks](const LawFile& law, const schema::Recording&) {
    return checks.stability(law);
  };
  search.controlled = [&checks](const LawFile& law) { return checks.controlled(law); };
}

DeviceChoice choose_on_device(const schema::Recording& recording, const std::filesystem::path& file,
                              DeviceChoiceOptions options, const std::atomic<bool>& stop) {
  ChooseOptions& how = options.choose;
  if (!how.contact) how.contact = contact_of(recording, how.axis);
  std::optional<LoopChecks> checks;
  if (options.tried_by != TriedBy::data) {
    if (options.loop.device_uri.empty()) options.loop.device_uri = device_for(recording, how.axis);
    const std::string uri = options.loop.device_uri;
    checks.emplace(std::move(options.loop), stop);
    if (options.begins)
      how.search.begins = [begins = options.begins, uri](const std::string& law) { begins(law, uri); };
    checks->place(recording, how.axis, *how.contact);
    connect(*checks, options.tried_by, how.search);
  }
  LawChoice choice = choose_law(recording, how, stop);
  add_warnings(checks, options.tried_by, choice);
  json about{{"name", file.stem().string()},
             {"recording", file.string()},
             {"uuid", recording.header.uuid},
             {"device", checks ? json(checks->device_uri()) : json(nullptr)},
             {"device_model", checks ? as_json(checks->model()) : json(nullptr)}};
  about.update(as_json(kept_state(recording, how.axis)));
  about.update(choice_as_json(choice));
  return {.choice = std::move(choice), .json = std::move(about)};
}

}  // namespace kerf::bench
