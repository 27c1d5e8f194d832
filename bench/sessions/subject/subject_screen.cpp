#include "subject/subject_screen.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "subject/subject_rules.h"
#include "subject/subject_words.h"

namespace kerf::bench {
namespace {

/// Code points: of UTF-8, the bytes that do not go on with one.
std::size_t width_of(std::string_view text) noexcept {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

/// Bytes of the first so many code points.
std::size_t bytes_of(std::string_view text, std::size_t columns) noexcept {
  std::size_t bytes = 0;
  while (bytes < text.size() && width_of(text.substr(0, bytes + 1)) <= columns) ++bytes;
  return bytes;
}

std::string without_controls(std::string_view text) {
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const bool is_c1 = byte == 0xC2 && i + 1 < text.size() && static_cast<unsigned char>(text[i + 1]) < 0xA0;
    if (is_c1) {
      ++i;
    } else if (byte == '\t') {
      plain += ' ';
    } else if (byte == '\n' || (byte >= 0x20 && byte != 0x7F)) {
      plain += text[i];
    }
  }
  return plain;
}

void wrap_line(std::string_view line, std::size_t columns, std::vector<std::string>& lines) {
  while (width_of(line) > columns) {
    const std::size_t fits = bytes_of(line, columns);
    const std::size_t blank = line.rfind(' ', fits);
    const bool at_blank = blank != std::string_view::npos && blank > 0;
    lines.emplace_back(line.substr(0, at_blank ? blank : fits));
    line.remove_prefix(at_blank ? blank + 1 : fits);
  }
  lines.emplace_back(line);
}

/// "[ A ]    B      X  ": what plays stands in brackets, the others in the same width.
std::string slots_line(const SubjectView& view) {
  std::string line;
  for (std::size_t slot = 0; slot < view.labels.size(); ++slot) {
    const bool plays = view.playing == slot;
    line += fmt::format("{} {} {}  ", plays ? '[' : ' ', view.labels[slot], plays ? ']' : ' ');
  }
  return line;
}

std::string wait_line(const SubjectView& view) {
  if (view.stage != SessionStage::pause || view.may_go_on || view.wait_s <= 0.0) return {};
  return (*view.texts)("pause_length", {{"seconds", fmt::format("{:.0f}", std::ceil(view.wait_s))}});
}

std::string what_may_be_done(const SubjectView& view) {
  const SubjectTexts& texts = *view.texts;
  std::vector<std::string> commands;
  if (view.may_switch) commands.push_back(texts("command_play") + ' ' + label_list(view, view.labels.size()));
  if (view.may_answer) commands.push_back(texts("command_answer") + ' ' + answer_list(view));
  if (view.may_slip) commands.push_back(texts("command_slip"));
  if (view.stage == SessionStage::consent) {
    commands.push_back(texts("command_agree"));
    commands.push_back(texts("command_decline"));
  } else if (view.may_go_on) {
    commands.push_back(texts("command_go_on"));
  }
  commands.push_back(texts("command_quit"));
  std::string all = commands.front();
  for (std::size_t i = 1; i < commands.size(); ++i)
    all = texts("commands_more", {{"first", all}, {"next", commands[i]}});
  return texts("commands", {{"commands", all}});
}

}  // namespace

std::vector<std::string> wrapped(std::string_view text, std::size_t columns) {
  const std::string plain = without_controls(text);
  std::vector<std::string> lines;
  std::string_view rest = plain;
  while (!rest.empty()) {
    const std::size_t end = rest.find('\n');
    wrap_line(rest.substr(0, end), std::max<std::size_t>(columns, 1), lines);
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  }
  return lines;
}

SubjectScreen screen_of(const SubjectView& view, const std::string& keys, const std::string& hint,
                        std::size_t columns) {
  SubjectScreen screen{.texts = view.texts};
  const auto part = [&](std::vector<std::string>& lines, const std::string& text) {
    const std::vector<std::string> more = wrapped(text, columns);
    lines.insert(lines.end(), more.begin(), more.end());
    if (!more.empty()) lines.emplace_back();
  };
  part(screen.body, view.study);
  part(screen.body, progress(view));
  part(screen.body, heading(view));
  part(screen.body, text_below(view));
  if (view.stage == SessionStage::trial) {
    part(screen.body, slots_line(view));
    part(screen.body, what_plays(view));
  }
  part(screen.body, wait_line(view));
  part(screen.foot, keys);
  part(screen.foot, hint.empty() ? view.notice : hint);
  return screen;
}

SubjectScreenPage page_of(const SubjectScreen& screen, std::size_t page, std::size_t rows) {
  const SubjectTexts& texts = *screen.texts;
  constexpr std::size_t turning = 1;  // line that tells how to turn pages
  const std::size_t whole = screen.body.size() + screen.foot.size();
  if (whole <= rows) {
    SubjectScreenPage only{.lines = screen.body};
    only.lines.insert(only.lines.end(), screen.foot.begin(), screen.foot.end());
    return only;
  }
  const std::size_t below = screen.foot.size() + turning;
  const std::size_t room = rows > below + 1 ? rows - below : 1;
  SubjectScreenPage part{.pages = (screen.body.size() + room - 1) / room};
  page = std::min(page, part.pages - 1);
  for (std::size_t line = page * room; line < (page + 1) * room; ++line) {
    part.lines.push_back(line < screen.body.size() ? screen.body[line] : std::string());
  }
  const std::string number = std::to_string(page + 1);
  const std::string of = std::to_string(part.pages);
  part.lines.push_back(page + 1 < part.pages
                           ? texts("page_more", {{"page", number}, {"pages", of}})
                           : texts("page_last", {{"page", number}, {"pages", of}, {"key", "P"}}));
  if (page + 1 == part.pages) part.lines.insert(part.lines.end(), screen.foot.begin(), screen.foot.end());
  return part;
}

std::vector<std::string> said_of(const SubjectView& before, const SubjectView& now) {
  const bool fresh = is_new_screen(before, now);
  std::vector<std::string> lines;
  const auto say = [&](const std::string& text) {
    if (!text.empty()) lines.push_back(without_controls(text));
  };
  if (fresh) {
    say(progress(now));
    say(heading(now));
  }
  if (fresh || before.text != now.text) say(text_below(now));
  if (fresh || before.playing != now.playing) say(what_plays(now));
  if (fresh) say(wait_line(now));
  if (fresh || before.may_switch != now.may_switch || before.may_answer != now.may_answer ||
      before.may_go_on != now.may_go_on || before.may_slip != now.may_slip) {
    if (now.stage != SessionStage::finished) say(what_may_be_done(now));
  }
  if (fresh || before.notice != now.notice) say(now.notice);
  return lines;
}

}  // namespace kerf::bench
