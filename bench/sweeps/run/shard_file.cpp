#include "run/shard_file.h"

#include <cerrno>
#include <stdexcept>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>
#include <unistd.h>

#include <kerf/schema/final_name.h>
#include <kerf/version.h>

#include "files/mapped_file.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;
using json = nlohmann::ordered_json;

constexpr std::string_view format_of_shards = "kerf.shard 1";
constexpr std::uint64_t shards_a_folder = 1000;

[[noreturn]] void throw_errno(const fs::path& file, const char* what) {
  throw std::system_error(errno, std::generic_category(), fmt::format("{}: {}", file.string(), what));
}

void synchronise_folder(const fs::path& folder) {
  const processes::Descriptor opened(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (opened.number() >= 0) (void)::fsync(opened.number());  // some file systems refuse it of a folder
}

[[noreturn]] void refuse_shard(const fs::path& file, std::string_view why) {
  throw std::invalid_argument(fmt::format("{}: {}", file.string(), why));
}

ShardContent content_from(const HeadRecord& head, const fs::path& file) {
  try {
    const json all = json::parse(head.json);
    if (all.at("format") != format_of_shards) refuse_shard(file, "it is a shard of another version");
    return {.plan_sha256 = all.at("plan").get<std::string>(),
            .software = all.at("software").get<std::string>(),
            .name = {.shard = all.at("shard").get<std::uint64_t>(),
                     .shards = all.at("shards").get<std::uint64_t>()}};
  } catch (const json::exception&) {
    refuse_shard(file, "it is no shard of a sweep");
  }
}

}  // namespace

fs::path ShardName::place_in(const fs::path& folder) const {
  const std::string name = fmt::format("{}-of-{}.shard", shard, shards);
  return shards > shards_a_folder ? folder / std::to_string(shard / shards_a_folder) / name : folder / name;
}

std::string ShardName::in_words() const { return fmt::format("shard {} of {}", shard, shards); }

fs::path partial_shard(fs::path place) {
  place += ".partial";
  return place;
}

ShardContent read_shard(const fs::path& file,
                        const std::function<void(const CellRecord&, std::uintmax_t at)>& take) {
  const MappedFile mapped(file);
  ShardContent content = read_shard(mapped.text(), file, take);
  mapped.require_whole();
  return content;
}

ShardContent read_shard(std::string_view bytes, const fs::path& file,
                        const std::function<void(const CellRecord&, std::uintmax_t at)>& take) {
  std::string_view left = bytes;
  ShardContent content;
  bool begun = false;
  std::uintmax_t at = 0;
  while (const auto frame = first_frame(left)) {
    const auto* const head = std::get_if<HeadRecord>(&frame->record);
    if (!begun && head == nullptr) break;
    if (!begun) content = content_from(*head, file);
    begun = true;
    if (head == nullptr) take(frame->record, at);
    at += frame->size;
    left.remove_prefix(frame->size);
  }
  if (!begun && !bytes.empty() && !may_become_frame(bytes))
    refuse_shard(file, "it is no shard of a sweep, or damaged from its beginning on");
  content.whole_bytes = at;
  content.bytes = bytes.size();
  return content;
}

ShardWriter::ShardWriter(const PlanFile& plan, const ShardName& name, const fs::path& place,
                         const std::function<void(const CellRecord&)>& take)
    : place_(place), path_(partial_shard(place)) {
  descriptor_ = processes::Descriptor(::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666));
  if (descriptor_.number() < 0) throw_errno(path_, "cannot be opened for writing");
  struct stat about {};
  if (::fstat(descriptor_.number(), &about) != 0) throw_errno(path_, "cannot be looked at");
  if (about.st_size > 0) go_on(plan, name, take);
  if (bytes_ == 0) begin(plan, name);
}

void ShardWriter::begin(const PlanFile& plan, const ShardName& name) {
  std::string head;
  add_head(head, json{{"format", format_of_shards},
                      {"plan", plan.sha256},
                      {"shard", name.shard},
                      {"shards", name.shards},
                      {"software", software()}}
                     .dump());
  append(head);
  synchronise();
  synchronise_folder(path_.parent_path());
}

void ShardWriter::go_on(const PlanFile& plan, const ShardName& name,
                        const std::function<void(const CellRecord&)>& take) {
  const ShardContent content = read_shard(path_, [&](const CellRecord& record, std::uintmax_t) {
    if (const auto* const layout = std::get_if<LayoutRecord>(&record)) layouts_.insert(layout->layout);
    take(record);
  });
  if (content.whole_bytes > 0) {
    if (content.plan_sha256 != plan.sha256)
      refuse_shard(path_, "it is of another plan; the plan was changed since, remove the file to begin anew");
    if (content.name.shard != name.shard || content.name.shards != name.shards)
      refuse_shard(path_, fmt::format("it is of {}", content.name.in_words()));
    if (content.software != software())
      refuse_shard(path_,
                   fmt::format("it was begun by {}, and this is {}; go on with that, or remove the file",
                               content.software, software()));
  }
  if (content.whole_bytes < content.bytes &&
      ::ftruncate(descriptor_.number(), static_cast<off_t>(content.whole_bytes)) != 0)
    throw_errno(path_, "what is not whole at its end cannot be cut off");
  bytes_ = content.whole_bytes;
}

void ShardWriter::append(std::string_view frames) {
  std::size_t written = 0;
  while (written < frames.size()) {
    const auto count = ::pwrite(descriptor_.number(), frames.data() + written, frames.size() - written,
                                static_cast<off_t>(bytes_ + written));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) {
      const int why = errno;
      (void)::ftruncate(descriptor_.number(), static_cast<off_t>(bytes_));  // else the next run cuts it off
      errno = why;
      throw_errno(path_, "cannot be written");
    }
    written += static_cast<std::size_t>(count);
  }
  bytes_ += frames.size();
  synchronised_ = frames.empty() && synchronised_;
}

void ShardWriter::require_layout(std::uint64_t layout, std::string_view text) {
  if (!layouts_.insert(layout).second) return;
  std::string frame;
  add_layout(frame, layout, text);
  append(frame);
}

void ShardWriter::synchronise() {
  if (synchronised_) return;
  if (::fdatasync(descriptor_.number()) != 0) throw_errno(path_, "cannot be brought to the disk");
  synchronised_ = true;
}

void ShardWriter::finish() {
  if (::fsync(descriptor_.number()) != 0) throw_errno(path_, "cannot be brought to the disk");
  if (::close(descriptor_.release()) != 0) throw_errno(path_, "cannot be brought to the disk");
  if (::rename(path_.c_str(), place_.c_str()) != 0) {
    const int why = errno;
    // A server that did it, and whose answer was lost, is asked again and then finds no such file.
    if (why != ENOENT || !fs::exists(place_)) {
      errno = why;
      throw_errno(place_, "cannot have this name");
    }
  }
  synchronise_folder(place_.parent_path());
}

}  // namespace kerf::bench
