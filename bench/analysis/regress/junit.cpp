#include "regress/junit.h"

#include <fmt/ranges.h>

#include <kerf/version.h>

#include "html/html.h"
#include "regress/context.h"
#include "regress/regress_page.h"

namespace kerf::bench {
namespace {

/// Bytes of the UTF-8 character at `at`; 0 if there is none, or one that XML forbids.
std::size_t character_at(const std::string& text, std::size_t at) {
  const auto byte = [&](std::size_t i) {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : std::uint8_t{0};
  };
  const unsigned char first = byte(at);
  if (first < 0x80U) return first >= 0x20U || first == '\t' || first == '\n' || first == '\r' ? 1 : 0;
  const std::size_t length = first >= 0xC2U && first < 0xE0U   ? 2
                             : first >= 0xE0U && first < 0xF0U ? 3
                             : first >= 0xF0U && first < 0xF5U ? 4
                                                               : 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(at + i) & 0xC0U) != 0x80U) return 0;
  }
  const bool too_long = (first == 0xE0U && byte(at + 1) < 0xA0U) || (first == 0xF0U && byte(at + 1) < 0x90U);
  const bool surrogate = first == 0xEDU && byte(at + 1) >= 0xA0U;
  const bool too_large = first == 0xF4U && byte(at + 1) >= 0x90U;
  const bool no_character = first == 0xEFU && byte(at + 1) == 0xBFU && byte(at + 2) >= 0xBEU;
  return too_long || surrogate || too_large || no_character ? 0 : length;
}

std::string failure(const std::string& message, const std::string& more) {
  return fmt::format("    <failure message=\"{}\" type=\"regression\">{}</failure>\n", xml_escaped(message),
                     xml_escaped(more));
}

std::string error_element(const std::string& reason) {
  return fmt::format("    <error message=\"{0}\" type=\"case\">{0}</error>\n", xml_escaped(reason));
}

/// Page and pictures of a case, where they are going to stand.
std::string attachments(const RegressionOutcome& one, const std::filesystem::path& page) {
  if (page.empty()) return {};
  std::string names;
  for (const Figure& figure : figures_of(one))
    names += fmt::format("[[ATTACHMENT|{}]]\n", (page / (figure.name + ".svg")).string());
  names += fmt::format("[[ATTACHMENT|{}]]\n", (page / "regress.html").string());
  return fmt::format("    <system-out>{}</system-out>\n", xml_escaped(names));
}

}  // namespace

std::string xml_escaped(const std::string& text) {
  std::string sound;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = character_at(text, at);
    if (length == 0) {
      sound += '?';
    } else {
      sound.append(text, at, length);
    }
    at += std::max<std::size_t>(length, 1);
  }
  return escaped(sound);
}

std::string junit_xml(const std::filesystem::path& suite, const std::string& error) {
  return junit_xml(Suite{.name = suite.stem().string(), .file = suite, .stored = {}, .cases = {}},
                   {.cases = {{.about = {.name = suite.filename().string()}, .error = error}}});
}

std::string junit_xml(const Suite& suite, const SuiteOutcome& outcome, const std::filesystem::path& page) {
  const std::string name = xml_escaped(suite.name);
  const std::size_t tests = outcome.cases.size() + outcome.dropped.size();
  const std::string skipped =
      outcome.left_out() > 0 ? fmt::format(" skipped=\"{}\"", outcome.left_out()) : "";
  const std::string counts =
      fmt::format("name=\"{}\" tests=\"{}\" failures=\"{}\" errors=\"{}\"{} time=\"{:.6f}\"", name, tests,
                  outcome.failed() - outcome.errors(), outcome.errors(), skipped, outcome.seconds);
  std::string xml = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites {}>\n  <testsuite {}>\n"
      "    <properties><property name=\"software\" value=\"{}\"/></properties>\n",
      counts, counts, xml_escaped(software()));
  for (const RegressionOutcome& one : outcome.cases) {
    xml += fmt::format("  <testcase classname=\"{}\" name=\"{}\" time=\"{:.6f}\"", name,
                       xml_escaped(one.about.name), one.seconds);
    if (one.left_out) {
      xml += fmt::format("><skipped message=\"{}\"/></testcase>\n", xml_escaped(one.why));
      continue;
    }
    if (one.passed()) {
      xml += "/>\n";
      continue;
    }
    xml += ">\n";
    if (!one.error.empty()) {
      xml += error_element(one.error);
    } else {
      xml += failure(one.messages.front(),
                     fmt::format("{}\n{}\n{}", fmt::join(one.messages, "\n"), one.why, context_table(one)));
    }
    xml += attachments(one, page);
    if (!one.said.empty()) xml += fmt::format("    <system-err>{}</system-err>\n", xml_escaped(one.said));
    xml += "  </testcase>\n";
  }
  for (const std::string& dropped : outcome.dropped) {
    xml += fmt::format("  <testcase classname=\"{}\" name=\"{}\" time=\"0\">\n", name, xml_escaped(dropped));
    xml += failure("its forces are stored, and the suite has no such case any more", "");
    xml += "  </testcase>\n";
  }
  return xml + "  </testsuite>\n</testsuites>\n";
}

}  // namespace kerf::bench
