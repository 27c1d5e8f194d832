#include "files/whole_file.h"

#include <cerrno>
#include <fstream>
#include <mutex>
#include <set>
#include <sstream>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <unistd.h>

#include <kerf/schema/unfinished.h>

namespace kerf::bench {
namespace {

/// What killed runs had left in the folders that outputs were asked for in.
class Leftovers {
 public:
  static Leftovers& all() {
    static Leftovers leftovers;
    return leftovers;
  }
  /// Looks into each folder once.
  void remove_from(const std::filesystem::path& folder) {
    const std::lock_guard lock(mutex_);
    if (!folders_.insert(folder).second) return;
    for (auto& left : schema::remove_unfinished(folder)) removed_.push_back(std::move(left));
  }
  std::vector<std::filesystem::path> take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(removed_, {});
  }

 private:
  std::mutex mutex_;
  std::set<std::filesystem::path> folders_;
  std::vector<std::filesystem::path> removed_;
};

/// Of a program that runs one verb.
std::vector<std::filesystem::path>& protected_inputs() {
  static std::vector<std::filesystem::path> inputs;
  return inputs;
}

}  // namespace

std::string read_whole_file(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream content;
  if (!stream || std::filesystem::is_directory(file)) {
    const int reason = stream ? EISDIR : errno;
    throw std::system_error(reason, std::generic_category(), "cannot read " + file.string());
  }
  content << stream.rdbuf();
  return std::move(content).str();
}

void write_whole_file(const std::filesystem::path& file, std::string_view content,
                      schema::Existing existing) {
  write_whole_file(file, std::span(&content, 1), existing);
}

void write_whole_file(const std::filesystem::path& file, std::span<const std::string_view> parts,
                      schema::Existing existing) {
  const std::filesystem::path temporary = schema::unfinished_name(file);
  errno = 0;
  std::ofstream stream(temporary, std::ios::binary);
  const schema::WriteMark mark(temporary);
  for (const std::string_view part : parts)
    stream.write(part.data(), static_cast<std::streamsize>(part.size()));
  stream.close();
  if (!stream) {
    const int reason = errno != 0 ? errno : EIO;
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    throw std::system_error(reason, std::generic_category(), "cannot write " + file.string());
  }
  try {
    schema::take_name(temporary, file, existing);
  } catch (const schema::NameTaken&) {
    throw;  // it is kept under another name
  } catch (...) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    throw;
  }
}

std::filesystem::path existing_folder_of(const std::filesystem::path& file) {
  std::filesystem::path folder = file.parent_path();
  std::error_code ignored;
  while (folder.has_relative_path() && !std::filesystem::exists(folder, ignored))
    folder = folder.parent_path();
  return folder.empty() ? "." : folder;
}

void protect_input(const std::filesystem::path& file) { protected_inputs().push_back(file); }

void require_output(const std::filesystem::path& file, bool replace) {
  if (file.empty()) throw std::invalid_argument("'' is no name for an output");
  std::error_code absent;
  for (const std::filesystem::path& input : protected_inputs()) {
    if (std::filesystem::equivalent(input, file, absent))
      throw std::invalid_argument(fmt::format(
          "{}: the output would take the place of what is read for it; give another name", file.string()));
  }
  if (!replace && std::filesystem::exists(file)) {
    throw std::invalid_argument(fmt::format("{} exists; --force replaces it", file.string()));
  }
  require_change(file);
}

void require_change(const std::filesystem::path& file) {
  const std::filesystem::path folder = existing_folder_of(file);
  std::error_code ignored;
  const int reason = !std::filesystem::is_directory(folder, ignored) ? ENOTDIR
                     : access(folder.c_str(), W_OK | X_OK) != 0      ? errno
                                                                     : 0;
  if (reason != 0) throw std::system_error(reason, std::generic_category(), "cannot write " + file.string());
  Leftovers::all().remove_from(folder);
}

std::vector<std::filesystem::path> take_removed_leftovers() { return Leftovers::all().take(); }

}  // namespace kerf::bench
