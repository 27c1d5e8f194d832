#include "views/rows/view_cache.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <sys/stat.h>

#include "files/mapped_file.h"
#include "files/whole_file.h"

namespace kerf::bench {
namespace {

constexpr std::uint64_t magic = 0x325259504652454bU;  // "KERFPYR2"; another number for another layout

/// The begin of a file; the bytes of the part follow.
struct Head {
  std::uint64_t magic_number = magic;
  FileFacts recording;
  std::array<char, 40> part{};  ///< its name, of which so much as has room
  std::array<char, 40> uuid{};
  std::uint64_t rows = 0;
  std::uint64_t bytes = 0;
  std::uint64_t checksum = 0;  ///< of all before
};
static_assert(sizeof(Head) % alignof(double) == 0 && sizeof(Head) == 3 * 8 + 8 + 2 * 40 + 3 * 8);

/// FNV-1a.
std::uint64_t checksum_of(const Head& head) {
  std::uint64_t sum = 0xcbf29ce484222325U;
  const auto* byte = reinterpret_cast<const unsigned char*>(&head);
  for (std::size_t i = 0; i < offsetof(Head, checksum); ++i) sum = (sum ^ byte[i]) * 0x100000001b3U;
  return sum;
}

std::array<char, 40> fixed(std::string_view text) {
  std::array<char, 40> room{};
  std::copy_n(text.begin(), std::min(text.size(), room.size()), room.begin());
  return room;
}

std::string text_of_room(const std::array<char, 40>& room) {
  return {room.begin(), std::find(room.begin(), room.end(), '\0')};
}

}  // namespace

FileFacts FileFacts::of(const std::filesystem::path& file) {
  struct stat facts {};
  if (stat(file.c_str(), &facts) != 0) {
    throw std::system_error(errno, std::generic_category(), "cannot read " + file.string());
  }
  constexpr std::int64_t ns_a_second = 1'000'000'000;
  return {.inode = facts.st_ino,
          .size = static_cast<std::uint64_t>(facts.st_size),
          .changed_ns = facts.st_mtim.tv_sec * ns_a_second + facts.st_mtim.tv_nsec};
}

std::filesystem::path ViewCache::usual_folder() {
  const char* const folder = std::getenv("XDG_CACHE_HOME");
  const char* const home = std::getenv("HOME");
  if (folder != nullptr && *folder != '\0') return std::filesystem::path(folder) / "kerf" / "pyramids";
  if (home == nullptr || *home == '\0') return {};
  return std::filesystem::path(home) / ".cache" / "kerf" / "pyramids";
}

ViewCache::ViewCache(std::filesystem::path folder, std::uintmax_t max_bytes)
    : folder_(std::move(folder)), max_bytes_(max_bytes) {}

std::filesystem::path ViewCache::file_of(const FileFacts& recording, std::string_view name) const {
  // A channel may be called whatever it likes; its part is told by the head as well.
  Head head{.recording = recording, .part = fixed(name)};
  const std::uint64_t sum = checksum_of(head);
  return folder_ / fmt::format("{:016x}-{:016x}", recording.inode, sum);
}

std::optional<ViewCache::Part> ViewCache::find(const FileFacts& recording, std::string_view name) const {
  if (folder_.empty()) return std::nullopt;
  try {
    const auto file = file_of(recording, name);
    const auto mapped = std::make_shared<const MappedFile>(file);
    Head head;
    if (mapped->text().size() < sizeof head) return std::nullopt;
    std::memcpy(&head, mapped->text().data(), sizeof head);
    if (head.magic_number != magic || head.checksum != checksum_of(head) || head.recording != recording ||
        head.part != fixed(name) || head.bytes != mapped->text().size() - sizeof head) {
      return std::nullopt;
    }
    std::error_code ignored;  // the time of its last use, by which the oldest are found
    std::filesystem::last_write_time(file, std::filesystem::file_time_type::clock::now(), ignored);
    return Part{.uuid = text_of_room(head.uuid),
                .rows = head.rows,
                .bytes = std::as_bytes(std::span(mapped->text())).subspan(sizeof head),
                .owner = mapped};
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

void ViewCache::keep(const FileFacts& recording, std::string_view name, const Part& part) const {
  if (folder_.empty()) return;
  Head head{.recording = recording, .part = fixed(name), .uuid = fixed(part.uuid)};
  head.rows = part.rows;
  head.bytes = part.bytes.size();
  head.checksum = checksum_of(head);
  try {
    std::filesystem::create_directories(folder_);
    const auto text = [](const void* bytes, std::size_t count) {
      return std::string_view(static_cast<const char*>(bytes), count);
    };
    write_whole_file(file_of(recording, name),
                     std::array{text(&head, sizeof head), text(part.bytes.data(), part.bytes.size())});
    remove_oldest();
  } catch (const std::exception&) {
    // A view is made anew the next time.
  }
}

void ViewCache::remove_oldest() const {
  struct Kept {
    std::filesystem::file_time_type used;
    std::uintmax_t bytes;
    std::filesystem::path file;
  };
  std::vector<Kept> kept;
  std::uintmax_t total = 0;
  const std::filesystem::directory_iterator folder(folder_);
  for (auto entry = begin(folder); entry != end(folder); ++entry) {
    std::error_code gone;
    const auto bytes = entry->file_size(gone);
    const auto used = gone ? std::filesystem::file_time_type{} : entry->last_write_time(gone);
    if (gone) continue;
    kept.push_back({.used = used, .bytes = bytes, .file = entry->path()});
    total += bytes;
  }
  std::sort(kept.begin(), kept.end(), [](const Kept& a, const Kept& b) { return a.used < b.used; });
  for (const Kept& oldest : kept) {
    if (total <= max_bytes_) return;
    std::error_code ignored;
    std::filesystem::remove(oldest.file, ignored);
    total -= oldest.bytes;
  }
}

}  // namespace kerf::bench
