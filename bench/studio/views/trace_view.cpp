#include "views/trace_view.h"

#include <array>
#include <bit>
#include <cstdint>
#include <span>

namespace kerf::bench {
namespace {

static_assert(std::endian::native == std::endian::little);

template <typename Value>
void append(std::string& bytes, std::span<const Value> values) {
  bytes.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
}

}  // namespace

std::string bytes_of(const TraceView& view) {
  const std::uint32_t sizes[]{static_cast<std::uint32_t>(view.time_s.size()),
                              static_cast<std::uint32_t>(view.traces.size())};
  std::string bytes;
  bytes.reserve(32 + view.time_s.size() * (8 + 8 * view.traces.size()));
  append<std::uint32_t>(bytes, sizes);
  append<double>(bytes, std::array{view.rows_per_column, view.rows_looked_at, view.prepared});
  append<double>(bytes, view.time_s);
  for (const TraceView::Extremes& it : view.traces) {
    append<float>(bytes, it.smallest);
    append<float>(bytes, it.largest);
  }
  return bytes;
}

}  // namespace kerf::bench
