#include "verbs/verb_order.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "http/routes.h"
#include "workspace/page_uri.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t longest_given = 500;
constexpr std::size_t most_given = 100;

[[noreturn]] void refuse_value(const VerbValue& value, std::string_view why, int status = 400) {
  throw RequestError(status, fmt::format("{}: {}", value.name, why));
}

bool ends_with_one_of(std::string_view name, const std::vector<std::string>& endings) {
  return endings.empty() ||
         std::ranges::any_of(endings, [&](const std::string& ending) { return name.ends_with(ending); });
}

std::string given_text(const VerbValue& value, const std::string& text) {
  if (text.empty()) refuse_value(value, "nothing is given");
  if (text.size() > longest_given)
    refuse_value(value, fmt::format("it is longer than {} bytes", longest_given));
  const auto steers = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; };
  if (std::ranges::any_of(text, steers)) refuse_value(value, "it has a character that steers a terminal");
  return text;
}

void require_number(const VerbValue& value, std::string_view text) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(number))
    refuse_value(value, fmt::format("'{}' is not a number", text.substr(0, 40)));
}

/// Numbers with blanks between, as an option takes two or three, each a word of its own.
std::vector<std::string> numbers_of(const VerbValue& value, std::string_view text) {
  std::vector<std::string> numbers;
  while (true) {
    const std::size_t end = std::min(text.find(' '), text.size());
    require_number(value, text.substr(0, end));
    numbers.emplace_back(text.substr(0, end));
    if (end == text.size()) return numbers;
    text.remove_prefix(end + 1);
  }
}

/// By its path in there. One that begins like an option is not taken for one.
std::string given_file(const VerbValue& value, const std::string& name, const Workspace& workspace) {
  if (!ends_with_one_of(name, value.words))
    refuse_value(value, fmt::format("{} is no file of the kind that is asked for: {}", name.substr(0, 200),
                                    fmt::join(value.words, ", ")));
  if (!workspace.regular_file(name))
    refuse_value(value, fmt::format("{} is not in this folder any more", name.substr(0, 200)));
  return name.starts_with('-') ? "./" + name : name;
}

std::string given_folder(const VerbValue& value, const std::string& name, const Workspace& workspace) {
  std::error_code error;
  const fs::path folder = workspace.folder() / name;
  // What is its own canonical name holds neither a link nor a step up.
  if (name.empty() || fs::path(name).is_absolute() || fs::canonical(folder, error) != folder || error ||
      !fs::is_directory(folder))
    refuse_value(value, fmt::format("{} is no folder in here any more", name.substr(0, 200)));
  return name.starts_with('-') ? "./" + name : name;
}

std::string given_output(const VerbValue& value, std::string name, const Workspace& workspace) {
  std::string ending = value.words.front();
  for (const std::string& other : value.words) {
    if (other.empty() || !name.ends_with(other)) continue;
    ending = other;
    name.resize(name.size() - other.size());
  }
  try {
    return workspace.new_file(name, ending).filename().string();
  } catch (const RequestError& error) {
    refuse_value(value, error.what(), error.status);
  }
}

std::string given_device(const VerbValue& value, const std::string& uri, const Workspace& workspace) {
  if (!uri.starts_with("sim:"))
    refuse_value(value, "only simulated devices, such as sim:scissors: nothing is to move because of a job");
  return uri_from_page(workspace, uri);
}

std::string given_word(const VerbValue& value, const std::string& text, const Workspace& workspace) {
  switch (value.kind) {
    case ValueKind::choice:
      if (std::ranges::find(value.words, text) == value.words.end())
        refuse_value(value, fmt::format("it is one of {}", fmt::join(value.words, ", ")));
      return text;
    case ValueKind::device:
      return given_device(value, given_text(value, text), workspace);
    case ValueKind::file:
      return given_file(value, given_text(value, text), workspace);
    case ValueKind::folder:
      return given_folder(value, given_text(value, text), workspace);
    case ValueKind::output:
      return given_output(value, given_text(value, text), workspace);
    default:
      return given_text(value, text);
  }
}

/// What is given for one value, one or several. A number is taken as it is written and as JSON's.
std::vector<std::string> given_texts(const VerbValue& value, const nlohmann::json& given) {
  const auto text = [&](const nlohmann::json& one) {
    if (one.is_string()) return one.get<std::string>();
    if (one.is_number()) return one.dump();
    refuse_value(value, "it is neither a text nor a number");
  };
  std::vector<std::string> texts;
  if (!given.is_array()) return {text(given)};
  if (!value.repeated && given.size() > 1) refuse_value(value, "it takes one value");
  if (given.size() > most_given) refuse_value(value, fmt::format("more than {} values", most_given));
  for (const nlohmann::json& one : given) texts.push_back(text(one));
  return texts;
}

}  // namespace

VerbOrder verb_order(const VerbForm& form, const nlohmann::json& given, const Workspace& workspace) {
  if (!given.is_object()) throw RequestError(400, "'values' is not an object");
  for (const auto& [name, unused] : given.items()) {
    if (std::ranges::find(form.values, name, &VerbValue::name) == form.values.end())
      throw RequestError(
          400, fmt::format("{}: the form of '{}' has no such value", name.substr(0, 40), form.verb));
  }
  VerbOrder order;
  for (std::size_t begin = 0; begin <= form.verb.size();) {
    const std::size_t end = std::min(form.verb.find(' ', begin), form.verb.size());
    order.words.push_back(form.verb.substr(begin, end - begin));
    begin = end + 1;
  }
  order.words.insert(order.words.end(), form.fixed.begin(), form.fixed.end());
  // Those without a name first: an option that takes several would take them too.
  for (const bool positional : {true, false}) {
    for (const VerbValue& value : form.values) {
      if (value.positional != positional) continue;
      const auto found = given.find(value.name);
      const bool is_given = found != given.end() && !(found->is_array() && found->empty());
      if (!is_given && value.required) refuse_value(value, "it is needed");
      if (!is_given) continue;
      if (value.kind == ValueKind::flag) {
        if (!found->is_boolean()) refuse_value(value, "it is true or false");
        if (found->get<bool>()) order.words.push_back(value.name);
        continue;
      }
      for (const std::string& text : given_texts(value, *found)) {
        if (value.kind == ValueKind::number) {
          std::vector<std::string> numbers = numbers_of(value, text);
          if (!positional) numbers.front() = fmt::format("{}={}", value.name, numbers.front());
          order.words.insert(order.words.end(), numbers.begin(), numbers.end());
          continue;
        }
        const std::string word = given_word(value, text, workspace);
        if (value.kind == ValueKind::output) order.outputs.push_back(word);
        order.words.push_back(positional ? word : fmt::format("{}={}", value.name, word));
      }
    }
  }
  return order;
}

std::string as_typed(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) {
    const auto plain = [](char c) {
      return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
             std::string_view("_-./:,=+@%").find(c) != std::string_view::npos;
    };
    if (!line.empty()) line += ' ';
    if (!word.empty() && std::ranges::all_of(word, plain)) {
      line += word;
      continue;
    }
    line += '\'';
    for (const char c : word) line += c == '\'' ? std::string("'\\''") : std::string(1, c);
    line += '\'';
  }
  return line;
}

}  // namespace kerf::bench
