#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace kerf::bench {

/// Values that are too many to be kept, seen as if they were: whoever asks for one has the block read or
/// computed that it lies in. The last two blocks stay, so that who goes through all of them, looking back
/// over a block's begin, has each read once.
class BlockedValues {
 public:
  static constexpr std::size_t block = 65536;

  /// Gives the values from `first`, where a block begins, to its end or the last one.
  using Read = std::function<void(std::uint64_t first, std::span<double> values)>;

  BlockedValues(std::uint64_t size, Read read) : size_(size), read_(std::move(read)) {}
  BlockedValues(const BlockedValues&) = delete;
  BlockedValues& operator=(const BlockedValues&) = delete;
  ~BlockedValues() = default;

  [[nodiscard]] std::uint64_t size() const noexcept { return size_; }

  /// Requires at < size().
  [[nodiscard]] double operator[](std::uint64_t at) const {
    if (at / block != recent_->number) take(at / block);
    return recent_->values[static_cast<std::size_t>(at % block)];
  }

 private:
  struct Block {
    std::uint64_t number = std::numeric_limits<std::uint64_t>::max();
    std::vector<double> values{};
  };

  void take(std::uint64_t number) const {
    recent_ = recent_ == blocks_.data() ? &blocks_[1] : blocks_.data();
    if (recent_->number == number) return;
    recent_->number = std::numeric_limits<std::uint64_t>::max();  // as long as it is not whole
    const std::uint64_t first = number * block;
    recent_->values.resize(static_cast<std::size_t>(std::min<std::uint64_t>(block, size_ - first)));
    read_(first, recent_->values);
    recent_->number = number;
  }

  std::uint64_t size_;
  Read read_;
  mutable std::array<Block, 2> blocks_;
  mutable Block* recent_ = blocks_.data();
};

}  // namespace kerf::bench
