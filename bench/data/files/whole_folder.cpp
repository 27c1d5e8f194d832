#include "files/whole_folder.h"

#include <algorithm>
#include <system_error>
#include <utility>

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

/// "a/b/" is "a/b".
fs::path without_slash(fs::path folder) {
  folder = fs::absolute(folder).lexically_normal();
  return folder.has_filename() ? folder : folder.parent_path();
}

bool is_there(const fs::path& folder) {
  std::error_code ignored;
  return fs::is_directory(folder, ignored) && !fs::is_empty(folder, ignored);
}

/// Beside a folder that is to come; in one that is there, whose neighbourhood may not be ours to write in.
fs::path place_for(const fs::path& folder) {
  return schema::unfinished_name(is_there(folder) ? folder / folder.filename() : folder);
}

void move_into(const fs::path& from, const fs::path& to, schema::Existing existing) {
  for (const auto& entry : fs::directory_iterator(from)) {
    const fs::path name = to / entry.path().filename();
    if (entry.is_directory() && fs::is_directory(name)) {
      move_into(entry.path(), name, existing);
    } else {
      schema::take_name(entry.path(), name, existing);
    }
  }
}

}  // namespace

WholeFolder::WholeFolder(fs::path folder, schema::Existing existing)
    : folder_(without_slash(std::move(folder))), existing_(existing), path_(place_for(folder_)) {
  fs::remove_all(path_);  // of a process that had this number and died
  fs::create_directories(path_);
  mark_ = schema::WriteMark(path_);
}

WholeFolder::~WholeFolder() {
  std::error_code ignored;
  if (!path_.empty()) fs::remove_all(path_, ignored);
}

bool WholeFolder::has_name_of_ours() const {
  return std::ranges::any_of(
      fs::recursive_directory_iterator(path_), [this](const fs::directory_entry& entry) {
        return !entry.is_directory() && fs::exists(folder_ / entry.path().lexically_relative(path_));
      });
}

void WholeFolder::commit() {
  const bool joins = is_there(folder_) && (existing_ == schema::Existing::replace || !has_name_of_ours());
  const fs::path finished = std::exchange(path_, {});  // kept, also where its name is taken
  if (!joins) return schema::take_name(finished, folder_, schema::Existing::keep);
  move_into(finished, folder_, existing_);
  fs::remove_all(finished);
}

}  // namespace kerf::bench
