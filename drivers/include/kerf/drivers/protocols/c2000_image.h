#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

/// The stream that a TI C28x signal processor boots from over a serial line: what the image of a Falcon's
/// firmware is.
///
/// Words of 16 bits, low byte first: the key 0x08AA, eight reserved words, the entry point (two words, high
/// first), then blocks of {size in words, destination (two words, high first), that many words}; a size of
/// zero ends it.
///
/// Source: TI's description of the boot ROM (SCI boot), told from memory and found true of images by parsing
/// them.
namespace kerf::drivers::c2000 {

inline constexpr std::uint16_t stream_key = 0x08AA;
inline constexpr std::size_t reserved_words = 8;
inline constexpr std::uint32_t address_limit = 1U << 22U;  ///< of the processor's memory [words]

/// Follows a stream byte by byte, as the processor does.
class Stream {
 public:
  enum class State : std::uint8_t { reading, finished, wrong };

  /// Takes the next byte. Nothing changes after `finished` and `wrong`.
  State take(std::uint8_t byte) noexcept;

  [[nodiscard]] State state() const noexcept { return state_; }
  /// What is wrong with it, in half a sentence; empty if nothing is.
  [[nodiscard]] std::string_view problem() const noexcept { return problem_; }
  /// Words of program and data so far.
  [[nodiscard]] std::size_t words() const noexcept { return words_; }
  [[nodiscard]] std::uint32_t entry() const noexcept { return entry_; }

 private:
  enum class Part : std::uint8_t { key, reserved, entry, size, destination, data };
  void take_word(std::uint16_t word) noexcept;
  void fail(std::string_view problem) noexcept;
  void begin(Part part, std::size_t words) noexcept;

  State state_ = State::reading;
  Part part_ = Part::key;
  std::size_t left_ = 1;  ///< words of this part
  bool half_ = false;     ///< the low byte of a word is there
  std::uint8_t low_ = 0;
  std::uint32_t address_ = 0;
  std::uint32_t entry_ = 0;
  std::size_t block_ = 0;
  std::size_t words_ = 0;
  std::string_view problem_;
};

/// What keeps a file from being such a stream, whole and with nothing behind it, in half a sentence; empty if
/// nothing does.
[[nodiscard]] std::string_view problem_of(std::span<const std::uint8_t> image) noexcept;

/// One block of program or data.
struct Block {
  std::uint32_t destination = 0;
  std::vector<std::uint16_t> words;  ///< 1 to 65535
};
/// An image of such blocks, for whoever has no real one.
[[nodiscard]] std::vector<std::uint8_t> make_image(std::uint32_t entry, std::span<const Block> blocks);

}  // namespace kerf::drivers::c2000
