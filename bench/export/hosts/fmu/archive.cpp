#include "hosts/fmu/archive.h"

#include <cstddef>
#include <memory>
#include <stdexcept>

#include <zip.h>

namespace kerf::bench {
namespace {

struct Source {
  explicit Source(std::string_view bytes) {
    zip_error_t error{};
    source = zip_source_buffer_create(bytes.data(), bytes.size(), 0, &error);
    if (source == nullptr) throw std::runtime_error(std::string("zip: ") + zip_error_strerror(&error));
    zip_source_keep(source);
  }
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;
  ~Source() { zip_source_free(source); }

  zip_source_t* source = nullptr;
};

struct Discard {
  void operator()(zip_t* archive) const noexcept { zip_discard(archive); }
};
using Archive = std::unique_ptr<zip_t, Discard>;

Archive open(Source& of, int flags) {
  zip_error_t error{};
  Archive archive(zip_open_from_source(of.source, flags, &error));
  if (archive == nullptr) throw std::invalid_argument(std::string("zip: ") + zip_error_strerror(&error));
  return archive;
}

[[noreturn]] void fail(const Archive& archive) {
  throw std::runtime_error(std::string("zip: ") + zip_strerror(archive.get()));
}

void add(const Archive& archive, const HostFile& file) {
  zip_source_t* const bytes = zip_source_buffer(archive.get(), file.content.data(), file.content.size(), 0);
  if (bytes == nullptr) fail(archive);
  const zip_int64_t index = zip_file_add(archive.get(), file.name.c_str(), bytes, ZIP_FL_ENC_UTF_8);
  if (index < 0) {
    zip_source_free(bytes);
    fail(archive);
  }
  const auto place = static_cast<zip_uint64_t>(index);
  constexpr zip_uint16_t first_day_of_1980 = 0x21;
  if (zip_set_file_compression(archive.get(), place, ZIP_CM_DEFLATE, 9) != 0 ||
      zip_file_set_dostime(archive.get(), place, 0, first_day_of_1980, 0) != 0)
    fail(archive);
}

std::string bytes_of(zip_source_t* source) {
  zip_stat_t facts{};
  if (zip_source_stat(source, &facts) != 0 || zip_source_open(source) != 0)
    throw std::runtime_error("zip: the archive cannot be read back");
  std::string bytes(facts.size, '\0');
  const zip_int64_t count = zip_source_read(source, bytes.data(), bytes.size());
  zip_source_close(source);
  if (count < 0 || static_cast<std::size_t>(count) != bytes.size())
    throw std::runtime_error("zip: the archive cannot be read back");
  return bytes;
}

}  // namespace

std::string zipped(const std::vector<HostFile>& files) {
  Source target({});
  Archive archive = open(target, ZIP_TRUNCATE);
  for (const HostFile& file : files) add(archive, file);
  if (zip_close(archive.get()) != 0) fail(archive);
  static_cast<void>(archive.release());  // closed
  return bytes_of(target.source);
}

std::vector<HostFile> unzipped(std::string_view bytes) {
  Source source(bytes);
  const Archive archive = open(source, ZIP_RDONLY);
  std::vector<HostFile> files;
  for (zip_int64_t i = 0; i < zip_get_num_entries(archive.get(), 0); ++i) {
    zip_stat_t facts{};
    const auto place = static_cast<zip_uint64_t>(i);
    if (zip_stat_index(archive.get(), place, 0, &facts) != 0) fail(archive);
    const std::unique_ptr<zip_file_t, decltype([](zip_file_t* file) { zip_fclose(file); })> file(
        zip_fopen_index(archive.get(), place, 0));
    std::string content(facts.size, '\0');
    if (file == nullptr ||
        zip_fread(file.get(), content.data(), content.size()) != static_cast<zip_int64_t>(content.size()))
      fail(archive);
    files.push_back({facts.name, std::move(content)});
  }
  return files;
}

}  // namespace kerf::bench
