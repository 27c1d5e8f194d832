#include "workspace/workspace.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <sys/stat.h>

#include <kerf/schema/live_recording.h>
#include <kerf/schema/session.h>
#include <kerf/schema/unfinished.h>
#include <kerf/schema/validate.h>

#include "host/realtime.h"
#include "http/routes.h"
#include "recordings/provenance.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

constexpr int max_depth = 4;
constexpr std::size_t max_files = 10'000;
constexpr std::size_t longest_name = 80;
constexpr std::size_t most_waited_for = 24;

struct Ending {
  std::string_view text;
  FileKind kind;
};
constexpr std::array endings{Ending{".law.toml", FileKind::law}, Ending{".suite.toml", FileKind::suite},
                             Ending{".scene.toml", FileKind::scene},
                             Ending{".protocol.toml", FileKind::protocol}};
constexpr std::array whole_names{
    Ending{"fit.json", FileKind::fit},       Ending{"chart.json", FileKind::chart},
    Ending{"choose.json", FileKind::choice}, Ending{"stability.json", FileKind::stability},
    Ending{"study.toml", FileKind::study},   Ending{"identify.json", FileKind::device},
    Ending{"sweep.h5", FileKind::sweep}};

/// By its name; a file of HDF5 is taken for a recording until it was looked into.
std::optional<FileKind> kind_of(const std::string& name) {
  for (const Ending& it : whole_names) {
    if (name == it.text) return it.kind;
  }
  for (const Ending& it : endings) {
    if (name.ends_with(it.text)) return it.kind;
  }
  if (name.ends_with(".h5") || name.ends_with(".h5.partial")) return FileKind::recording;
  return std::nullopt;
}

fs::file_time_type modified_of(const struct stat& about) {
  const auto since =
      std::chrono::seconds(about.st_mtim.tv_sec) + std::chrono::nanoseconds(about.st_mtim.tv_nsec);
  return std::chrono::file_clock::from_sys(std::chrono::sys_time<std::chrono::nanoseconds>(since));
}

std::string id_of_name(const std::string& name) { return sha256_of(std::string_view(name)).substr(0, 16); }

bool is_name(std::string_view name) {
  const auto is_letter_or_digit = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
  };
  return !name.empty() && name.size() <= longest_name && is_letter_or_digit(name.front()) &&
         std::all_of(name.begin(), name.end(),
                     [&](char c) { return is_letter_or_digit(c) || c == '_' || c == '-' || c == '.'; });
}

}  // namespace

std::string_view name_of(FileKind kind) noexcept {
  constexpr std::array<std::string_view, 13> names{"recording", "law",       "session", "fit",   "chart",
                                                   "choice",    "stability", "suite",   "scene", "protocol",
                                                   "study",     "device",    "sweep"};
  return names[static_cast<std::size_t>(kind)];
}

Workspace::Workspace(const fs::path& folder) {
  std::error_code error;
  folder_ = fs::canonical(folder, error);
  if (error || !fs::is_directory(folder_))
    throw std::invalid_argument(
        fmt::format("{}: no such folder; make it first, or name another", folder.string()));
}

std::vector<WorkspaceEntry> Workspace::list() const {
  std::vector<WorkspaceEntry> all;
  std::error_code error;
  const std::string folder = folder_ / "";  // what every path begins with
  fs::recursive_directory_iterator at(folder_, fs::directory_options::skip_permission_denied, error);
  for (; !error && at != fs::recursive_directory_iterator() && all.size() < max_files; at.increment(error)) {
    const std::string file = at->path().filename().string();
    const bool is_hidden = file.starts_with('.') || schema::is_unfinished(at->path());
    if (at->is_symlink(error) || is_hidden || at.depth() >= max_depth) at.disable_recursion_pending();
    const auto kind = is_hidden ? std::nullopt : kind_of(file);
    struct stat about {};
    if (!kind || ::lstat(at->path().c_str(), &about) != 0 || !S_ISREG(about.st_mode)) continue;
    WorkspaceEntry entry{.name = at->path().native().substr(folder.size()),
                         .kind = *kind,
                         .path = at->path(),
                         .bytes = static_cast<std::uintmax_t>(about.st_size),
                         .modified = modified_of(about)};
    entry.id = id_of_name(entry.name);
    entry.is_looked_into = entry.kind != FileKind::recording;
    entry.is_written = entry.is_partial() && schema::is_marked(entry.path);
    all.push_back(std::move(entry));
  }
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  return all;
}

const Workspace::Looked* Workspace::known(const WorkspaceEntry& entry) const {
  const auto before = looked_.find(entry.id);
  const bool is_it = before != looked_.end() && before->second.bytes == entry.bytes &&
                     before->second.modified == entry.modified;
  return is_it ? &before->second : nullptr;
}

void Workspace::look_into(const WorkspaceEntry& entry) {
  Looked looked;
  looked.bytes = entry.bytes;
  looked.modified = entry.modified;
  try {
    schema::Tail tail = schema::read_tail(entry.path);
    looked.seconds = tail.last.time_s;
    looked.uuid = std::move(tail.uuid);
    looked.kind = FileKind::recording;
  } catch (const schema::DamageError&) {  // says why when it is opened
    looked.kind = FileKind::recording;
    looked.is_damaged = true;
  } catch (const std::exception&) {
    const std::string schema = schema::schema_of(entry.path);
    if (schema == schema::session_schema_name) looked.kind = FileKind::session;
    if (schema == schema::schema_name || !entry.name.ends_with(".h5")) looked.kind = FileKind::recording;
  }
  const std::lock_guard lock(mutex_);
  looked_[entry.id] = looked;
}

void Workspace::look_into_all(std::vector<WorkspaceEntry> entries) {
  if (entries.size() <= most_waited_for) {
    for (const WorkspaceEntry& entry : entries) look_into(entry);
    return;
  }
  std::reverse(entries.begin(), entries.end());
  const std::lock_guard lock(mutex_);
  to_look_into_ = std::move(entries);
  if (is_looking_) return;
  is_looking_ = true;
  looker_ = std::jthread([this](const std::stop_token& stop) {
    give_way();  // to whoever waits for the list
    while (!stop.stop_requested()) {
      std::unique_lock own(mutex_);
      if (to_look_into_.empty()) {
        is_looking_ = false;
        return;
      }
      const WorkspaceEntry entry = std::move(to_look_into_.back());
      to_look_into_.pop_back();
      own.unlock();
      look_into(entry);
    }
  });
}

bool Workspace::take_what_is_known(WorkspaceEntry& entry) const {
  if (entry.is_looked_into) return true;
  const Looked* const looked = known(entry);
  if (looked == nullptr) return true;
  entry.is_looked_into = true;
  entry.kind = looked->kind.value_or(entry.kind);
  entry.seconds = looked->seconds;
  entry.uuid = looked->uuid;
  entry.is_damaged = looked->is_damaged;
  return looked->kind.has_value();
}

std::vector<WorkspaceEntry> Workspace::scan() {
  std::vector<WorkspaceEntry> all = list();
  std::vector<WorkspaceEntry> unknown;
  {
    const std::lock_guard lock(mutex_);
    std::copy_if(all.begin(), all.end(), std::back_inserter(unknown),
                 [this](const WorkspaceEntry& it) { return !it.is_looked_into && known(it) == nullptr; });
  }
  look_into_all(std::move(unknown));
  const std::lock_guard lock(mutex_);
  std::erase_if(all, [this](WorkspaceEntry& it) { return !take_what_is_known(it); });
  found_ = all;
  return all;
}

WorkspaceEntry Workspace::find(const std::string& id, FileKind kind) {
  const auto named = [&]() -> std::optional<WorkspaceEntry> {
    const std::lock_guard lock(mutex_);
    const auto found = std::ranges::find(found_, id, &WorkspaceEntry::id);
    return found == found_.end() ? std::nullopt : std::optional(*found);
  };
  std::error_code error;
  for (const bool anew : {false, true}) {
    if (anew) (void)scan();
    auto entry = named();
    if (!entry || !fs::is_regular_file(fs::symlink_status(entry->path, error))) continue;
    if (!entry->is_looked_into) {
      look_into(*entry);
      const std::lock_guard lock(mutex_);
      if (!take_what_is_known(*entry)) continue;
    }
    if (entry->kind == kind) return *entry;
  }
  throw RequestError(404, fmt::format("there is no such {} in this folder any more", name_of(kind)));
}

fs::path Workspace::new_file(const std::string& name, std::string_view ending, bool replace) const {
  if (!is_name(name))
    throw RequestError(400, fmt::format("a name has 1 to {} letters, digits, '_', '-' or '.', the first a "
                                        "letter or digit",
                                        longest_name));
  fs::path file = folder_ / fmt::format("{}{}", name, ending);
  std::error_code error;
  if (!replace && fs::exists(fs::symlink_status(file, error)))
    throw RequestError(409, fmt::format("{} is there already; choose another name, or replace it",
                                        file.filename().string()));
  return file;
}

std::optional<fs::path> Workspace::regular_file(const std::string& name) const {
  std::error_code error;
  const fs::path file = folder_ / name;
  // What is its own canonical name holds neither a link nor a step up.
  if (fs::path(name).is_absolute() || fs::canonical(file, error) != file || error) return std::nullopt;
  if (!fs::is_regular_file(fs::symlink_status(file, error))) return std::nullopt;
  return file;
}

std::string Workspace::id_of(const fs::path& file) const {
  const fs::path relative = fs::weakly_canonical(file).lexically_relative(folder_);
  if (relative.empty() || *relative.begin() == "..")
    throw std::invalid_argument(fmt::format("{} is not in {}", file.string(), folder_.string()));
  return id_of_name(relative.generic_string());
}

}  // namespace kerf::bench
