#include <initializer_list>
#include <span>
#include <string>

#include <kerf/schema/validate.h>

#include "layout/layout.h"
#include "layout/session_layout.h"

namespace kerf::schema {
namespace {

std::string code(std::string_view text) { return '`' + std::string(text) + '`'; }

std::string yes_or_no(bool required) { return required ? "yes" : "no"; }

std::string in_words(std::string_view shape) {
  std::string words;
  for (const char letter : shape) {
    if (!words.empty()) words += " x ";
    words += letter == 'B' ? std::to_string(flag_table.size()) : letter == 'F' ? "4" : std::string(1, letter);
  }
  return words.empty() ? "one" : words;
}

std::string row(std::initializer_list<std::string> cells) {
  std::string line = "|";
  for (const auto& cell : cells) line += ' ' + cell + " |";
  return line + '\n';
}

std::string value_of(const layout::Attribute& attribute) {
  if (const auto* text = std::get_if<std::string_view>(&attribute.value)) return ": " + code(*text);
  std::string list;
  const auto add = [&](std::uint32_t number) {
    list.append(list.empty() ? "" : " ").append(std::to_string(number));
  };
  if (const auto* words = std::get_if<std::span<const std::uint32_t>>(&attribute.value)) {
    for (const auto number : *words) add(number);
  }
  if (const auto* bytes = std::get_if<std::span<const std::uint8_t>>(&attribute.value)) {
    for (const auto number : *bytes) add(number);
  }
  return list.empty() ? "" : ": " + code(list);
}

}  // namespace

std::string schema_as_markdown() {
  std::string text = "### Groups\n\n" + row({"group", "required", "what"}) + row({"---", "---", "---"});
  for (const auto& group : layout::groups()) {
    text += row({code(group.path), yes_or_no(group.required), std::string(group.description)});
  }
  text += "\n### Datasets\n\n" +
          row({"dataset", "type", "shape", "`units`", "required in its group", "what"}) +
          row({"---", "---", "---", "---", "---", "---"});
  for (const auto& dataset : layout::datasets()) {
    text += row({code(dataset.path), code(dataset.type), in_words(dataset.shape),
                 std::string(layout::describe(dataset.units)), yes_or_no(dataset.required),
                 std::string(dataset.description)});
  }
  text +=
      row({code("/samples/channels/NAME"), code("float64"), "N", "any", "no", "A further measured channel"});
  text += "\n### Attributes\n\n" + row({"on", "attribute", "type", "values", "required", "what"}) +
          row({"---", "---", "---", "---", "---", "---"});
  for (const auto& attribute : layout::attributes()) {
    text += row({code(attribute.object), code(attribute.name), std::string(attribute.type),
                 in_words(attribute.shape), yes_or_no(attribute.required),
                 std::string(attribute.description) + value_of(attribute)});
  }
  text += row({"every dataset", code("units"), "text", "see above", "yes", "Unit, or units one a column"});
  text += "\n### Flags\n\n" + row({"bit", "name", "what it says of its row"}) + row({"---", "---", "---"});
  for (const auto& flag : flag_table) {
    text += row(
        {std::to_string(static_cast<std::uint32_t>(flag.flag)), code(flag.name), std::string(flag.meaning)});
  }
  return text;
}

std::string session_schema_as_markdown() {
  std::string text =
      row({"on", "attribute", "type", "values", "what"}) + row({"---", "---", "---", "---", "---"});
  for (const auto& [object, rule, description] : session_layout::session_attributes()) {
    text += row({code(object), code(rule.name), std::string(rule.type),
                 rule.list == 0 ? "one" : std::to_string(rule.list), std::string(description)});
  }
  text += '\n' + row({"dataset", "type", "shape", "what"}) + row({"---", "---", "---", "---"});
  text +=
      row({code("/entries"), code(session_layout::type_of_entries), "E",
           "What happened, oldest first: `plan`, `run`, `plugin` (name and SHA-256 of one that a run had), "
           "`trial`, `quit`, `opened`, `finished`; of an experiment `registered` and `look`; texts of "
           "fixed length"});
  text +=
      row({code("/sealed/NNNNNN"), code("uint8"), "any",
           "What is sealed of entry NNNNNN, from 000000: nonce (24), ciphertext, tag (16); in one piece, not "
           "compressed"});
  return text;
}

}  // namespace kerf::schema
