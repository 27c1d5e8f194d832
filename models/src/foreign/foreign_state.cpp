#include <algorithm>
#include <array>
#include <cstring>
#include <stdexcept>
#include <string>

#include "kerf/models/foreign.h"

namespace kerf::models {
namespace {

constexpr std::size_t canary_size = 32;
constexpr auto canary = [] {
  std::array<std::byte, canary_size> bytes{};
  bytes.fill(std::byte{0xC5});
  return bytes;
}();

}  // namespace

ForeignState::Memory ForeignState::memory_of(std::size_t size, std::size_t alignment) {
  const std::size_t aligned = std::max(alignment, alignof(double));
  Memory memory(static_cast<std::byte*>(::operator new(size + canary_size, std::align_val_t(aligned))),
                {aligned});
  std::memset(memory.get(), 0, size);
  std::memcpy(memory.get() + size, canary.data(), canary_size);
  return memory;
}

ForeignState::ForeignState(const ForeignLaw& law, SteppedFor kind, std::span<const double> values)
    : size_(kind == SteppedFor::forces ? law.description().state_size
                                       : law.description().derivatives_state_size),
      memory_(memory_of(size_, kind == SteppedFor::forces ? law.description().state_alignment
                                                          : law.description().derivatives_state_alignment)) {
  const kerf_law_v1& description = law.description();
  const auto init = kind == SteppedFor::forces ? description.init : description.init_derivatives;
  if (init == nullptr || init(values.data(), bytes()) == 0) return;
  throw std::invalid_argument("law '" + std::string(law.info().name) +
                              "': its plug-in says that these parameters make no law");
}

ForeignState::ForeignState(const ForeignState& other)
    : size_(other.size_), memory_(memory_of(size_, other.memory_.get_deleter().alignment)) {
  assign(other);
}

void ForeignState::assign(const ForeignState& other) noexcept {
  std::memcpy(memory_.get(), other.memory_.get(), size_ + canary_size);
}

bool ForeignState::is_intact() const noexcept {
  return std::memcmp(memory_.get() + size_, canary.data(), canary_size) == 0;
}

}  // namespace kerf::models
