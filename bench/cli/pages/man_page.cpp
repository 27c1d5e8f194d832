#include "pages/man_page.h"

#include <algorithm>
#include <cctype>
#include <sstream>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <kerf/version.h>

#include "files/trimmed.h"

namespace kerf::bench {
namespace {

/// A text as troff takes it: what has a meaning there stands for itself, and a hyphen can be copied to a
/// shell.
std::string page_escaped(std::string_view text) {
  std::string out;
  for (const char letter : text) {
    switch (letter) {
      case '\\':
        out += "\\e";
        break;
      case '-':
        out += "\\-";
        break;
      case '\'':
        out += "\\(aq";
        break;
      case '`':
        out += "\\(ga";
        break;
      case '^':
        out += "\\(ha";
        break;
      case '~':
        out += "\\(ti";
        break;
      default:
        out += letter;
    }
  }
  return out;
}

/// Likewise as a line of its own, which may not begin as a request does.
std::string page_line(std::string_view text) {
  const std::string out = page_escaped(text);
  return (out.starts_with('.') ? "\\&" : "") + out + "\n";
}

std::string bold(std::string_view text) { return "\\fB" + page_escaped(text) + "\\fR"; }
std::string italic(std::string_view text) { return "\\fI" + page_escaped(text) + "\\fR"; }

/// An entry of a list: what is explained, already escaped, and how.
std::string page_entry(const std::string& head, std::string_view text) {
  return ".TP\n" + head + "\n" + page_line(text);
}

std::vector<std::string> page_lines_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string one; std::getline(stream, one);) lines.push_back(one);
  return lines;
}

/// Prose, with lines that are set in left as they are, such as those of a table.
std::string paragraphs(const std::string& text) {
  std::string out;
  bool as_is = false;
  for (const std::string& one : page_lines_of(text)) {
    const bool set_in = one.starts_with("  ");
    if (set_in != as_is) out += set_in ? ".PP\n.nf\n" : ".fi\n.PP\n";
    as_is = set_in;
    out += one.empty() ? ".PP\n" : page_line(one);
  }
  return out + (as_is ? ".fi\n" : "");
}

/// What stands below the options of --help: the commands of "Example:", and the rest.
struct Footer {
  std::string examples;
  std::string prose;
};

Footer parted(const std::string& footer) {
  constexpr std::string_view head = "Example:\n";
  if (!footer.starts_with(head)) return {.examples = "", .prose = footer};
  const std::size_t end = std::min(footer.find("\n\n"), footer.size());
  return {.examples = footer.substr(head.size(), end - head.size()),
          .prose = footer.substr(std::min(end + 2, footer.size()))};
}

std::string synopsis(const DescribedVerb& verb) {
  std::string out = bold(fmt::format("kerf {}", fmt::join(verb.words, " ")));
  out += verb.verbs.empty() ? " [" + italic("OPTIONS") + "]"
                            : " " + italic("VERB") + " [" + italic("OPTIONS") + "]";
  for (const DescribedOption& value : verb.values) {
    const std::string name = italic(value.names.front()) + (value.repeated ? "..." : "");
    out += value.required ? " " + name : " [" + name + "]";
  }
  return out + "\n";
}

std::string page_options(const std::vector<DescribedOption>& all) {
  std::string out;
  for (const DescribedOption& option : all) {
    std::string head;
    for (const std::string& name : option.names)
      head += (head.empty() ? "" : ", ") + (name.starts_with('-') ? bold(name) : italic(name));
    if (!option.value.empty()) head += " " + italic(option.value);
    out += page_entry(head, option.description);
  }
  return out;
}

const DescribedVerb& verb_of(const std::vector<DescribedVerb>& all, std::vector<std::string> words,
                             const std::string& last) {
  words.push_back(last);
  return *std::ranges::find(all, words, &DescribedVerb::words);
}

/// Its own verbs, under the names of their groups if they have any.
std::string page_verbs(const DescribedVerb& verb, const std::vector<DescribedVerb>& all) {
  std::string out;
  std::string group;
  for (const std::string& name : verb.verbs) {
    const DescribedVerb& one = verb_of(all, verb.words, name);
    if (one.group != group) out += ".SS " + page_escaped(one.group) + "\n";
    group = one.group;
    out += page_entry(bold(fmt::format("kerf {}", fmt::join(one.words, " "))), one.description);
  }
  return out;
}

std::string exit_statuses() {
  return ".SH EXIT STATUS\n" + page_entry(bold("0"), "Done, and every check passed.") +
         page_entry(bold("1"), "A check did not pass.") +
         page_entry(bold("2"), "Bad input: a word, a file, or an output that exists, without --force.") +
         page_entry(bold("3"), "A device is not there, not permitted, or lost.") +
         page_entry(bold("4"),
                    "Writing failed, or there is no memory, no room, or no program that is needed.");
}

std::string see_also(const DescribedVerb& verb, const std::vector<DescribedVerb>& all) {
  std::vector<std::string> pages;
  if (!verb.words.empty()) pages.emplace_back("kerf");
  if (verb.words.size() > 1) pages.push_back("kerf-" + verb.words.front());
  for (const std::string& name : verb.verbs) pages.push_back(page_name(verb_of(all, verb.words, name)));
  if (verb.words.empty()) pages.emplace_back("kerf-emulate");
  std::string out = ".SH SEE ALSO\n";
  for (const std::string& page : pages) out += bold(page) + "(1)" + (&page == &pages.back() ? "\n" : ",\n");
  return out;
}

}  // namespace

std::string page_name(const DescribedVerb& verb) {
  return fmt::format("kerf{}{}", verb.words.empty() ? "" : "-", fmt::join(verb.words, "-"));
}

std::string man_page(const DescribedVerb& verb, const std::vector<DescribedVerb>& all,
                     const std::string& date) {
  const Footer footer = parted(verb.footer);
  std::string title = page_name(verb);
  std::ranges::transform(title, title.begin(), [](unsigned char letter) { return std::toupper(letter); });
  std::string out =
      fmt::format(".TH {} 1 \"{}\" \"kerf {}\" \"Kerf\"\n", page_escaped(title), date, version());
  out += ".SH NAME\n" + page_escaped(page_name(verb)) + " \\- " + page_escaped(verb.description) + "\n";
  out += ".SH SYNOPSIS\n" + synopsis(verb);
  if (verb.words.empty())
    out += ".SH DESCRIPTION\n" +
           page_line(
               "Every verb has a page of its own, kerf-VERB(1), the option --help with an example, "
               "and --json.");
  if (!trimmed(footer.prose).empty()) out += ".SH DESCRIPTION\n" + paragraphs(footer.prose);
  if (!verb.verbs.empty()) out += ".SH VERBS\n" + page_verbs(verb, all);
  out += ".SH OPTIONS\n" + page_options(verb.values) + page_options(verb.options);
  if (!footer.examples.empty()) {
    out += ".SH EXAMPLES\n.nf\n";
    for (const std::string& one : page_lines_of(footer.examples)) out += page_line(trimmed(one));
    out += ".fi\n";
  }
  out += exit_statuses();
  out += ".SH FILES\n" +
         page_line(
             "What is named docs/... and examples/... stands in share/doc/kerf of where Kerf was installed.");
  return out + see_also(verb, all);
}

}  // namespace kerf::bench
