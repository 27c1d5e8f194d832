#include "choose/choice_files.h"

#include <cmath>

#include <fmt/core.h>

#include "choose/choice_page.h"
#include "files/json_file.h"
#include "files/json_number.h"
#include "files/whole_file.h"
#include "fits/fit_files.h"
#include "recordings/provenance.h"
#include "tables/csv.h"

namespace kerf::bench {
namespace {

using json = nlohmann::ordered_json;

json names_of(const Effects& effects) {
  json names = json::array();
  for (const Effect effect : effects) names.push_back(name_of(effect));
  return names;
}

json deadline_as_json(const std::optional<Deadline>& deadline) {
  if (!deadline) return nullptr;
  return {{"held", deadline->held},
          {"machine_late", deadline->machine_late},
          {"compute_p999_us", deadline->p999_us},
          {"missed", deadline->missed},
          {"ticks", deadline->ticks},
          {"why", deadline->why}};
}

json candidate_as_json(const Candidate& candidate) {
  json result{{"law", candidate.law.name},
              {"model", candidate.law.model},
              {"options", candidate.law.law_options},
              {"parameters", candidate.law.parameters},
              {"effects", names_of(candidate.law.effects)},
              {"converged", candidate.converged},
              {"rmse", candidate.fit ? json_number(candidate.fit->result.rmse) : json(nullptr)},
              {"held_out", json_number(candidate.error_n)},
              {"held_out_fitted", json_number(candidate.fitted_n)},
              {"held_out_jnd", json_number(candidate.error_jnd)},
              {"within_jnd", candidate.within_jnd},
              {"tick_us", candidate.tick_us},
              {"deadline", deadline_as_json(candidate.deadline)},
              {"stable", to_json(candidate.stability.stable)},
              {"why_not_judged", why_not_judged(candidate.stability)},
              {"passed_over", candidate.why}};
  if (std::isfinite(candidate.error_torque_n_m)) result["held_out_torque"] = candidate.error_torque_n_m;
  return result;
}

json effect_as_json(const EffectVerdict& verdict) {
  return {{"effect", name_of(verdict.effect)},
          {"verdict", name_of(verdict.matter)},
          {"without", json_number(verdict.without_n)},
          {"without_law", verdict.without_law},
          {"with", json_number(verdict.with_n)},
          {"with_law", verdict.with_law},
          {"why", verdict.why}};
}

json advice_as_json(const LawChoice& choice) {
  if (!choice.advice) return nullptr;
  return {{"controller", "passivity"},
          {"law", choice.candidates.at(choice.advice->candidate).law.name},
          {"added", choice.advice->added_n},
          {"added_jnd", choice.advice->added_n / choice.jnd_n}};
}

json parameters_of(const Candidate& candidate) {
  json parameters = json::object();
  if (!candidate.fit) return parameters;
  for (const fitting::Estimate& estimate : candidate.fit->result.parameters) {
    parameters[estimate.info.name] = {
        {"value", estimate.value},
        {"std_error", json_number(estimate.std_error)},
        {"lower", json_number(estimate.lower)},
        {"upper", json_number(estimate.upper)},
        {"unit", models::unit_of(estimate.info.quantity, candidate.fit->file.force_unit,
                                 candidate.fit->file.position_unit)}};
  }
  return parameters;
}

}  // namespace

json choice_as_json(const LawChoice& choice) {
  json candidates = json::array();
  for (const Candidate& candidate : choice.candidates) candidates.push_back(candidate_as_json(candidate));
  json effects = json::array();
  for (const EffectVerdict& verdict : choice.effects) effects.push_back(effect_as_json(verdict));
  const auto name_at = [&](const std::optional<std::size_t>& place) {
    return place ? json(choice.candidates.at(*place).law.name) : json(nullptr);
  };
  return {
      {"jnd", choice.jnd_n},
      {"force_rms", choice.force_rms_n},
      {"force_unit", choice.force_unit},
      {"weber_fraction", choice.settings.jnd.weber_fraction},
      {"threshold", choice.settings.jnd.threshold},
      {"jnd_source", choice.settings.jnd_source},
      {"held_out_by", choice.held_out},
      {"cycles", in_words(choice.rows.cycles)},
      {"cycles_left_out", as_json(choice.cycles_left_out)},
      {"choice",
       {{"law", name_at(choice.taken)},
        {"serves", choice.serves},
        {"in_doubt", choice.in_doubt},
        {"as_good", name_at(choice.as_good)},
        {"parameters", choice.taken ? parameters_of(choice.candidates.at(*choice.taken)) : json::object()},
        {"controller", advice_as_json(choice)},
        {"why", choice.why},
        {"blame", choice.blame.empty() ? json(nullptr) : json(choice.blame)}}},
      {"floor", choice.floor ? floor_as_json(*choice.floor) : json(nullptr)},
      {"effects", effects},
      {"candidates", candidates},
      {"warnings", choice.warnings}};
}

std::string choice_csv(const LawChoice& choice) {
  std::string text =
      "law,model,parameters,held_out,held_out_jnd,within_jnd,tick_us,compute_p999_us,missed,ticks,deadline,"
      "stable,passed_over\n";
  const auto yes = [](bool value) { return value ? "yes" : "no"; };
  for (const Candidate& one : choice.candidates) {
    text += fmt::format(
        "{},{},{},{},{},{},{},{},{},{},{},{},{}\n", csv_text(one.law.name), one.law.model, one.law.parameters,
        csv_number(one.error_n), csv_number(one.error_jnd), yes(one.within_jnd), one.tick_us,
        one.deadline ? csv_number(one.deadline->p999_us) : "",
        one.deadline ? fmt::format("{}", one.deadline->missed) : "",
        one.deadline ? fmt::format("{}", one.deadline->ticks) : "",
        one.deadline ? (one.deadline->machine_late ? "machine late" : yes(one.deadline->held)) : "",
        name_of(one.stability.stable), csv_quoted(one.why));
  }
  return text;
}

void refuse_to_replace_choice(const std::filesystem::path& folder, bool replace) {
  for (const auto* name : {"choose.json", "choose.csv", "choose.html"})
    require_output(folder / name, replace);
}

void write_choice(LawChoice& choice, const json& json, const std::filesystem::path& recording,
                  const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  for (const auto& place : {choice.taken, choice.as_good}) {
    if (!place) continue;
    Candidate& law = choice.candidates.at(*place);
    if (!recording.empty()) name_recording(law.file->fit, recording);
    write_law_file(folder / (law.law.name + ".law.toml"), *law.file);
  }
  write_whole_file(folder / "choose.csv", choice_csv(choice));
  write_whole_file(folder / "choose.html", choice_page(json, recording, choice));
  write_json_file(folder / "choose.json", json);
}

}  // namespace kerf::bench
