#include "intake/uploads.h"

#include <algorithm>
#include <cerrno>
#include <string>
#include <system_error>

#include <fcntl.h>
#include <fmt/core.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "files/in_gibibytes.h"
#include "files/whole_file.h"
#include "http/routes.h"
#include "recordings/provenance.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t longest_name = 255;  // bytes, of a file's name on Linux
constexpr std::uintmax_t room_to_leave = std::uintmax_t{64} << 20U;
constexpr std::string_view about_name = "about.json";

bool is_id(std::string_view id) {
  return id.size() == 16 &&
         std::ranges::all_of(id, [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); });
}

void check_name(const std::string& name) {
  if (!name.empty() && name.size() <= longest_name && name != "." && name != ".." &&
      name.find('/') == std::string::npos && name.find('\0') == std::string::npos)
    return;
  throw RequestError(400, fmt::format("'{}' is no name of a file; expected 1 to {} bytes without '/'",
                                      name.substr(0, longest_name), longest_name));
}

[[noreturn]] void refuse_full_disk(const Upload& upload, std::uintmax_t room) {
  throw RequestError(
      507,
      fmt::format("{}: its rest needs {} on the disk of the workspace, and {} can be had: free some and go "
                  "on, or import it where it lies: kerf import",
                  upload.name, in_gibibytes(upload.bytes - upload.have), in_gibibytes(room)));
}

void require_room(const Upload& upload, const fs::path& folder) {
  std::error_code unknown;
  const std::uintmax_t room = fs::space(folder, unknown).available;
  if (!unknown && upload.bytes - upload.have + room_to_leave > room) refuse_full_disk(upload, room);
}

/// A file that is written at its end.
class GrowingFile {
 public:
  explicit GrowingFile(const fs::path& file)
      : file_(file), descriptor_(::open(file.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0644)) {
    if (descriptor_ < 0) throw std::system_error(errno, std::generic_category(), file.string());
  }
  GrowingFile(const GrowingFile&) = delete;
  GrowingFile& operator=(const GrowingFile&) = delete;
  ~GrowingFile() { ::close(descriptor_); }

  /// All of the piece, or nothing: an error number then.
  [[nodiscard]] int write(std::uintmax_t at, std::string_view piece) const {
    std::size_t done = 0;
    while (done < piece.size()) {
      const ssize_t written =
          ::pwrite(descriptor_, piece.data() + done, piece.size() - done, static_cast<off_t>(at + done));
      if (written < 0 && errno == EINTR) continue;
      if (written > 0) {
        done += static_cast<std::size_t>(written);
        continue;
      }
      const int error = written < 0 ? errno : ENOSPC;
      (void)::ftruncate(descriptor_, static_cast<off_t>(at));
      return error;
    }
    return 0;
  }

 private:
  fs::path file_;
  int descriptor_;
};

}  // namespace

fs::path Upload::data() const { return folder / "data" / name; }
fs::path Upload::head() const { return folder / "head" / name; }
fs::path Upload::result() const { return folder / "result.json"; }
fs::path Upload::errors() const { return folder / "errors.txt"; }
fs::path Upload::mapping() const { return folder / "mapping.import.toml"; }

Uploads::Uploads(const fs::path& workspace) : folder_(workspace / folder_name) {}

Upload Uploads::begin(const std::string& name, std::uintmax_t bytes, std::uint64_t modified_ms) {
  check_name(name);
  if (bytes > largest)
    throw RequestError(413, fmt::format("{}: {}; a page takes up to {}, kerf import at a terminal more", name,
                                        in_gibibytes(bytes), in_gibibytes(largest)));
  if (bytes == 0)
    throw RequestError(400, fmt::format("{}: the file is empty; expected lines of numbers", name));
  const std::string id =
      sha256_of(std::string_view(fmt::format("{}\n{}\n{}", name, bytes, modified_ms))).substr(0, 16);
  const fs::path folder = folder_ / id;
  fs::create_directories(folder / "data");
  fs::create_directories(folder / "head");
  if (!fs::exists(folder / about_name))
    write_whole_file(folder / about_name,
                     nlohmann::ordered_json{{"name", name}, {"bytes", bytes}}.dump(
                         -1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  Upload upload = find(id);
  require_room(upload, folder);
  return upload;
}

Upload Uploads::find(const std::string& id) const {
  const fs::path folder = folder_ / id;
  std::error_code error;
  if (is_id(id) && fs::is_regular_file(fs::symlink_status(folder / about_name, error))) {
    try {
      const auto about = nlohmann::json::parse(read_whole_file(folder / about_name));
      Upload upload{
          .id = id, .name = about.at("name"), .bytes = about.at("bytes"), .have = 0, .folder = folder};
      check_name(upload.name);
      if (fs::is_regular_file(fs::symlink_status(upload.data(), error)))
        upload.have = fs::file_size(upload.data(), error);
      return upload;
    } catch (const nlohmann::json::exception&) {  // as if it were not there
    }
  }
  throw RequestError(404, "that file is not on its way any more; drop it again");
}

Upload Uploads::append(const std::string& id, std::uintmax_t at, std::string_view piece) {
  Upload upload = find(id);
  if (at != upload.have)
    throw RequestError(409, fmt::format("{}: {} bytes have come, and this piece begins at {}", upload.name,
                                        upload.have, at));
  if (piece.size() > largest_piece || piece.size() > upload.bytes - upload.have)
    throw RequestError(
        413, fmt::format("{}: it is longer than the {} bytes that were told", upload.name, upload.bytes));
  const int error = GrowingFile(upload.data()).write(at, piece);
  if (error == ENOSPC || error == EDQUOT) {
    std::error_code unknown;
    refuse_full_disk(upload, fs::space(upload.folder, unknown).available);
  }
  if (error != 0) throw std::system_error(error, std::generic_category(), upload.name);
  upload.have += piece.size();
  return upload;
}

void Uploads::forget(const std::string& id) {
  if (!is_id(id)) return;
  std::error_code error;
  fs::remove_all(folder_ / id, error);
  if (fs::is_empty(folder_, error)) fs::remove(folder_, error);
}

std::vector<Upload> Uploads::all() const {
  std::vector<Upload> uploads;
  std::error_code error;
  for (fs::directory_iterator at(folder_, error); !error && at != fs::directory_iterator();
       at.increment(error)) {
    try {
      uploads.push_back(find(at->path().filename().string()));
    } catch (const RequestError&) {  // being made, or damaged
    }
  }
  std::ranges::sort(uploads, {}, &Upload::name);
  return uploads;
}

std::string as_named(std::string message, const Upload& upload) {
  for (const fs::path& path : {upload.data(), upload.head()}) {
    const std::string text = path.string();
    for (auto at = message.find(text); at != std::string::npos; at = message.find(text, at))
      message.replace(at, text.size(), upload.name);
  }
  std::ranges::replace(message, '\n', ' ');
  return message;
}

}  // namespace kerf::bench
