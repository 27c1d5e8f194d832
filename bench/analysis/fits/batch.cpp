#include "fits/batch.h"

#include <algorithm>
#include <new>
#include <stdexcept>
#include <system_error>

#include <fmt/core.h>

#include "files/file_names.h"
#include "files/whole_folder.h"
#include "fits/fit_files.h"
#include "recordings/whole_recording.h"
#include "threads/for_each_index.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

void fit_one(BatchEntry& entry, const fs::path& file, const BatchOptions& batch) {
  const schema::Recording recording = read_whole_recording(file);
  const FitSource source = batch.source(recording);
  const FitRecordingOptions options = batch.options(source);
  const fs::path folder = batch.output / fs::path(entry.recording).replace_extension();
  if (!batch.replace) refuse_to_replace_fits(options, folder);
  entry.fit = fit_recordings(std::span(&source, 1), options);
  if (entry.fit.laws.empty()) {
    const std::string reason = entry.fit.refusal();
    throw std::invalid_argument(reason.empty() ? "no law could be fitted" : reason);
  }
  WholeFolder whole(folder, schema::existing_if(batch.replace));
  write_fits(entry.fit, file, whole.path());
  whole.commit();
  if (std::none_of(entry.fit.laws.begin(), entry.fit.laws.end(),
                   [](const FittedLaw& law) { return law.result.converged; })) {
    throw std::invalid_argument("no law converged");
  }
}

}  // namespace

std::vector<fs::path> recordings_in(const fs::path& folder) {
  std::vector<fs::path> files = files_within(folder);
  std::erase_if(files, [](const fs::path& file) {
    std::error_code ignored;
    const bool is_recording = fs::is_regular_file(file, ignored) && file.extension() == ".h5";
    const bool is_locked_folder = fs::is_directory(file, ignored) && !fs::is_symlink(file);
    return !is_recording && !is_locked_folder;
  });
  if (files.empty()) {
    throw std::invalid_argument(
        fmt::format("{}: holds no recordings (*.h5); 'kerf import' makes them from text", folder.string()));
  }
  return files;
}

std::vector<BatchEntry> run_batch(const std::vector<fs::path>& recordings, const BatchOptions& options,
                                  const std::atomic<bool>& stop, std::atomic<std::size_t>& done) {
  std::vector<BatchEntry> entries(recordings.size());
  for (std::size_t i = 0; i < entries.size(); ++i) {
    entries[i].recording = recordings[i].lexically_relative(options.folder).generic_string();
  }
  for_each_index(entries.size(), options.jobs, [&](std::size_t i) {
    try {
      if (stop) throw std::runtime_error("not begun: the batch was stopped");
      fit_one(entries[i], recordings[i], options);
    } catch (const std::bad_alloc&) {
      entries[i].failure = "there was not enough memory";
    } catch (const std::exception& error) {
      entries[i].failure = error.what();
    }
    ++done;
  });
  return entries;
}

}  // namespace kerf::bench
