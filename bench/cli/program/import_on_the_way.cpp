#include "program/import_on_the_way.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include <fmt/core.h>
#include <unistd.h>

#include <kerf/fitting/jnd.h>
#include <kerf/schema/recording.h>
#include <kerf/schema/stand_in.h>

#include "files/kept_pipe.h"
#include "files/named_file.h"
#include "import/import.h"
#include "import/text/imported_text.h"
#include "imports/import_file.h"
#include "inspect/first_look.h"
#include "program/app.h"
#include "program/progress.h"
#include "recordings/provenance.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

/// A recording and every other file of Kerf; a MAT-file of 7.3 begins with a text of its own.
bool begins_as_hdf5(const std::string& file) {
  constexpr std::string_view signature = "\x89HDF\r\n\x1a\n";
  std::array<char, signature.size()> begin{};
  std::ifstream stream(file, std::ios::binary);
  stream.read(begin.data(), begin.size());
  return stream.gcount() == static_cast<std::streamsize>(begin.size()) &&
         std::string_view(begin.data(), begin.size()) == signature;
}

/// The same text by the same map is the same recording to every verb, so that `kerf report` knows what others
/// found of it: its UUID is made of what it holds (version 8 of RFC 9562).
std::string uuid_of(const schema::Recording& recording, const std::string& sha256) {
  const std::string content = content_sha256_of(schema::RowsInMemory(recording));
  const std::string digits = sha256_of(std::string_view(sha256 + content));
  return fmt::format("{}-{}-8{}-8{}-{}", digits.substr(0, 8), digits.substr(8, 4), digits.substr(12, 3),
                     digits.substr(15, 3), digits.substr(18, 12));
}

/// No signal ends the program while it stands: between the making of a file and its end as a name.
class NoSignals {
 public:
  NoSignals() {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_BLOCK, &all, &before_);
  }
  NoSignals(const NoSignals&) = delete;
  NoSignals& operator=(const NoSignals&) = delete;
  ~NoSignals() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

 private:
  sigset_t before_{};
};

/// A folder of its own that is removed with what is in it.
class ScratchFolder {
 public:
  ScratchFolder() : path_((fs::temp_directory_path() / "kerf-import-XXXXXX").string()) {
    if (mkdtemp(path_.data()) == nullptr)
      throw std::system_error(errno, std::generic_category(),
                              path_ + ": cannot be made, for what is imported on the way");
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  [[nodiscard]] fs::path operator/(const char* name) const { return fs::path(path_) / name; }

 private:
  std::string path_;
};

/// What `kerf import` reads, by its name; whatever else is no recording is told of by who reads it.
void refuse_table_without_map(const std::string& file) {
  static const std::set<std::string> tables{".csv",  ".dat", ".gz",  ".lvm", ".mat",
                                            ".tdms", ".tsv", ".txt", ".xls", ".xlsx"};
  std::string extension = fs::path(file).extension().string();
  std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return std::tolower(c); });
  std::error_code ignored;
  if (!tables.contains(extension) || !fs::is_regular_file(file, ignored) || begins_as_hdf5(file)) return;
  throw std::invalid_argument(fmt::format(
      "{}: not an HDF5 file; expected a recording, or say how a table is imported on the way: --map "
      "'time=COLUMN,position=COLUMN,force=COLUMN' (kerf import {} lists the columns)",
      file, file));
}

void import_one(const std::string& file, const ImportOptions& options, Context& context) {
  Imported imported = import_text(file, options);
  for (std::string& warning : first_look_of(imported.recording))
    imported.warnings.push_back(std::move(warning));
  const std::string sha256 = sha256_of(fs::path(file));
  imported.recording.header.uuid = uuid_of(imported.recording, sha256);
  nlohmann::ordered_json entry{{"file", file}, {"sha256", sha256}};
  entry.update(imported_as_json(imported));
  entry.erase("parse_seconds");
  for (const auto& warning : entry["warnings"]) warn(fmt::format("{}: {}", file, warning.get<std::string>()));
  context.imported.push_back(std::move(entry));
  const NoSignals until_it_has_no_name;
  const ScratchFolder folder;
  const fs::path scratch = folder / "imported.h5";
  schema::write_recording(scratch, imported.recording);
  schema::let_stand_in(file, scratch);
}

}  // namespace

void import_on_the_way(std::span<std::string> files, Context& context) {
  if (context.maps.empty()) {
    for (const std::string& file : files) refuse_table_without_map(file);
    return;
  }
  for (std::string& file : files) {
    if (file == "-") file = "/dev/stdin";
    // Verbs read a file again, for its hash.
    if (!file.empty()) keep_pipe(file, LargestInput::import);
  }
  std::vector<std::string> texts;
  std::ranges::copy_if(files, std::back_inserter(texts),
                       [](const std::string& file) { return !file.empty() && !begins_as_hdf5(file); });
  if (texts.empty())
    throw std::invalid_argument(
        files.empty() || files.front().empty()
            ? std::string("--map says how a text is imported on the way; expected one among the recordings")
            : fmt::format("--map says how a text is imported on the way, and {} is none; leave --map out",
                          files.front()));
  ImportOptions options = import_options_of(context.maps, {});
  options.progress = show_bar;
  for (const std::string& file : texts) import_one(file, options, context);
}

std::vector<std::string> first_look_of(const schema::Recording& recording) {
  const schema::Axis& axis = recording.axes.front();
  return first_look(recording, fitting::jnd_of(axis.force_unit, axis.lever).threshold);
}

void tell_imported_on_the_way(Context& context) {
  if (context.imported.empty()) return;
  if (context.result.is_null() || context.result.is_object())
    context.result["imported_on_the_way"] = context.imported;
}

void refuse_import_on_the_way(const std::string& verb, const std::string& file, const Context& context) {
  if (context.maps.empty()) return;
  throw std::invalid_argument(
      fmt::format("{0}: 'kerf {1}' changes the recording that it is given, and a text stays as it is; run "
                  "'kerf import {0} --map ... -o R.h5' first, then 'kerf {1} R.h5'",
                  file, verb));
}

}  // namespace kerf::bench
