#include "html/html.h"

#include <fmt/core.h>

#include <kerf/version.h>

#include "files/for_terminal.h"
#include "html/whole_page.h"

namespace kerf::bench {
namespace {

constexpr std::string_view style = R"(
:root { --ink: #1b1f24; --soft: #57606a; --paper: #fbfbfa; --card: #ffffff; --line: #d8dee4; --good: #00734f; --partly: #9a6700; --bad: #a63c00; }
@media (prefers-color-scheme: dark) {
  :root { --ink: #e6edf3; --soft: #9da7b1; --paper: #14181d; --card: #1c2229; --line: #38414a; --good: #4cc796; --partly: #e3b341; --bad: #ff9157; }
}
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 1000px; padding: 2rem 1.5rem 4rem; color: var(--ink); background: var(--paper);
  overflow-wrap: break-word; font: 16px/1.55 system-ui, "Segoe UI", "DejaVu Sans", sans-serif; }
h1 { font-size: 1.7rem; line-height: 1.25; margin: 0 0 .3rem; }
h2 { font-size: 1.25rem; margin: 2.6rem 0 .8rem; padding-top: .8rem; border-top: 1px solid var(--line); }
p { margin: .5rem 0; }
.soft { color: var(--soft); }
.answer { font-size: 1.08rem; border-left: 4px solid var(--good); padding: .2rem 0 .2rem .9rem; margin: 1rem 0; }
.answer.partly { border-color: var(--partly); border-left-style: dashed; }
.answer.bad { border-color: var(--bad); }
figure { margin: 1rem 0; padding: .6rem; background: #fff; border: 1px solid var(--line); border-radius: 6px; }
figure canvas { display: block; touch-action: pan-y; cursor: crosshair; }
figure.zoom { color: #333; font-size: .85rem; }
figure.zoom output { display: block; min-height: 1.6em; font-variant-numeric: tabular-nums; }
figure.zoom button { font: inherit; }
figure svg { display: block; width: 100%; height: auto; }
.pair { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 400px), 1fr)); gap: .8rem; margin: .8rem 0; }
.pair figure { margin: 0; }
details { margin: 1.2rem 0; }
summary { cursor: pointer; color: var(--soft); }
td.share { text-align: right; padding-left: .5rem; padding-right: .5rem; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; font-size: .93rem; margin: .6rem 0; }
th, td { text-align: left; padding: .28rem .7rem .28rem 0; border-bottom: 1px solid var(--line); vertical-align: top; }
th { color: var(--soft); font-weight: 600; }
code { font-family: ui-monospace, "DejaVu Sans Mono", monospace; font-size: .9em; overflow-wrap: anywhere; }
@media print { body { max-width: none; background: #fff; color: #000; } figure { break-inside: avoid; } .scroll { overflow: visible; } table { font-size: .8rem; } }
)";

}  // namespace

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : for_terminal(text)) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      case '\'':
        result += "&#39;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

std::string html_table(const std::vector<std::vector<std::string>>& rows) {
  std::string html = "<div class=\"scroll\"><table>\n";
  for (std::size_t row = 0; row < rows.size(); ++row) {
    html += "<tr>";
    for (const std::string& cell : rows[row]) {
      html += fmt::format("<{0}>{1}</{0}>", row == 0 ? "th" : "td", escaped(cell));
    }
    html += "</tr>\n";
  }
  return html + "</table></div>\n";
}

std::string html_answer(Answer answer, std::string_view html) {
  const char* kind = answer == Answer::good ? "" : answer == Answer::partly ? " partly" : " bad";
  return fmt::format("<p class=\"answer{}\">{}</p>\n", kind, html);
}

std::string html_figure(std::string_view svg) { return fmt::format("<figure>{}</figure>\n", svg); }

std::string html_page(std::string_view title, std::string_view body) { return whole_page(title, body, ""); }

std::string whole_page(std::string_view title, std::string_view body, std::string_view policy) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta "
      "http-equiv=\"Content-Security-Policy\" "
      "content=\"default-src 'none'; {}style-src 'unsafe-inline'; img-src data:\">\n<meta name=\"viewport\" "
      "content=\"width=device-width, "
      "initial-scale=1\">\n<meta name=\"generator\" "
      "content=\"{}\">\n<title>{}</title>\n<style>{}</style>\n</head>\n<body>\n{}"
      "</body>\n</html>\n",
      policy, escaped(software()), escaped(title), style, body);
}

}  // namespace kerf::bench
