#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace kerf::law_trial {

/// Memory for a plug-in whose last byte lies before a page that nobody may touch. Who does is named by the
/// handler of watch_for_faults(); what is written beside it, where alignment leaves room, by is_damaged().
class GuardedBlock {
 public:
  /// @param what it is, of static life: "its state of 16 bytes"
  GuardedBlock(std::size_t size, std::size_t alignment, const std::string& what);
  [[nodiscard]] void* bytes() const noexcept { return begin_; }
  [[nodiscard]] bool is_damaged() const noexcept;
  /// From now on nobody writes to it.
  void make_read_only() const noexcept;
  void clear() const noexcept;

 private:
  std::byte* pages_;
  std::byte* begin_;
  std::byte* guard_;
  std::size_t size_;
};

/// Turns a fault at a guarded block into a refusal that names it.
void watch_for_faults();

}  // namespace kerf::law_trial
