#include "drawer/name_factors.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <vector>

namespace kerf::bench {
namespace {

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

template <std::size_t Count>
bool is_one_of(std::string_view word, const std::array<std::string_view, Count>& words) {
  return std::ranges::find(words, word) != words.end();
}

bool is_blank_word(std::string_view word) {
  constexpr std::array<std::string_view, 7> words{"blank", "blanks",   "empty",   "air",
                                                  "idle",  "unloaded", "notissue"};
  return is_one_of(word, words);
}

bool is_speed_word(std::string_view word) {
  constexpr std::array<std::string_view, 8> words{"slow",   "fast",  "medium", "moderate",
                                                  "normal", "quick", "slower", "faster"};
  if (is_one_of(word, words)) return true;
  constexpr std::array<std::string_view, 9> units{"mms", "mmps",  "cms", "degs", "degps",
                                                  "ms",  "mmmin", "hz",  "rpm"};
  const auto end = std::ranges::find_if_not(word, is_digit) - word.begin();
  return end > 0 && is_one_of(word.substr(static_cast<std::size_t>(end)), units);
}

/// "s3" of the prefix "s": what stands before a number at the end of a word, if both are there.
std::string_view prefix_of_number(std::string_view word) {
  std::size_t digits = word.size();
  while (digits > 0 && is_digit(word[digits - 1])) --digits;
  return digits < word.size() ? word.substr(0, digits) : std::string_view();
}

bool is_specimen_word(std::string_view word) {
  constexpr std::array<std::string_view, 9> prefixes{"s",      "sp",      "spec",    "specimen", "sample",
                                                     "animal", "cadaver", "subject", "donor"};
  const std::string_view prefix = prefix_of_number(word);
  return !prefix.empty() && is_one_of(prefix, prefixes);
}

bool is_rig_word(std::string_view word) {
  constexpr std::array<std::string_view, 4> prefixes{"rig", "setup", "tool", "device"};
  const std::string_view prefix = prefix_of_number(word);
  return !prefix.empty() && is_one_of(prefix, prefixes);
}

bool is_number_word(std::string_view word) {
  if (std::ranges::all_of(word, is_digit)) return true;
  constexpr std::array<std::string_view, 8> prefixes{"t", "r", "trial", "run", "rep", "test", "no", "v"};
  const std::string_view prefix = prefix_of_number(word);
  if (!prefix.empty() && is_one_of(prefix, prefixes)) return true;
  const auto stamp = [](char c) { return is_digit(c) || c == 't' || c == 'z' || c == ':' || c == 'h'; };
  return is_digit(word.front()) && std::ranges::all_of(word, stamp);
}

void append_word(std::string& text, const std::string& word) { text += (text.empty() ? "" : " ") + word; }

}  // namespace

std::vector<std::string> words_of_name(const std::filesystem::path& path) {
  std::filesystem::path stem = path;
  stem.replace_extension();
  std::vector<std::string> words(1);
  for (const char c : stem.generic_string()) {
    if (std::string_view("_-. /()[],+").find(c) != std::string_view::npos) {
      words.emplace_back();
    } else {
      words.back() += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
  }
  std::erase(words, "");
  return words;
}

NameFactors name_factors(const std::filesystem::path& path) {
  NameFactors factors;
  for (const std::string& word : words_of_name(path)) {
    if (is_blank_word(word)) {
      factors.blank = true;
    } else if (is_speed_word(word)) {
      append_word(factors.speed, word);
    } else if (is_specimen_word(word)) {
      append_word(factors.specimen, word);
    } else if (is_rig_word(word)) {
      append_word(factors.rig, word);
    } else if (is_number_word(word)) {
      append_word(factors.numbers, word);
    } else {
      append_word(factors.tissue, word);
    }
  }
  return factors;
}

}  // namespace kerf::bench
