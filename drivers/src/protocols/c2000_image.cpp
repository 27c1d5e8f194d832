#include "kerf/drivers/protocols/c2000_image.h"

namespace kerf::drivers::c2000 {

void Stream::fail(std::string_view problem) noexcept {
  state_ = State::wrong;
  problem_ = problem;
}

void Stream::begin(Part part, std::size_t words) noexcept {
  part_ = part;
  left_ = words;
  address_ = 0;
}

Stream::State Stream::take(std::uint8_t byte) noexcept {
  if (state_ != State::reading) return state_;
  if (half_) {
    take_word(static_cast<std::uint16_t>(low_ | byte << 8));
  } else {
    low_ = byte;
  }
  half_ = !half_;
  return state_;
}

void Stream::take_word(std::uint16_t word) noexcept {
  --left_;
  switch (part_) {
    case Part::key:
      if (word != stream_key) return fail("it does not begin with the key 0x08AA");
      return begin(Part::reserved, reserved_words);
    case Part::reserved:
      if (left_ == 0) begin(Part::entry, 2);
      return;
    case Part::entry:
      address_ = address_ << 16U | word;
      if (left_ > 0) return;
      if (address_ >= address_limit) return fail("its entry point is outside the processor's memory");
      entry_ = address_;
      return begin(Part::size, 1);
    case Part::size:
      if (word == 0) {
        if (words_ == 0) return fail("it holds no program");
        state_ = State::finished;
        return;
      }
      block_ = word;
      return begin(Part::destination, 2);
    case Part::destination:
      address_ = address_ << 16U | word;
      if (left_ > 0) return;
      if (address_ + block_ > address_limit) return fail("a block lies outside the processor's memory");
      return begin(Part::data, block_);
    case Part::data:
      ++words_;
      if (left_ == 0) begin(Part::size, 1);
      return;
  }
}

std::string_view problem_of(std::span<const std::uint8_t> image) noexcept {
  Stream stream;
  for (std::size_t at = 0; at < image.size(); ++at) {
    const auto state = stream.take(image[at]);
    if (state == Stream::State::wrong) return stream.problem();
    if (state == Stream::State::finished) {
      return at + 1 == image.size() ? std::string_view() : "something follows its end";
    }
  }
  return image.empty() ? "it is empty" : "it ends too early";
}

std::vector<std::uint8_t> make_image(std::uint32_t entry, std::span<const Block> blocks) {
  std::vector<std::uint8_t> image;
  const auto word = [&](std::size_t value) {
    image.push_back(static_cast<std::uint8_t>(value & 0xFFU));
    image.push_back(static_cast<std::uint8_t>(value >> 8U & 0xFFU));
  };
  const auto address = [&](std::uint32_t value) {
    word(value >> 16U);
    word(value & 0xFFFFU);
  };
  word(stream_key);
  for (std::size_t i = 0; i < reserved_words; ++i) word(0);
  address(entry);
  for (const Block& block : blocks) {
    word(block.words.size());
    address(block.destination);
    for (const std::uint16_t one : block.words) word(one);
  }
  word(0);
  return image;
}

}  // namespace kerf::drivers::c2000
