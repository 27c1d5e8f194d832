#include "recordings/whole_recording.h"

#include <cstdint>
#include <system_error>

#include "files/memory_room.h"

namespace kerf::bench {
namespace {

/// Memory for a recording and for what is made of its rows, by the size of its file: of 10^6 rows a fit took
/// 4.2 times as much, a preparation 2.1 times.
constexpr std::uintmax_t times_its_file = 5;
/// A file so small is read by whatever machine runs this.
constexpr std::uintmax_t worth_asking = std::uintmax_t{16} << 20U;

}  // namespace

schema::Recording read_whole_recording(const std::filesystem::path& file) {
  std::error_code unknown;  // reading it says why
  const std::uintmax_t bytes = std::filesystem::file_size(file, unknown);
  if (!unknown && bytes > worth_asking) require_memory(file, times_its_file * bytes, "all rows at once");
  return schema::read_recording(file);
}

}  // namespace kerf::bench
