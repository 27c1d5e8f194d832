#include "import/import_many.h"

#include <algorithm>
#include <new>
#include <optional>
#include <stdexcept>

#include <fmt/core.h>

#include "files/file_names.h"
#include "import/text/imported_text.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

/// "a/punch.txt.gz" is "a/punch".
fs::path without_extensions(fs::path name) {
  if (name.extension() == ".gz") name.replace_extension();
  return name.has_stem() ? name.replace_extension() : name;
}

bool is_within(const fs::path& file, const fs::path& folder) {
  const fs::path whole = fs::absolute(file).lexically_normal();
  const fs::path above = fs::absolute(folder / "").lexically_normal();
  return std::mismatch(above.begin(), std::prev(above.end()), whole.begin(), whole.end()).first ==
         std::prev(above.end());
}

std::vector<fs::path> files_in(const fs::path& folder, const fs::path& output) {
  const auto is_hidden = [](const fs::path& path) { return path.filename().string().starts_with('.'); };
  std::vector<fs::path> files = files_within(
      folder, [&](const fs::path& within) { return !is_hidden(within) && !is_within(within, output); });
  std::erase_if(files, [&](const fs::path& file) {
    std::error_code unknown;
    return is_hidden(file) || (fs::is_symlink(file) && fs::is_directory(file, unknown));
  });
  if (files.empty()) throw std::invalid_argument(fmt::format("{}: a folder without a file", folder.string()));
  return files;
}

/// What is wrong, in one line that begins with the file.
std::string failure_of(const std::string& file, std::string what) {
  std::replace(what.begin(), what.end(), '\n', ' ');
  return what.starts_with(file) ? what : fmt::format("{}: {}", file, what);
}

template <typename Work>
auto or_failure(ImportEntry& entry, const Work& work) -> std::optional<decltype(work())> {
  try {
    return work();
  } catch (const std::bad_alloc&) {
    entry.failure = failure_of(entry.file, "there was not enough memory");
  } catch (const std::exception& error) {
    entry.failure = failure_of(entry.file, error.what());
  }
  return std::nullopt;
}

class ManyImports {
 public:
  explicit ManyImports(const ImportManyOptions& options) : options_(options) {}

  void take(const FileToImport& file) {
    ImportEntry entry{.file = file.file.string()};
    if (options_.trial_column.empty()) {
      add(std::move(entry), file.name, [&] { return import_text(file.file, options_.each); });
    } else {
      take_trials(file, std::move(entry));
    }
  }

  std::vector<ImportEntry> entries;

 private:
  void take_trials(const FileToImport& file, ImportEntry entry) {
    const std::size_t first = entries.size();
    const auto each = [&](const std::string& trial, const std::function<Imported()>& import) {
      add({.file = entry.file, .trial = trial}, fmt::format("{}_{}", file.name.string(), as_file_name(trial)),
          import);
    };
    std::exception_ptr not_written;
    const auto warnings = or_failure(entry, [&] {
      return import_trials(file.file, options_.trial_column, options_.each,
                           [&](const auto& trial, const auto& import) {
                             if (not_written) return;
                             try {
                               each(trial, import);
                             } catch (...) {
                               not_written = std::current_exception();
                             }
                           });
    });
    if (not_written) std::rethrow_exception(not_written);
    if (!warnings) {
      entries.push_back(std::move(entry));
    } else if (entries.size() > first) {
      for (const std::string& warning : *warnings) entries[first].about["warnings"].push_back(warning);
    }
  }

  /// What cannot be read is the entry's failure; what cannot be written is thrown.
  template <typename Import>
  void add(ImportEntry entry, const fs::path& name, const Import& import) {
    if (std::optional<Imported> imported = or_failure(entry, import)) {
      if (options_.look) {
        for (std::string& warning : options_.look(imported->recording))
          imported->warnings.push_back(std::move(warning));
      }
      entry.recording = names_.take(name).string() + ".h5";
      const fs::path file = options_.folder / entry.recording;
      fs::create_directories(file.parent_path());
      schema::write_recording(file, imported->recording, schema::Existing::keep);
      entry.about = imported_as_json(*imported);
    }
    entries.push_back(std::move(entry));
  }

  const ImportManyOptions& options_;
  NewNames names_;
};

}  // namespace

std::vector<FileToImport> files_to_import(const std::vector<std::string>& named, const fs::path& output) {
  std::vector<FileToImport> files;
  NewNames names;
  for (const std::string& one : named) {
    std::error_code unknown;
    if (!fs::is_directory(one, unknown)) {
      files.push_back({.file = one, .name = names.take(without_extensions(fs::path(one).filename()))});
      continue;
    }
    for (const fs::path& file : files_in(one, output))
      files.push_back({.file = file, .name = names.take(without_extensions(file.lexically_relative(one)))});
  }
  return files;
}

std::vector<ImportEntry> import_many(const std::vector<FileToImport>& files, const ImportManyOptions& options,
                                     const std::atomic<bool>& stop, std::atomic<std::size_t>& done) {
  ManyImports imports(options);
  for (const FileToImport& file : files) {
    if (stop) {
      imports.entries.push_back({.file = file.file.string(),
                                 .failure = file.file.string() + ": not begun: the import was stopped"});
    } else {
      imports.take(file);
    }
    ++done;
  }
  return std::move(imports.entries);
}

nlohmann::ordered_json imports_as_json(const std::vector<ImportEntry>& entries) {
  nlohmann::ordered_json result{{"recordings", nlohmann::ordered_json::array()},
                                {"failures", nlohmann::ordered_json::array()}};
  for (const ImportEntry& entry : entries) {
    nlohmann::ordered_json one{{"file", entry.file}};
    if (!entry.trial.empty()) one["trial"] = entry.trial;
    if (entry.failure.empty()) {
      one["recording"] = entry.recording;
      one.update(entry.about);
      result["recordings"].push_back(std::move(one));
    } else {
      one["reason"] = entry.failure;
      result["failures"].push_back(std::move(one));
    }
  }
  return result;
}

}  // namespace kerf::bench
