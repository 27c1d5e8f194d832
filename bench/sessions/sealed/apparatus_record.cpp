#include "sealed/apparatus_record.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

namespace kerf::bench {
namespace {

constexpr auto apparatus_kind = "apparatus";
constexpr auto noise_kind = "noise";

nlohmann::json entry_of(const schema::SessionEntry& entry) {
  nlohmann::json json = nlohmann::json::parse(entry.text, nullptr, false);
  return json.is_object() ? json : nlohmann::json::object();
}

}  // namespace

Confirmations confirmations_in(const std::vector<std::string>& given, const Apparatus& apparatus) {
  Confirmations confirmed;
  for (const std::string& one : given) {
    const std::size_t equals = one.rfind('=');
    const std::string name = one.substr(0, equals);
    const std::string value = equals == std::string::npos ? "" : one.substr(equals + 1);
    const bool is_known =
        std::ranges::any_of(apparatus.items, [&](const ApparatusItem& item) { return item.name == name; });
    if (is_known && (value == "yes" || value == "no")) {
      confirmed[name] = value == "yes";
      continue;
    }
    std::string known;
    for (const ApparatusItem& item : apparatus.items)
      known += fmt::format("{}'{}'", known.empty() ? "" : ", ", item.name);
    throw std::invalid_argument(
        fmt::format("'{}' confirms nothing of the set-up; expected NAME=yes or NAME=no, with one of {}", one,
                    known.empty() ? std::string("none: the protocol has no [apparatus]") : known));
  }
  return confirmed;
}

void record_apparatus(SessionStore& store, const Confirmations& confirmed) {
  const Apparatus& apparatus = store.protocol().apparatus;
  if (apparatus.items.empty()) return;
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const ApparatusItem& item : apparatus.items) {
    const auto found = confirmed.find(item.name);
    json[item.name] =
        found == confirmed.end() ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(found->second);
  }
  store.note(apparatus_kind, json.dump());
}

void record_noise_level(SessionStore& store, double level_db) {
  store.note(noise_kind, nlohmann::ordered_json{{"kind", name_of(store.protocol().apparatus.noise)},
                                                {"level_dB", level_db}}
                             .dump());
}

std::optional<double> noise_level_of(const schema::Session& session) {
  std::optional<double> level;
  for (const schema::SessionEntry& entry : session.entries) {
    if (entry.kind != noise_kind) continue;
    const nlohmann::json json = entry_of(entry);
    if (json.contains("level_dB") && json["level_dB"].is_number()) level = json["level_dB"].get<double>();
  }
  return level;
}

std::vector<ConfirmedItem> confirmed_items(const std::vector<const SessionStore*>& sessions) {
  std::vector<ConfirmedItem> items;
  for (const ApparatusItem& item : sessions.front()->protocol().apparatus.items) {
    ConfirmedItem one{.item = item};
    for (const SessionStore* const store : sessions) {
      std::size_t runs = 0;
      for (const schema::SessionEntry& entry : store->session().entries) {
        runs += entry.kind == "run" ? 1 : 0;
        if (entry.kind != apparatus_kind) continue;
        const nlohmann::json json = entry_of(entry);
        if (!json.contains(item.name) || !json[item.name].is_boolean()) continue;
        ++(json[item.name].get<bool>() ? one.yes : one.no);
      }
      one.unknown += runs;
    }
    const std::size_t said = one.yes + one.no;
    one.unknown = one.unknown > said ? one.unknown - said : 0;
    items.push_back(one);
  }
  return items;
}

}  // namespace kerf::bench
