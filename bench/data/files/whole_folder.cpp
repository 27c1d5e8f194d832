#include "files/whole_folder.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <system_error>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

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

bool is_where_we_are(const fs::path& folder) {
  std::error_code unknown;
  return fs::equivalent(folder, fs::current_path(unknown), unknown);
}

/// Beside it; in one that is there and cannot be exchanged.
fs::path place_for(const fs::path& folder) {
  const bool stays =
      is_there(folder) && (::access(folder.parent_path().c_str(), W_OK) != 0 || is_where_we_are(folder));
  return schema::unfinished_name(stays ? folder / folder.filename() : folder);
}

/// Gives `folder` whatever `from` holds under names that it has not; files are not copied but where they have
/// to be.
void take_over(const fs::path& from, const fs::path& folder) {
  for (const auto& entry : fs::directory_iterator(from)) {
    const fs::path name = folder / entry.path().filename();
    if (entry.is_directory() && !entry.is_symlink()) {
      fs::create_directories(name);
      take_over(entry.path(), name);
    } else if (!fs::exists(fs::symlink_status(name))) {
      std::error_code has_no_links;
      fs::create_hard_link(entry.path(), name, has_no_links);
      if (has_no_links) fs::copy(entry.path(), name, fs::copy_options::copy_symlinks);
    }
  }
}

/// Returns false where the system cannot.
bool exchange(const fs::path& one, const fs::path& other) {
  if (::renameat2(AT_FDCWD, one.c_str(), AT_FDCWD, other.c_str(), RENAME_EXCHANGE) == 0) return true;
  if (errno == EINVAL || errno == ENOSYS || errno == EBUSY || errno == EXDEV) return false;
  throw std::system_error(errno, std::generic_category(),
                          other.string() + ": cannot give the folder its name");
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

/// Held by one program at a time that gives a folder in there its name. Another one waits, but not for ever:
/// who holds it may be stopped, and a file system may know of no locks.
class NamingTurn {
 public:
  explicit NamingTurn(const fs::path& parent)
      : parent_(::open(parent.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    constexpr int most_attempts = 200;
    constexpr auto pause = std::chrono::milliseconds(20);
    for (int i = 0; i < most_attempts && ::flock(parent_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
         ++i)
      std::this_thread::sleep_for(pause);
  }
  NamingTurn(const NamingTurn&) = delete;
  NamingTurn& operator=(const NamingTurn&) = delete;
  ~NamingTurn() {
    if (parent_ >= 0) ::close(parent_);
  }

 private:
  int parent_;
};

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
  // Two that take each other's results over at once would each miss the other's.
  const NamingTurn turn(folder_.parent_path());
  const bool joins = is_there(folder_) && (existing_ == schema::Existing::replace || !has_name_of_ours());
  if (!joins) return schema::take_name(std::exchange(path_, {}), folder_, schema::Existing::keep);
  if (path_.parent_path() == folder_.parent_path()) {
    take_over(folder_, path_);
    if (exchange(path_, folder_)) {
      take_over(path_, folder_);  // what came meanwhile; the rest is removed
      return;
    }
  }
  const fs::path finished = std::exchange(path_, {});  // kept where it cannot be moved
  move_into(finished, folder_, existing_);
  fs::remove_all(finished);
}

}  // namespace kerf::bench
