#include "sealed/plan_json.h"

#include <stdexcept>

#include <fmt/core.h>

#include "files/json_number.h"

namespace kerf::bench {

using Json = nlohmann::ordered_json;

Json to_json(const TrialPlan& trial) {
  Json json{{"tissue", trial.tissue},
            {"pair", trial.pair},
            {"slots", trial.slots},
            {"level", json_number(trial.level)},
            {"practice", trial.practice}};
  if (trial.is_catch) json["catch"] = true;
  if (trial.track > 0) json["track"] = trial.track;
  return json;
}

TrialPlan trial_plan_from(const Json& json) {
  try {
    TrialPlan trial;
    trial.tissue = json.at("tissue").get<std::size_t>();
    trial.pair = json.at("pair").get<decltype(trial.pair)>();
    trial.slots = json.at("slots").get<decltype(trial.slots)>();
    if (const Json& level = json.at("level"); !level.is_null()) trial.level = level.get<double>();
    trial.practice = json.at("practice").get<bool>();
    if (json.contains("catch")) trial.is_catch = json.at("catch").get<bool>();
    if (json.contains("track")) trial.track = json.at("track").get<std::size_t>();
    return trial;
  } catch (const Json::exception& error) {
    throw std::invalid_argument(fmt::format("a trial of a plan is none: {}", error.what()));
  }
}

std::string to_json_text(const Plan& plan) {
  Json trials = Json::array();
  for (const TrialPlan& trial : plan) trials.push_back(to_json(trial));
  return Json{{"trials", std::move(trials)}}.dump();
}

Plan plan_from_json(std::string_view text) {
  const Json json = Json::parse(text, nullptr, false);
  if (!json.is_object() || !json.contains("trials") || !json["trials"].is_array()) {
    throw std::invalid_argument("a plan is none: expected JSON with 'trials'");
  }
  Plan plan;
  for (const Json& trial : json["trials"]) plan.push_back(trial_plan_from(trial));
  return plan;
}

}  // namespace kerf::bench
