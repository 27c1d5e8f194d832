#include "texts/subject_texts.h"

#include <algorithm>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "texts/plain_text.h"
#include "texts/shipped_texts_file.h"

namespace kerf::bench {
namespace {

constexpr std::size_t longest_text = 400;

bool is_language_tag(std::string_view tag) {
  constexpr std::string_view letters = "abcdefghijklmnopqrstuvwxyz";
  constexpr std::string_view any = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-";
  const std::size_t primary = std::min(tag.find('-'), tag.size());
  return (primary == 2 || primary == 3) && tag.size() <= 35 && tag.back() != '-' &&
         tag.substr(0, primary).find_first_not_of(letters) == std::string_view::npos &&
         tag.find_first_not_of(any) == std::string_view::npos;
}

std::set<std::string> placeholder_set(std::string_view text) {
  const std::vector<std::string> all = placeholders_of(text);
  return {all.begin(), all.end()};
}

std::string in_braces(const std::set<std::string>& placeholders) {
  std::string text;
  for (const std::string& one : placeholders) text += fmt::format("{}{{{}}}", text.empty() ? "" : ", ", one);
  return text.empty() ? "none" : text;
}

void require_placeholders(const Place& place, const toml::node& node, std::string_view name,
                          std::string_view text, std::string_view english) {
  const std::set<std::string> wanted = placeholder_set(english);
  std::set<std::string> found;
  try {
    found = placeholder_set(text);
  } catch (const std::invalid_argument& error) {
    place.refuse(node, "the text '{}': {}; expected the placeholders {}", name, error.what(),
                 in_braces(wanted));
  }
  for (const std::string& one : wanted) {
    if (!found.contains(one))
      place.refuse(node, "the text '{}' has no {{{}}} in it; expected the placeholders {}", name, one,
                   in_braces(wanted));
  }
  for (const std::string& one : found) {
    if (!wanted.contains(one))
      place.refuse(node, "the text '{}' has {{{}}} in it; expected the placeholders {}", name, one,
                   in_braces(wanted));
  }
}

/// One text, from a table in which it stands under `key`.
std::string read_text(const Place& place, const toml::table& table, std::string_view key,
                      std::string_view name) {
  const toml::node& node = *table.get(key);
  std::string text = read_plain_text(place, table, key);
  const std::size_t length = characters_in(text);
  if (length == 0 || length > longest_text)
    place.refuse(node, "the text '{}' has {} characters, expected 1 to {}", name, length, longest_text);
  if (name == "language" && !is_language_tag(text))
    place.refuse(node, "'language' is \"{}\", expected a tag such as \"fr\" or \"pt-BR\"", text);
  return text;
}

std::shared_ptr<const SubjectTexts> parse_shipped(std::string_view language) {
  const EmbeddedFile& file = shipped_texts_file().front();
  const Place place{std::string(file.name)};
  const toml::table root = parse_toml(std::string(file.content), place.file());
  place.allow_only(root, text_names, "the texts");
  std::array<std::string, text_names.size()> texts;
  for (std::size_t i = 0; i < text_names.size(); ++i) {
    const toml::table& table = place.table(root, text_names[i]);
    place.allow_only(table, shipped_languages, text_names[i]);
    for (const std::string_view key : shipped_languages) {
      if (!table.contains(key)) place.refuse(table, "the text '{}' has no '{}'", text_names[i], key);
    }
    texts[i] = read_text(place, table, language, text_names[i]);
    require_placeholders(place, *table.get(language), text_names[i], texts[i],
                         place.text(table, shipped_languages.front(), ""));
  }
  return std::make_shared<const SubjectTexts>(std::move(texts));
}

}  // namespace

std::string SubjectTexts::operator()(TextName name, std::initializer_list<TextValue> values) const {
  std::string filled;
  std::string_view rest = texts_[name.index()];
  while (!rest.empty()) {
    const std::size_t open = std::min(rest.find('{'), rest.size());
    filled += rest.substr(0, open);
    rest.remove_prefix(open);
    if (rest.empty()) break;
    const std::size_t length = std::min(rest.find('}'), rest.size() - 1) + 1;
    const std::string_view placeholder = rest.substr(1, length - 2);
    const auto given = std::ranges::find(values, placeholder, &TextValue::placeholder);
    filled += given == values.end() ? rest.substr(0, length) : std::string_view(given->value);
    rest.remove_prefix(length);
  }
  return filled;
}

std::string SubjectTexts::list(const std::vector<std::string>& words) const {
  if (words.empty()) return {};
  std::string all = words.front();
  for (std::size_t i = 1; i < words.size(); ++i) {
    all = i + 1 == words.size() ? (*this)("list_or", {{"first", all}, {"last", words[i]}})
                                : (*this)("list_more", {{"first", all}, {"next", words[i]}});
  }
  return all;
}

std::vector<std::string> placeholders_of(std::string_view text) {
  constexpr std::string_view of_names = "abcdefghijklmnopqrstuvwxyz_";
  std::vector<std::string> placeholders;
  for (std::size_t at = text.find_first_of("{}"); at != std::string_view::npos;
       at = text.find_first_of("{}", at)) {
    const std::size_t end = text.find_first_not_of(of_names, at + 1);
    if (text[at] == '}' || end == std::string_view::npos || text[end] != '}' || end == at + 1)
      throw std::invalid_argument(fmt::format("found a '{}' that is no placeholder's", text[at]));
    placeholders.emplace_back(text.substr(at + 1, end - at - 1));
    at = end + 1;
  }
  return placeholders;
}

std::shared_ptr<const SubjectTexts> shipped_texts(std::string_view language) {
  static const auto all = [] {
    std::map<std::string_view, std::shared_ptr<const SubjectTexts>> texts;
    for (const std::string_view one : shipped_languages) texts[one] = parse_shipped(one);
    return texts;
  }();
  if (const auto found = all.find(language); found != all.end()) return found->second;
  throw std::invalid_argument(
      fmt::format("there are no texts in '{}', only in {}", language, fmt::join(shipped_languages, " and ")));
}

std::shared_ptr<const SubjectTexts> english_texts() { return shipped_texts("en"); }

std::shared_ptr<const SubjectTexts> parse_texts(const std::string& toml, const std::string& file) {
  const Place place(file);
  const toml::table root = parse_toml(toml, file);
  const SubjectTexts& english = *english_texts();
  std::array<std::string, text_names.size()> texts;
  for (std::size_t i = 0; i < text_names.size(); ++i) {
    const std::string_view name = text_names[i];
    if (!root.contains(name))
      place.refuse(root, "there is no text '{}'; expected every one, in English it is \"{}\"", name,
                   english.all()[i]);
    texts[i] = read_text(place, root, name, name);
    require_placeholders(place, *root.get(name), name, texts[i], english.all()[i]);
  }
  for (const auto& [key, node] : root) {
    if (std::ranges::find(text_names, key.str()) == text_names.end())
      place.refuse(node, "unknown text '{}'; expected only those that there are in English", key.str());
  }
  return std::make_shared<const SubjectTexts>(std::move(texts));
}

std::string to_toml(const SubjectTexts& texts) {
  std::string toml;
  for (std::size_t i = 0; i < text_names.size(); ++i) {
    toml += fmt::format("{} = \"", text_names[i]);
    for (const char c : texts.all()[i]) {
      if (c == '"' || c == '\\') toml += '\\';
      toml += c;
    }
    toml += "\"\n";
  }
  return toml;
}

std::shared_ptr<const SubjectTexts> kept_texts(const std::map<std::string, std::string>& kept) {
  const auto language = kept.find("language");
  const std::string primary = language == kept.end() ? "en" : language->second.substr(0, 2);
  const bool is_shipped = std::ranges::find(shipped_languages, primary) != shipped_languages.end();
  std::array<std::string, text_names.size()> texts = shipped_texts(is_shipped ? primary : "en")->all();
  for (std::size_t i = 0; i < text_names.size(); ++i) {
    const auto found = kept.find(std::string(text_names[i]));
    if (found == kept.end()) continue;
    try {
      if (placeholder_set(found->second) == placeholder_set(texts[i])) texts[i] = found->second;
    } catch (const std::invalid_argument&) {
      continue;  // of another version
    }
  }
  return std::make_shared<const SubjectTexts>(std::move(texts));
}

}  // namespace kerf::bench
