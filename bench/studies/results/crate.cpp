#include "results/crate.h"

#include <algorithm>
#include <cctype>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <kerf/schema/recording.h>
#include <kerf/version.h>

#include "recordings/provenance.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;
using json = nlohmann::ordered_json;

constexpr const char* process_profile = "https://w3id.org/ro/wfrun/process/0.5";

json reference(const std::string& id) { return {{"@id", id}}; }

/// A path as a relative URL.
std::string url_of(const std::string& path) {
  std::string url;
  for (const char c : path) {
    const auto byte = static_cast<unsigned char>(c);
    const bool plain = std::isalnum(byte) != 0 || std::string_view("-._~/").find(c) != std::string_view::npos;
    url += plain ? std::string(1, c) : fmt::format("%{:02X}", byte);
  }
  return url;
}

std::string media_type(const fs::path& file) {
  const std::string extension = file.extension().string();
  if (extension == ".json") return "application/json";
  if (extension == ".csv") return "text/csv";
  if (extension == ".html") return "text/html";
  if (extension == ".toml") return "application/toml";
  if (extension == ".h5") return "application/x-hdf5";
  if (extension == ".txt") return "text/plain";
  return "application/octet-stream";
}

/// Every file of the study but the crate's own and what is being written.
std::vector<std::string> files_of(const fs::path& folder) {
  std::vector<std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    const std::string name = entry.path().lexically_relative(folder).generic_string();
    if (name != crate_file && name.find(".writing-") == std::string::npos) files.push_back(name);
  }
  std::ranges::sort(files);
  return files;
}

/// Copies of what lay elsewhere, study.toml, and import files that lie beside it.
bool is_input(const std::string& name) {
  return name.starts_with("inputs/") || name.starts_with("imports/") ||
         (name.find('/') == std::string::npos && name.ends_with(".toml"));
}

json file_entity(const fs::path& folder, const std::string& name) {
  json entity{{"@id", url_of(name)},
              {"@type", "File"},
              {"name", name},
              {"encodingFormat", media_type(name)},
              {"contentSize", fmt::format("{}", fs::file_size(folder / name))},
              {"sha256", sha256_of(folder / name)}};
  if (name == "study.toml") entity["description"] = "What the study goes by: files, columns, factors, laws";
  if (name.starts_with("imports/") && name.ends_with(".law.toml")) {
    entity["description"] = "Shape of the blade that is fitted to recordings of six axes";
  } else if (name.starts_with("imports/")) {
    entity["description"] = "Columns of text files, as an import takes them";
  }
  if (name == "report.html") entity["description"] = "Report of the study";
  if (name == "tables/data_dictionary.csv") entity["description"] = "What each column of each table is";
  return entity;
}

json licence_entity(const StudyPlan& plan) {
  if (!plan.licence.empty())
    return {{"@id", plan.licence.find("://") == std::string::npos ? "#licence" : plan.licence},
            {"@type", "CreativeWork"},
            {"name", plan.licence},
            {"description", "Licence of the data, as study.toml gives it"}};
  return {{"@id", "#no-licence"},
          {"@type", "CreativeWork"},
          {"name", "No licence given"},
          {"description", "Whose the data are has said nothing of who may use them"}};
}

}  // namespace

json study_crate(const StudyResults& results, const fs::path& folder) {
  const std::string now = schema::new_header("").created;
  const std::vector<std::string> files = files_of(folder);
  const json licence = licence_entity(results.plan);
  json parts = json::array();
  json inputs = json::array();
  json made = json::array();
  for (const std::string& name : files) {
    parts.push_back(reference(url_of(name)));
    (is_input(name) ? inputs : made).push_back(reference(url_of(name)));
  }
  json people = json::array();
  for (std::size_t i = 0; i < results.plan.people.size(); ++i)
    people.push_back(reference(fmt::format("#person-{}", i + 1)));
  json root{
      {"@id", "./"},
      {"@type", "Dataset"},
      {"name", "Study " + results.name},
      {"description", results.conclusions.empty() ? "A study by Kerf" : results.conclusions.front().sentence},
      {"datePublished", now},
      {"license", reference(licence.at("@id"))},
      {"conformsTo", reference(process_profile)},
      {"mentions", reference("#run")},
      {"hasPart", parts}};
  json action{
      {"@id", "#run"},
      {"@type", "CreateAction"},
      {"name", "kerf study run study.toml"},
      {"description", "Every recording imported, segmented, inspected and fitted, and held to the others"},
      {"instrument", reference("#kerf")},
      {"object", inputs},
      {"result", made},
      {"endTime", now},
      {"actionStatus", reference("http://schema.org/CompletedActionStatus")}};
  if (!people.empty()) root["author"] = action["agent"] = people;
  json graph = json::array();
  graph.push_back({{"@id", crate_file},
                   {"@type", "CreativeWork"},
                   {"about", reference("./")},
                   {"conformsTo", reference("https://w3id.org/ro/crate/1.1")}});
  graph.push_back(root);
  graph.push_back({{"@id", process_profile},
                   {"@type", "CreativeWork"},
                   {"name", "Process Run Crate"},
                   {"version", "0.5"}});
  graph.push_back(licence);
  graph.push_back({{"@id", "#kerf"},
                   {"@type", "SoftwareApplication"},
                   {"name", "Kerf"},
                   {"softwareVersion", software()}});
  graph.push_back(action);
  for (std::size_t i = 0; i < results.plan.people.size(); ++i)
    graph.push_back(
        {{"@id", fmt::format("#person-{}", i + 1)}, {"@type", "Person"}, {"name", results.plan.people[i]}});
  for (const std::string& name : files) graph.push_back(file_entity(folder, name));
  return {{"@context", "https://w3id.org/ro/crate/1.1/context"}, {"@graph", graph}};
}

}  // namespace kerf::bench
