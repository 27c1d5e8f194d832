#include "kerf/drivers/protocols/woody_v4.h"

#include <algorithm>
#include <charconv>

namespace kerf::drivers::woody_v4 {

std::string order(const std::array<int, 3>& current_ma) {
  std::string text = "[";
  for (const int current : current_ma) {
    if (text.size() > 1) text += ',';
    text += std::to_string(std::clamp(current, -most_current_ma, most_current_ma));
  }
  text += "]\n";
  text.resize(std::max(text.size(), least_size), '\0');
  return text;
}

std::optional<Answer> parse(std::string_view text) noexcept {
  if (text.size() < 2 || text.front() != '[' || text.back() != ']') return std::nullopt;
  const char* at = text.data() + 1;
  const char* const end = text.data() + text.size() - 1;
  std::array<int, 8> numbers{};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (i > 0 && (at == end || *at++ != ',')) return std::nullopt;
    const auto [behind, error] = std::from_chars(at, end, numbers[i]);
    if (error != std::errc{}) return std::nullopt;
    at = behind;
  }
  if (at != end) return std::nullopt;
  Answer answer{.model = numbers.front(), .error = numbers.back()};
  std::copy_n(numbers.begin() + 1, answer.counter.size(), answer.counter.begin());
  return answer;
}

std::string in_words(int error) {
  struct Bit {
    int bit;
    const char* words;
  };
  constexpr std::array bits{Bit{1 | 2 | 4, "a sensor of its gimbal fails"},
                            Bit{8, "something stood behind a message: another program speaks to it too"},
                            Bit{128, "a message without an end"},
                            Bit{256, "a message without a beginning"},
                            Bit{512, "a message without three numbers"},
                            Bit{1024, "a message whose numbers are none"}};
  std::string all;
  for (const Bit& one : bits) {
    if ((error & one.bit) != 0) all += (all.empty() ? "" : "; ") + std::string(one.words);
  }
  return all;
}

void AnswerReader::add(std::string_view bytes) {
  text_ += bytes;
  if (text_.size() > longest && text_.find(']') == std::string::npos) text_.clear();
}

std::optional<std::string> AnswerReader::next() {
  const auto end = text_.find(']');
  if (end == std::string::npos) return std::nullopt;
  const auto begin = text_.rfind('[', end);
  std::string found = text_.substr(begin == std::string::npos ? end : begin,
                                   begin == std::string::npos ? 1 : end - begin + 1);
  text_.erase(0, end + 1);
  return found;
}

}  // namespace kerf::drivers::woody_v4
