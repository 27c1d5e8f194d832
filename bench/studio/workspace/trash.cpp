#include "workspace/trash.h"

#include <algorithm>
#include <chrono>
#include <system_error>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <kerf/schema/final_name.h>

#include "files/whole_file.h"
#include "http/routes.h"
#include "jobs/job_record.h"
#include "jobs/job_store.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

constexpr const char* trashed_content = "content";
constexpr const char* trashed_about = "about.json";

}  // namespace

Trash::Trash(const Workspace& workspace)
    : workspace_(workspace.folder()), folder_(state_folder_of(workspace.folder()) / "trash") {}

std::string Trash::take(const WorkspaceEntry& entry) {
  fs::create_directories(folder_);
  std::size_t number = 1;
  while (!fs::create_directory(folder_ / std::to_string(number))) ++number;
  const fs::path place = folder_ / std::to_string(number);
  const nlohmann::ordered_json about{{"name", entry.name},
                                     {"time", iso_8601(std::chrono::system_clock::now())}};
  try {
    // What it is stands there first: a file that nobody knows the name of is as good as lost.
    write_whole_file(place / trashed_about,
                     about.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
    fs::rename(entry.path, place / trashed_content);
  } catch (...) {
    std::error_code ignored;
    fs::remove_all(place, ignored);
    throw;
  }
  return std::to_string(number);
}

std::vector<TrashedFile> Trash::list() const {
  std::vector<TrashedFile> files;
  std::error_code error;
  for (fs::directory_iterator at(folder_, error); !error && at != fs::directory_iterator();
       at.increment(error)) {
    try {
      const auto about = nlohmann::json::parse(read_whole_file(at->path() / trashed_about));
      files.push_back({.key = at->path().filename().string(),
                       .name = about.at("name").get<std::string>(),
                       .time = about.at("time").get<std::string>(),
                       .bytes = fs::file_size(at->path() / trashed_content)});
    } catch (const std::exception&) {  // of a moment ago, or nothing of ours
    }
  }
  std::ranges::sort(files, std::ranges::greater(),
                    [](const TrashedFile& it) { return std::pair(it.key.size(), it.key); });
  return files;
}

void Trash::restore(const std::string& key) {
  const std::vector<TrashedFile> files = list();
  const auto found = std::ranges::find(files, key, &TrashedFile::key);
  if (found == files.end()) throw RequestError(404, "it is not in the trash any more");
  const fs::path target = workspace_ / found->name;
  std::error_code error;
  if (fs::exists(fs::symlink_status(target, error)))
    throw RequestError(409, fmt::format("{} is there again: rename that first", found->name));
  fs::create_directories(target.parent_path());
  schema::take_name(folder_ / key / trashed_content, target, schema::Existing::keep);
  fs::remove_all(folder_ / key, error);
}

void Trash::empty() {
  for (const TrashedFile& file : list()) fs::remove_all(folder_ / file.key);
}

}  // namespace kerf::bench
