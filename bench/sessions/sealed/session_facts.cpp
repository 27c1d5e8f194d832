#include "sealed/session_facts.h"

#include <fmt/core.h>

#include <kerf/schema/session.h>

#include "sealed/journal.h"

namespace kerf::bench {
namespace {

using Json = nlohmann::ordered_json;

/// The entries of the journal are taken up as a reader of the session would.
Json journal_facts(const std::filesystem::path& file, schema::Session& session) {
  auto journal = Journal::look(file);
  if (!journal) return nullptr;
  Json warnings = Json::array();
  try {
    journal->take_up(session);
    session.entries.insert(session.entries.end(), journal->entries().begin(), journal->entries().end());
    for (const std::string& warning : journal->warnings()) warnings.push_back(warning);
  } catch (const schema::FormatError& error) {
    warnings.push_back(error.what());
  }
  return {{"entries", journal->entries().size()},
          {"being_run", journal->being_run()},
          {"warnings", std::move(warnings)}};
}

void add_entries(Json& facts, const schema::Session& session) {
  std::size_t trials = 0;
  bool finished = false;
  facts["openings"] = Json::array();
  Json entries = Json::array();
  for (const schema::SessionEntry& entry : session.entries) {
    trials += entry.kind == "trial" ? 1 : 0;
    finished = finished || entry.kind == "finished";
    entries.push_back({{"kind", entry.kind}, {"time", entry.time}, {"text", entry.text}});
    if (entry.kind != "opened") continue;
    facts["openings"].push_back({{"time", entry.time}, {"text", entry.text}, {"early", !finished}});
  }
  facts["trials"] = trials;
  facts["finished"] = finished;
  facts["entries"] = std::move(entries);
}

}  // namespace

Json session_facts(const std::filesystem::path& file) {
  schema::Session session = schema::read_session_facts(file);
  Json facts{{"schema", schema::session_schema_name},
             {"schema_version", schema::session_schema_version},
             {"uuid", session.uuid},
             {"created", session.created},
             {"software", session.software},
             {"subject", session.subject},
             {"number", session.number},
             {"subjects", session.subjects},
             {"key", session.key.kind},
             {"laws", Json::array()},
             {"protocol", session.protocol}};
  for (const schema::SessionLaw& law : session.laws) facts["laws"].push_back(law.name);
  Json journal = journal_facts(file, session);
  facts["warnings"] = journal.is_null() ? Json::array() : journal["warnings"];
  if (!journal.is_null()) journal.erase("warnings");
  facts["journal"] = std::move(journal);
  add_entries(facts, session);
  return facts;
}

std::string session_facts_table(const Json& facts) {
  std::string table;
  const auto line = [&](std::string_view name, const std::string& value) {
    table += fmt::format("{:<12}{}\n", name, value);
  };
  const auto text = [&](const char* name) { return facts[name].get<std::string>(); };
  line("session", text("uuid"));
  line("created", fmt::format("{} by {}", text("created"), text("software")));
  line("subject", fmt::format("{}, {} of {}", text("subject"), facts["number"].get<std::size_t>(),
                              facts["subjects"].get<std::size_t>()));
  line("sealed", fmt::format("with a {}", text("key")));
  for (const Json& law : facts["laws"]) line("law", law.get<std::string>());
  line("trials", fmt::format("{}{}", facts["trials"].get<std::size_t>(),
                             facts["finished"].get<bool>() ? ", finished" : ", not finished"));
  for (const Json& opening : facts["openings"]) {
    line("opened", fmt::format("{}{}: {}", opening["time"].get<std::string>(),
                               opening["early"].get<bool>() ? ", before the end" : "",
                               opening["text"].get<std::string>()));
  }
  if (const Json& journal = facts["journal"]; !journal.is_null()) {
    line("journal",
         fmt::format("{} entries{}", journal["entries"].get<std::size_t>(),
                     journal["being_run"].get<bool>() ? "; it is being run" : ", left by a crash"));
  }
  table += "\nentries\n";
  for (const Json& entry : facts["entries"]) {
    table += fmt::format("{:<22}{:<10}{}\n", entry["time"].get<std::string>(),
                         entry["kind"].get<std::string>(), entry["text"].get<std::string>());
  }
  table.pop_back();
  return table;
}

}  // namespace kerf::bench
