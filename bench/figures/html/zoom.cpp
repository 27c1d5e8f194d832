#include "html/zoom.h"

#include <array>
#include <cmath>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>
#include <sodium.h>

#include "html/whole_page.h"
#include "plot/colours.h"

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

std::string sha256_in_base64(std::string_view text) {
  std::array<unsigned char, crypto_hash_sha256_BYTES> digest{};
  crypto_hash_sha256(digest.data(), reinterpret_cast<const unsigned char*>(text.data()), text.size());
  std::array<char, sodium_base64_ENCODED_LEN(crypto_hash_sha256_BYTES, sodium_base64_VARIANT_ORIGINAL)>
      base64{};
  return sodium_bin2base64(base64.data(), base64.size(), digest.data(), digest.size(),
                           sodium_base64_VARIANT_ORIGINAL);
}

}  // namespace

std::string page_with_script(std::string_view title, std::string_view body, std::string_view script) {
  return whole_page(title, fmt::format("{}<script>{}</script>\n", body, script),
                    fmt::format("script-src 'sha256-{}'; ", sha256_in_base64(script)));
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
