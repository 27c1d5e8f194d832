#include "dataset/psych_ds.h"

#include <map>
#include <set>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "dataset/dataset_tables.h"
#include "dataset/methods_text.h"
#include "files/whole_file.h"
#include "files/whole_folder.h"

namespace kerf::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr auto description_file = "dataset_description.json";

std::string file_of(const Protocol& protocol, const DescribedTable& table) {
  return fmt::format("data/task-{}_description-{}_data.csv", name_of(protocol.design), table.name);
}

/// Every column of every table once.
Json variables_of(const std::vector<DescribedTable>& tables) {
  std::map<std::string_view, Json> all;
  std::vector<std::string_view> order;
  for (const DescribedTable& table : tables) {
    for (const TableColumn& column : table.columns) {
      if (all.contains(column.name)) continue;
      order.push_back(column.name);
      Json one{{"@type", "PropertyValue"}, {"name", column.name}, {"description", column.meaning}};
      if (!column.unit.empty()) one["unitText"] = column.unit;
      all.emplace(column.name, std::move(one));
    }
  }
  Json list = Json::array();
  for (const std::string_view name : order) list.push_back(all.at(name));
  return list;
}

Json description_of(const SessionStore& first, const DatasetNotes& notes,
                    const std::vector<DescribedTable>& tables) {
  const Protocol& protocol = first.protocol();
  Json json{{"@context", "https://schema.org/"},
            {"@type", "Dataset"},
            {"name", protocol.name},
            {"description",
             notes.description.empty()
                 ? fmt::format("Answers of a blind comparison of renderings ({}), what was felt, and "
                               "who took part.",
                               name_of(protocol.design))
                 : notes.description},
            {"schemaVersion", "Psych-DS 1.5.0"},
            {"generator", first.session().software}};
  if (!notes.licence.empty()) json["license"] = notes.licence;
  for (const std::string& author : notes.authors)
    json["author"].push_back({{"@type", "Person"}, {"name", author}});
  json["variableMeasured"] = variables_of(tables);
  return json;
}

std::string readme_of(const Protocol& protocol, const std::vector<DescribedTable>& tables) {
  std::string text = fmt::format(
      "# {}\n\nA Psych-DS dataset. `dataset_description.json` says what each column is and its unit; a cell "
      "is empty "
      "where nothing is known. `documentation/methods.md` tells how the answers came about, `materials/` has "
      "the "
      "protocol and the laws as they were read, and every text that a subject was shown beside them.\n\n",
      protocol.name);
  for (const DescribedTable& table : tables) text += fmt::format("- `{}`\n", file_of(protocol, table));
  return text +
         "\nIn Python `pandas.read_csv(FILE)`, in R `read.csv(FILE)`; tables join by `trial_id` and "
         "`subject_id`.\n";
}

/// A name that a protocol gives a law, as one file's.
std::string as_file_name(const std::string& name) {
  std::string file;
  for (const char c : name) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '.' || c == '-' || c == '_';
    file += plain ? c : '_';
  }
  return file;
}

void write_laws(const schema::Session& session, const std::filesystem::path& folder) {
  std::set<std::string> taken;
  for (const schema::SessionLaw& law : session.laws) {
    const std::string stem = as_file_name(std::filesystem::path(law.name).filename().string());
    std::string file = stem;
    for (int i = 2; !taken.insert(file).second; ++i) file = fmt::format("{}-{}", i, stem);
    write_whole_file(folder / file, law.toml);
  }
}

}  // namespace

void require_dataset_output(const std::filesystem::path& folder, bool replace) {
  require_output(folder / description_file, replace);
}

void write_dataset(const std::vector<const SessionStore*>& sessions, const DatasetExperiment* experiment,
                   const DatasetNotes& notes, const std::filesystem::path& folder, bool replace) {
  require_one_study(sessions);
  require_dataset_output(folder, replace);
  const std::vector<DatasetSession> all = with_quality(sessions);
  std::vector<DescribedTable> tables{
      trials_table(all), slots_table(all),
      participants_table(all, experiment == nullptr ? nullptr : &experiment->state)};
  if (sessions.front()->protocol().questionnaire.is_asked()) tables.push_back(questionnaires_table(all));
  const SessionStore& first = *sessions.front();
  WholeFolder whole(folder, schema::existing_if(replace));
  for (const char* const part : {"data", "documentation", "materials/laws"})
    std::filesystem::create_directories(whole.path() / part);
  for (const DescribedTable& table : tables)
    write_whole_file(whole.path() / file_of(first.protocol(), table), table.text());
  write_whole_file(
      whole.path() / description_file,
      description_of(first, notes, tables).dump(2, ' ', false, Json::error_handler_t::replace) + '\n');
  write_whole_file(whole.path() / "README.md", readme_of(first.protocol(), tables));
  write_whole_file(whole.path() / "documentation/methods.md", methods_text(all, experiment));
  write_whole_file(whole.path() / "materials/protocol.toml", first.session().protocol);
  write_whole_file(whole.path() / "materials/texts.toml", to_toml(*first.protocol().texts));
  write_laws(first.session(), whole.path() / "materials/laws");
  if (experiment != nullptr) {
    write_whole_file(whole.path() / "materials/experiment.toml", experiment->state.experiment.toml);
    write_whole_file(whole.path() / "documentation/experiment.log", experiment->log);
  }
  whole.commit();
}

}  // namespace kerf::bench
