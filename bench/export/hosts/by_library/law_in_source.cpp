#include "hosts/by_library/law_in_source.h"

#include <algorithm>
#include <cctype>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <kerf/version.h>

#include "hosts/by_library/host_texts.h"
#include "law_in_words.h"
#include "laws/plugin_mention.h"

namespace kerf::bench {
namespace {

void append_quoted(std::string& literal, char c, Language language) {
  const auto byte = static_cast<unsigned char>(c);
  if (c == '\n') {
    literal += "\\n";
  } else if (c == '"' || c == '\\') {
    literal += {'\\', c};
  } else if (byte >= 0x20 && byte < 0x7f && c != '%' && c != '?') {  // no key of filled_in(), no trigraph
    literal += c;
  } else {
    literal += language == Language::cpp ? fmt::format("\\{:03o}", byte) : fmt::format("\\u{:04x}", byte);
  }
}

struct AxisInWords {
  std::string name, position_unit, force_unit;
};

std::vector<AxisInWords> axes_of(const LawFile& file) {
  std::vector<AxisInWords> axes;
  for (const models::LawAxis& axis : file.law.axes())
    axes.push_back({axis.name, axis.position_unit, axis.force_unit});
  if (axes.empty())
    axes.push_back({file.axis.empty() ? "position" : file.axis, file.position_unit, file.force_unit});
  return axes;
}

std::string in_words(const std::vector<AxisInWords>& axes) {
  std::vector<std::string> words;
  for (const AxisInWords& axis : axes)
    words.push_back(fmt::format("{} in {} ({})", axis.name, axis.position_unit, axis.force_unit));
  return fmt::format("{}", fmt::join(words, ", "));
}

}  // namespace

std::string quoted(std::string_view text, Language language) {
  std::string literals;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size() - 1) + 1;
    literals += literals.empty() ? "    \"" : "\n    \"";
    for (const char c : text.substr(0, end)) append_quoted(literals, c, language);
    literals += language == Language::cpp ? "\"" : "\",";
    text.remove_prefix(end);
  }
  return literals.empty() ? "    \"\"" : literals;
}

std::string provenance_comment(const ExportedLaw& law) {
  const models::LawInfo info = models::law_info(law.file.law.model());
  std::string lines;
  const auto say = [&](std::string_view what, const std::string& text) {
    lines += fmt::format("{}// {}: {}", lines.empty() ? "" : "\n", what, in_comment(text));
  };
  say("Law", fmt::format("{}, {}", info.name, info.equation));
  if (const std::string plugin = plugin_in_words(law.file.law); !plugin.empty()) say("Of", plugin);
  say("SHA-256 of the law file", law.sha256);
  say("Axes", in_words(axes_of(law.file)));
  say("Fit", fit_in_words(law.file));
  say("Range", range_in_words(law.file));
  say("Exported by", kerf::software());
  return lines;
}

std::string axes_in_space(const ExportedLaw& law) {
  std::vector<std::size_t> indices;
  for (const AxisInWords& axis : axes_of(law.file)) {
    const std::size_t index =
        axis.name.size() == 1 ? std::string_view("xyz").find(axis.name) : std::string_view::npos;
    const bool is_named = index != std::string_view::npos;
    if (axis.position_unit != "m" || axis.force_unit != "N" || (law.file.law.is_spatial() && !is_named))
      return "";
    indices.push_back(is_named ? index : 2);
  }
  return fmt::format("{}", fmt::join(indices, ", "));
}

std::string type_name(std::string_view name) {
  std::string type;
  bool begins = true;
  for (const char c : name) {
    if (c != '_') type += begins ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
    begins = c == '_';
  }
  return type;
}

void require_one_axis(const ExportedLaw& law, std::string_view host) {
  if (law.file.law.is_spatial())
    throw std::invalid_argument(
        fmt::format("{} is replayed along one axis, and this law has {}", host, in_words(axes_of(law.file))));
}

std::vector<std::pair<std::string_view, std::string>> law_values(const ExportedLaw& law, Language language) {
  // What comes out of the file is last, so that nothing in it is taken for a key.
  return {{"NAME", law.name},
          {"TYPE", type_name(law.name)},
          {"SHA256", law.sha256},
          {"VERSION", std::string(kerf::version())},
          {"TEXT", quoted(law.text, language)},
          {"PROVENANCE", provenance_comment(law)}};
}

std::vector<std::pair<std::string_view, std::string>> values_in_space(const ExportedLaw& law,
                                                                      std::string_view host) {
  const std::string axes = axes_in_space(law);
  if (axes.empty())
    throw std::invalid_argument(fmt::format(
        "{} gives a tool's place in m along x, y, z and takes a force in N, and this law's axes are "
        "{}: such a law goes into a program of one's own by libkerf (docs/library.md)",
        host, in_words(axes_of(law.file))));
  std::vector<std::pair<std::string_view, std::string>> values{
      {"LAW_ON_AXES", std::string(host_text("law_on_axes.in"))}, {"AXES", axes}};
  for (auto& value : law_values(law, Language::cpp)) values.push_back(std::move(value));
  return values;
}

}  // namespace kerf::bench
