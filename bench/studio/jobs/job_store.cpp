#include "jobs/job_store.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <fstream>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <system_error>

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/file.h>

#include "files/whole_file.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view log_cut_off = "\nThe log is longer than this; the rest is left out.\n";

/// 12 of "12.json".
std::optional<std::size_t> job_number_of(const fs::path& file) {
  if (file.extension() != ".json") return std::nullopt;
  const std::string stem = file.stem().string();
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(stem.data(), stem.data() + stem.size(), number);
  if (error != std::errc() || end != stem.data() + stem.size()) return std::nullopt;
  return number;
}

JobRecord kept_record_in(const fs::path& file, std::size_t number) {
  try {
    JobRecord record = job_record_in(read_whole_file(file));
    record.number = number;
    if (!record.has_ended()) record.state = record.state_without_studio();
    return record;
  } catch (const std::exception& error) {
    return {.number = number,
            .kind = "unknown",
            .title = fmt::format("Job {}", number),
            .state = JobState::failed,
            .error = fmt::format("its record cannot be read: {}", error.what())};
  }
}

}  // namespace

fs::path state_folder_of(const fs::path& workspace) { return workspace / ".kerf-studio"; }

fs::path JobStore::file(std::size_t job, std::string_view ending) const {
  return folder_ / fmt::format("{}{}", job, ending);
}

void JobStore::take() {
  if (lock_.number() >= 0) return;
  fs::create_directories(folder_);
  const fs::path lock = folder_ / "lock";
  processes::Descriptor opened(open(lock.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600));
  if (opened.number() < 0) throw std::system_error(errno, std::generic_category(), lock.string());
  if (flock(opened.number(), LOCK_EX | LOCK_NB) != 0) {
    throw std::runtime_error(
        "another studio works in this folder, and its jobs are kept there; end it, or give this one a folder "
        "of its own");
  }
  lock_ = std::move(opened);
}

std::vector<JobRecord> JobStore::load() {
  std::vector<JobRecord> records;
  std::error_code none;
  if (folder_.empty() || !fs::is_directory(folder_, none)) return records;
  try {
    take();
    for (const auto& entry : fs::directory_iterator(folder_)) {
      if (const auto number = job_number_of(entry.path()))
        records.push_back(kept_record_in(entry.path(), *number));
    }
  } catch (const std::exception&) {
    return {};  // keep() says why
  }
  std::ranges::sort(records, {}, &JobRecord::number);
  return records;
}

std::string JobStore::keep(const JobRecord& record) {
  if (folder_.empty()) return "";
  try {
    take();
    write_whole_file(file(record.number, ".json"),
                     to_json(record).dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
    return "";
  } catch (const std::exception& error) {
    return error.what();
  }
}

std::string JobStore::append(std::size_t job, std::string_view text) {
  if (folder_.empty() || lock_.number() < 0) return "";  // keep() has said so
  const fs::path log = file(job, ".log");
  std::error_code absent;
  const auto there = fs::file_size(log, absent);
  const std::size_t length = absent ? 0 : static_cast<std::size_t>(there);
  if (length >= longest_log) return "";
  const std::size_t room = longest_log - length;
  std::ofstream stream(log, std::ios::binary | std::ios::app);
  stream << text.substr(0, room);
  if (text.size() >= room) stream << log_cut_off;
  stream.close();
  return stream ? "" : fmt::format("{}: {}", log.string(), std::strerror(errno));
}

std::string JobStore::log_of(std::size_t job) const {
  std::ifstream stream(file(job, ".log"), std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

void JobStore::forget(std::size_t job) {
  std::error_code ignored;  // what cannot be removed is there again after the next start
  fs::remove(file(job, ".json"), ignored);
  fs::remove(file(job, ".log"), ignored);
}

}  // namespace kerf::bench
