#include "verbs/made_files.h"

#include <algorithm>
#include <array>
#include <tuple>

#include <kerf/schema/unfinished.h>

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

constexpr int deepest_made = 2;
constexpr std::size_t most_made = 500;
constexpr int deepest_offered = 4;
constexpr std::size_t most_offered = 20'000;

struct MadeKind {
  std::string_view ending;
  std::string_view what;
  std::string_view type;
};
constexpr std::array made_kinds{MadeKind{".html", "page", "text/html; charset=utf-8"},
                                MadeKind{".svg", "picture", "image/svg+xml"},
                                MadeKind{".png", "picture", "image/png"},
                                MadeKind{".csv", "table", "text/csv; charset=utf-8"},
                                MadeKind{".json", "text", "text/plain; charset=utf-8"},
                                MadeKind{".toml", "text", "text/plain; charset=utf-8"},
                                MadeKind{".txt", "text", "text/plain; charset=utf-8"},
                                MadeKind{".md", "text", "text/plain; charset=utf-8"},
                                MadeKind{".xml", "text", "text/plain; charset=utf-8"}};

std::size_t made_kind_of(const std::string& name) {
  const auto found =
      std::ranges::find_if(made_kinds, [&](const MadeKind& kind) { return name.ends_with(kind.ending); });
  return static_cast<std::size_t>(found - made_kinds.begin());
}

void add_made_file(const Workspace& workspace, const fs::path& path, std::vector<MadeFile>& made) {
  std::error_code error;
  if (made.size() >= most_made || !fs::is_regular_file(fs::symlink_status(path, error))) return;
  MadeFile file{.name = path.lexically_relative(workspace.folder()).generic_string(),
                .path = path,
                .bytes = fs::file_size(path, error),
                .what = "other",
                .type = "application/octet-stream"};
  if (const std::size_t kind = made_kind_of(file.name); kind < made_kinds.size()) {
    file.what = made_kinds[kind].what;
    file.type = made_kinds[kind].type;
  }
  made.push_back(std::move(file));
}

}  // namespace

std::vector<MadeFile> made_files(const Workspace& workspace, const std::vector<std::string>& outputs) {
  std::vector<MadeFile> made;
  std::error_code error;
  for (const std::string& output : outputs) {
    const fs::path path = workspace.folder() / output;
    if (fs::path(output).has_parent_path() || fs::is_symlink(path, error)) continue;
    if (!fs::is_directory(path, error)) {
      add_made_file(workspace, path, made);
      continue;
    }
    fs::recursive_directory_iterator at(path, error);
    for (; !error && at != fs::recursive_directory_iterator(); at.increment(error)) {
      if (at.depth() >= deepest_made || at->is_symlink(error)) at.disable_recursion_pending();
      add_made_file(workspace, at->path(), made);
    }
  }
  std::ranges::sort(made, {}, [](const MadeFile& it) {
    return std::tuple(std::ranges::count(it.name, '/'), made_kind_of(it.name), it.name);
  });
  return made;
}

OfferedNames offered_names(const Workspace& workspace) {
  OfferedNames names;
  std::error_code error;
  fs::recursive_directory_iterator at(workspace.folder(), fs::directory_options::skip_permission_denied,
                                      error);
  for (; !error && at != fs::recursive_directory_iterator(); at.increment(error)) {
    const bool hidden = at->path().filename().string().starts_with('.') || schema::is_unfinished(at->path());
    const bool link = at->is_symlink(error);
    if (hidden || link || at.depth() >= deepest_offered) at.disable_recursion_pending();
    if (hidden || link) continue;
    if (names.files.size() + names.folders.size() >= most_offered) break;
    std::string name = at->path().lexically_relative(workspace.folder()).generic_string();
    if (at->is_directory(error)) {
      names.folders.push_back(std::move(name));
    } else if (at->is_regular_file(error)) {
      names.files.push_back(std::move(name));
    }
    error.clear();  // a file that has just gone
  }
  std::ranges::sort(names.files);
  std::ranges::sort(names.folders);
  return names;
}

}  // namespace kerf::bench
