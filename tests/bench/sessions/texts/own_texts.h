#pragma once

#include <map>
#include <string>

#include <fmt/format.h>

#include "texts/subject_texts.h"

namespace kerf::test {

/// A language of its own: every text with its placeholders, in brackets of angles.
inline std::map<std::string, std::string> angled_texts() {
  std::map<std::string, std::string> texts;
  for (std::size_t i = 0; i < bench::text_names.size(); ++i)
    texts[std::string(bench::text_names[i])] = fmt::format("<{}>", bench::english_texts()->all()[i]);
  texts["language"] = "fr-CA";
  texts["language_name"] = "French";
  return texts;
}

inline std::string as_toml(const std::map<std::string, std::string>& texts) {
  std::string toml;
  for (const auto& [name, text] : texts) toml += fmt::format("{} = '{}'\n", name, text);
  return toml;
}

}  // namespace kerf::test
