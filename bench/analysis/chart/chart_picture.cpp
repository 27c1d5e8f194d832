#include "chart/chart_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <fmt/format.h>

#include "files/json_number.h"
#include "plot/label_places.h"
#include "stability/stability_verdict.h"

namespace kerf::bench {
namespace {

using json = nlohmann::ordered_json;

// What is further from the JND stands at an edge: it would press all others into a few pixels.
constexpr double least_share_of_jnd = 1e-2;
constexpr double most_jnds = 1e2;
constexpr double unknown_share = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double far_away = 10.0;     // times: what is no nearer would press all points into a corner
constexpr double cheapest_us = 2e-3;  // below it a cost is what the clock can tell
constexpr std::array law_colours{Colour::blue,   Colour::vermillion, Colour::green, Colour::purple,
                                 Colour::orange, Colour::sky,        Colour::grey,  Colour::yellow};

/// A point where it is drawn.
struct Spot {
  std::size_t of = 0;  ///< in the result
  std::string law;
  std::string name;
  double error = 0.0;
  double p50_ns = 0.0;
  double cost_us = 0.0;  ///< as it is drawn
  double cold_us = 0.0;  ///< by the cold tail; not finite where nobody measured it
  double outside = 0.0;  ///< share of ticks outside the JND; NaN: not known
  Stable stable = Stable::not_judged;
  bool on_front = false;
  bool on_cold_front = false;
};

std::string text_or_empty(const json& chart, const char* name) {
  const auto found = chart.find(name);
  return found != chart.end() && found->is_string() ? found->get<std::string>() : std::string();
}

/// A chart's points, errors in the unit of the force where one axis is judged, else in JNDs.
struct Spots {
  explicit Spots(const json& chart)
      : unit(chart.at("compared_in").get<std::string>()),
        jnd(unit == "JND" ? 1.0 : number_from(chart.at("jnd_n"))),
        tick_us(1e6 / chart.at("rate_hz").get<double>()),
        cold_tail(text_or_empty(chart, "cold_tail")),
        limit(chart.value("jnd_fraction_limit", 1.0)) {
    const std::string cold_key = cold_tail == "p99" ? "cold_p99_ns" : "cold_p999_ns";
    const double most = most_jnds * jnd;
    for (const json& point : chart.at("points")) {
      const double error = number_from(point.at(unit == "JND" ? "error_jnd" : "error_n"));
      const double p50_ns = number_from(point.at("p50_ns"));
      const double cost_us = std::max(1e-3 * p50_ns, cheapest_us);
      const auto law = point.at("law").get<std::string>();
      all.push_back(
          {.of = all.size(),
           .law = law,
           .name = law + ", " + point.at("fidelity").get<std::string>(),
           .error = std::clamp(std::isfinite(error) ? error : most, least_share_of_jnd * jnd, most),
           .p50_ns = p50_ns,
           .cost_us = cost_us,
           .cold_us = cold_tail.empty() || !point.contains(cold_key) ? infinite
                                                                     : 1e-3 * number_from(point.at(cold_key)),
           .outside = point.contains("jnd_fraction") ? number_from(point["jnd_fraction"]) : unknown_share,
           .stable = stable_from(point.at("stable")),
           .on_front = point.at("on_front").get<bool>(),
           .on_cold_front = point.value("on_cold_front", false)});
    }
  }
  std::string unit;
  double jnd;
  double tick_us;
  std::string
      cold_tail;  ///< "p99.9", "p99"; empty: not measured, or by an earlier version from too few ticks
  double limit;   ///< of the share of ticks outside the JND, of points within it
  std::vector<Spot> all;
};

/// What hollow marks mean, where there are any.
std::string hollow_in_words(const Spots& spots) {
  const bool any =
      std::ranges::any_of(spots.all, [&](const Spot& spot) { return spot.outside > spots.limit; });
  return any ? fmt::format("; hollow: over {:.2g} % of ticks outside the JND", 100.0 * spots.limit) : "";
}

/// What stands at an edge, where there is any.
std::string edges_in_words(const Spots& spots) {
  const auto at = [&](double error) { return std::ranges::count(spots.all, error, &Spot::error) > 0; };
  const bool less = at(least_share_of_jnd * spots.jnd);
  const bool more = at(most_jnds * spots.jnd);
  if (less && more) return "; at the edges: less, more";
  return less ? "; at the edge: less" : (more ? "; at the edge: more" : "");
}

/// A colour a law; hollow marks where too many ticks are outside the JND.
void add_laws(const Spots& spots, Chart& picture) {
  struct Law {
    std::string name;
    Curve filled, hollow;
  };
  std::vector<Law> laws;
  for (const Spot& spot : spots.all) {
    auto at = std::ranges::find(laws, spot.law, &Law::name);
    if (at == laws.end()) {
      const Curve marks{.colour = law_colours[laws.size() % law_colours.size()],
                        .mark = Mark::points,
                        .width = laws.size() < law_colours.size() ? 4.0 : 2.5};
      at = laws.insert(at, {.name = spot.law, .filled = marks, .hollow = marks});
      at->hollow.mark = Mark::circles;
    }
    Curve& curve = spot.outside > spots.limit ? at->hollow : at->filled;
    curve.x.push_back(spot.error);
    curve.y.push_back(spot.cost_us);
    curve.of.push_back(spot.of);
  }
  for (Law& law : laws) {
    (law.filled.x.empty() ? law.hollow : law.filled).label = law.name;
    for (Curve* curve : {&law.filled, &law.hollow}) {
      if (!curve->x.empty()) picture.curves.push_back(std::move(*curve));
    }
  }
}

/// The stairs of a front, from the right border down its points to the upper.
Curve stairs_of(std::vector<Spot> front, double Spot::*cost, const Chart& picture) {
  std::ranges::sort(front, {}, cost);
  Curve stairs;
  double right = picture.x_range.end;
  for (const Spot& spot : front) {
    for (const double x : {right, spot.error}) {
      stairs.x.push_back(x);
      stairs.y.push_back(spot.*cost);
    }
    right = spot.error;
  }
  stairs.x.push_back(right);
  stairs.y.push_back(picture.y_range.end);
  return stairs;
}

void add_label(const Spot& spot, double y, Chart& picture) {
  const bool near_left = std::log(spot.error / picture.x_range.begin) <
                         0.45 * std::log(picture.x_range.end / picture.x_range.begin);
  std::string text = spot.name;
  if (std::isfinite(spot.outside)) text += fmt::format(", {:.2g} % outside", 100.0 * spot.outside);
  picture.labels.push_back({.x = spot.error, .y = y, .text = text, .left = !near_left});
}

void add_front(const Spots& spots, Chart& picture) {
  std::vector<Spot> front;
  std::ranges::copy_if(spots.all, std::back_inserter(front), &Spot::on_front);
  if (front.empty()) return;
  std::ranges::sort(front, {}, &Spot::p50_ns);
  Curve stairs = stairs_of(front, &Spot::cost_us, picture);
  stairs.label = "front, median";
  stairs.width = 2.0;
  for (const Spot& spot : front) add_label(spot, spot.cost_us, picture);
  picture.curves.insert(picture.curves.begin(), std::move(stairs));
}

void add_cold_front(const Spots& spots, Chart& picture) {
  std::vector<Spot> front;
  std::ranges::copy_if(spots.all, std::back_inserter(front), &Spot::on_cold_front);
  if (front.empty()) return;
  Curve stairs = stairs_of(front, &Spot::cold_us, picture);
  stairs.label = fmt::format("front, cold {}", spots.cold_tail);
  stairs.width = 1.5;
  stairs.dashed = true;
  Curve places{.label = {}, .colour = Colour::black, .mark = Mark::points, .width = 2.5};
  for (const Spot& spot : front) {
    places.x.push_back(spot.error);
    places.y.push_back(spot.cold_us);
    if (!spot.on_front) add_label(spot, spot.cold_us, picture);
  }
  picture.curves.insert(picture.curves.begin() + 1, {stairs, places});
}

void add_marks(const Spots& spots, Stable stable, Curve marks, Chart& picture) {
  for (const Spot& spot : spots.all) {
    if (spot.stable != stable) continue;
    marks.x.push_back(spot.error);
    marks.y.push_back(spot.cost_us);
  }
  if (!marks.x.empty()) picture.curves.push_back(std::move(marks));
}

}  // namespace

Chart chart_picture(const json& chart) {
  const Spots spots(chart);
  Chart picture{.title = fmt::format("Cost of a tick over error: {}", chart.at("source").get<std::string>()),
                .x_label = fmt::format("error, root mean square [{}]{}{}", spots.unit, edges_in_words(spots),
                                       hollow_in_words(spots)),
                .y_label = "cost of a tick [µs]",
                .log_x = true,
                .log_y = true,
                .width_px = 1000,
                .height_px = 620};
  Range errors{spots.jnd, spots.jnd};
  Range costs{infinite, 0.0};
  for (const Spot& spot : spots.all) {
    errors = {std::min(errors.begin, spot.error), std::max(errors.end, spot.error)};
    costs = {std::min(costs.begin, spot.cost_us),
             std::max({costs.end, spot.cost_us, spot.on_cold_front ? spot.cold_us : 0.0})};
  }
  const bool deadline_shown = 0.5 * spots.tick_us <= far_away * costs.end;
  if (deadline_shown) costs.end = std::max(costs.end, spots.tick_us);
  const auto reference = chart.find("reference_error");
  const bool refined = reference != chart.end() && reference->is_object();
  const double own_error = refined ? spots.jnd * number_from(reference->at("estimate_jnd")) : infinite;
  if (std::isfinite(own_error)) {
    errors = {std::min(errors.begin, own_error), std::max(errors.end, own_error)};
    picture.vertical.push_back({.at = own_error, .label = "the reference's own error"});
  }
  if (refined && reference->at("converges") == false) picture.title += "; its reference has not converged";
  const bool narrow = errors.end < far_away * errors.begin;
  picture.x_range = {(narrow ? 0.8 : 0.5) * errors.begin, (narrow ? 1.6 : 3.0) * errors.end};
  picture.y_range = {0.5 * costs.begin, 3.0 * costs.end};
  const auto has = [&](Stable stable) {
    return std::ranges::find(spots.all, stable, &Spot::stable) != spots.all.end();
  };
  if (has(Stable::not_judged) && !has(Stable::yes)) {
    picture.title += ", stability not judged";  // a ring about each would hide them
  } else {
    add_marks(spots, Stable::not_judged,
              {.label = "stability not judged", .colour = Colour::grey, .mark = Mark::circles, .width = 8.0},
              picture);
  }
  add_laws(spots, picture);
  add_front(spots, picture);
  add_cold_front(spots, picture);
  add_marks(spots, Stable::no,
            {.label = "not stable", .colour = Colour::black, .mark = Mark::crosses, .width = 7.0}, picture);
  picture.vertical.push_back({.at = spots.jnd, .label = "JND", .label_after = true});
  const std::string tick = fmt::format("a tick at {:g} Hz", chart.at("rate_hz").get<double>());
  if (deadline_shown) {
    picture.horizontal.push_back({.at = spots.tick_us, .label = tick});
    picture.horizontal.push_back({.at = 0.5 * spots.tick_us, .label = "half of it"});
  } else {
    picture.y_label += fmt::format("; {} has {:g}", tick, spots.tick_us);
  }
  place_labels(picture);
  return picture;
}

}  // namespace kerf::bench
