#include "html/zoom.h"

#include <cmath>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "html/whole_page.h"
#include "plot/colours.h"
#include "recordings/provenance.h"

namespace kerf::bench {
namespace {

/// A text within a script element of HTML, which would end at its end tag.
std::string quoted(const std::string& text) {
  std::string json = nlohmann::json(text).dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
  for (std::size_t at = 0; (at = json.find('<', at)) != std::string::npos;) json.replace(at, 1, "\\u003c");
  return json;
}

std::string number(double value, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}g}", value, digits) : "null";
}

/// Parts as an array, each as JSON.
template <typename Part, typename AsJson>
std::string list_of(const std::vector<Part>& parts, const AsJson& as_json) {
  std::string list = "[";
  for (const Part& part : parts) list += (list.size() > 1 ? "," : "") + as_json(part);
  return list + "]";
}

std::string numbers(const std::vector<double>& values, int digits) {
  return list_of(values, [&](double value) { return number(value, digits); });
}

/// The x of a curve stand there where they are not those of the curve before.
std::string curves_of(const Chart& chart, const std::vector<double>*& before) {
  return list_of(chart.curves, [&](const Curve& curve) {
    const bool same = before != nullptr && *before == curve.x;
    before = &curve.x;
    return fmt::format(R"({{"label":{},"colour":"{}","width":{},"x":{},"y":{}}})", quoted(curve.label),
                       hex_of(curve.colour), curve.width, same ? "null" : numbers(curve.x, 10),
                       numbers(curve.y, 7));
  });
}

std::string chart_of(const Chart& chart, const std::vector<double>*& before) {
  const auto marker = [](const Marker& one) {
    return fmt::format(R"({{"at":{},"label":{},"label_after":{}}})", number(one.at, 10), quoted(one.label),
                       one.label_after);
  };
  return fmt::format(
      R"({{"title":{},"x_label":{},"y_label":{},"curves":{},"bands":{},"vertical":{},"horizontal":{}}})",
      quoted(chart.title), quoted(chart.x_label), quoted(chart.y_label), curves_of(chart, before),
      list_of(chart.bands,
              [](const Band& band) {
                return fmt::format(R"({{"begin":{},"end":{},"colour":"{}"}})", number(band.begin, 10),
                                   number(band.end, 10), hex_of(band.colour));
              }),
      list_of(chart.vertical, marker), list_of(chart.horizontal, marker));
}

/// Bytes in hexadecimal as base64.
std::string base64_of_hex(const std::string& hex) {
  constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t at = 0; at < hex.size(); at += 6) {
    std::string three = hex.substr(at, 6);
    const std::size_t digits = three.size();
    three.resize(6, '0');
    const unsigned long bits = std::stoul(three, nullptr, 16);
    for (unsigned i = 0; i < 4; ++i) text += i <= digits / 2 ? letters[bits >> (18 - 6 * i) & 63U] : '=';
  }
  return text;
}

}  // namespace

std::string page_with_script(std::string_view title, std::string_view body, std::string_view script) {
  return whole_page(title, fmt::format("{}<script>{}</script>\n", body, script),
                    fmt::format("script-src 'sha256-{}'; ", base64_of_hex(sha256_of(script))));
}

std::string html_zoom_page(std::string_view title, std::string_view body) {
  return page_with_script(title, body, html_zoom_script());
}

std::string html_zoom_figure(std::string_view svg, std::span<const Chart> charts) {
  const std::vector<double>* before = nullptr;
  std::string data;
  for (const Chart& chart : charts) data += (data.empty() ? "" : ",\n") + chart_of(chart, before);
  return fmt::format("<figure class=\"zoom\">{}<script type=\"application/json\">[{}]</script></figure>\n",
                     svg, data);
}

}  // namespace kerf::bench
