#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <stdexcept>

#include <fmt/core.h>

#include <kerf/fitting/rupture.h>
#include <kerf/fitting/segmented.h>

#include "chart/fidelities.h"
#include "laws/render.h"

namespace kerf::bench {
namespace {

constexpr std::size_t curve_points = 400;   // of one branch
constexpr std::size_t surface_points = 21;  // of a fuzzy surface, along each input

/// The force of one branch, without what fades it in the hand.
class Branches {
 public:
  explicit Branches(const models::Law& law) : law_(without_rendering_aids(law)) {}
  [[nodiscard]] double operator()(bool closing, double penetration) const {
    models::Law::State state = law_.initial_state();
    const models::Motion motion{.penetration = penetration, .velocity = closing ? 1.0 : -1.0};
    return law_.step(state, motion, 1e-3).force;
  }

 private:
  models::Law law_;
};

bool option_flag(const models::Law& law, std::string_view name) {
  const auto given = law.options().find(name);
  return given != law.options().end() && std::get<bool>(given->second);
}

double option_or(const models::Law& law, std::string_view name, double standard) {
  const auto given = law.options().find(name);
  return given != law.options().end() ? std::get<double>(given->second) : standard;
}

struct Points {
  std::vector<double> position;
  std::vector<double> force;
  std::vector<std::uint8_t> branch;
};

Points points_of(const models::Law& law, double first, double last, bool loop) {
  const Branches branches(law);
  Points points;
  for (const bool closing : {true, false}) {
    if (!closing && !loop) break;
    for (std::size_t i = 0; i < curve_points; ++i) {
      const double share = static_cast<double>(i) / static_cast<double>(curve_points - 1);
      points.position.push_back(first + share * (last - first));
      points.force.push_back(branches(closing, points.position.back()));
      points.branch.push_back(closing ? 0 : 1);
    }
  }
  return points;
}

models::Options surface_options(const models::Law& law) {
  models::Options options;
  for (const models::OptionInfo& known : models::Law::options("fuzzy_rupture")) {
    const auto given = law.options().find(known.name);
    if (given != law.options().end()) options.insert(*given);
  }
  return options;
}

/// Where in its values the surface of a fuzzy law begins; its options have the box.
std::size_t surface_begins(const models::Law& law) {
  const std::size_t surface = models::Law::parameters("fuzzy_rupture", surface_options(law)).size();
  return law.values().size() - surface;
}

fitting::RuptureSamples samples_of_surface(const models::Law& law, std::size_t begins) {
  const std::vector<double> values(law.values().begin() + static_cast<std::ptrdiff_t>(begins),
                                   law.values().end());
  const models::Law surface = models::Law::make("fuzzy_rupture", values, surface_options(law));
  models::Law::State state = surface.initial_state();
  const auto place = [](double least, double most, std::size_t i) {
    return least + (most - least) * static_cast<double>(i) / static_cast<double>(surface_points - 1);
  };
  fitting::RuptureSamples samples;
  const double max_depth = option_or(law, "most_depth", 0.01);
  const double max_speed = option_or(law, "most_speed", 0.01);
  for (std::size_t i = 0; i < surface_points; ++i) {
    for (std::size_t j = 0; j < surface_points; ++j) {
      const double depth = place(option_or(law, "least_depth", 0.0), max_depth, i);
      const double speed = place(option_or(law, "least_speed", 0.0), max_speed, j);
      // At no depth at all there is no force, although the surface has one.
      const models::Motion motion{.penetration = std::max(depth, 1e-9 * max_depth), .velocity = speed};
      samples.depth_m.push_back(depth);
      samples.speed_m_per_s.push_back(speed);
      samples.force_n.push_back(surface.step(state, motion, 1e-3).force);
    }
  }
  return samples;
}

}  // namespace

std::vector<Fidelity> resampled_segments(const LawFile& file, std::size_t most, double rate_hz) {
  const models::Law& law = file.law;
  const auto knots = static_cast<std::size_t>(option_or(law, "segments", 5.0)) + 1;
  const bool loop = option_flag(law, "loop");
  const Points points = points_of(law, law.values().front(), law.values()[knots - 1], loop);
  const auto curves = fitting::fit_segments(
      {.position = points.position,
       .force = points.force,
       .weight = {},
       .branch = loop ? std::span<const std::uint8_t>(points.branch) : std::span<const std::uint8_t>()},
      {.max_segments = most});
  std::vector<Fidelity> all;
  for (const fitting::SegmentedCurve& curve : curves) {
    std::vector<double> values = curve.knots;
    for (const auto& force : curve.force) values.insert(values.end(), force.begin(), force.end());
    models::Options options = law.options();
    options["segments"] = static_cast<double>(curve.segments());
    all.push_back({fmt::format("{} segment{}", curve.segments(), curve.segments() == 1 ? "" : "s"),
                   with_law(file, models::Law::make(law.model(), values, options)), rate_hz});
  }
  return all;
}

std::vector<Fidelity> resampled_tables(const LawFile& file, std::size_t most, double rate_hz) {
  const models::Law& law = file.law;
  const Branches branches(law);
  const double first = option_or(law, "first", 0.0);
  const double last = option_or(law, "last", 1.0);
  std::vector<Fidelity> all;
  for (std::size_t points = 2; points <= most; points *= 2) {
    std::vector<double> values;
    for (const bool closing : {true, false}) {
      if (!closing && !option_flag(law, "loop")) break;
      for (std::size_t i = 0; i < points; ++i) {
        const double share = static_cast<double>(i) / static_cast<double>(points - 1);
        values.push_back(branches(closing, first + share * (last - first)));
      }
    }
    models::Options options = law.options();
    options["points"] = static_cast<double>(points);
    all.push_back({fmt::format("{} points", points),
                   with_law(file, models::Law::make(law.model(), values, options)), rate_hz});
  }
  return all;
}

void add_memberships(const LawFile& file, double rate_hz, Fidelities& to) {
  const models::Law& law = file.law;
  const std::size_t begins = surface_begins(law);
  const fitting::RuptureSamples samples = samples_of_surface(law, begins);
  const models::SizeFacts& size = models::law_facts(law.model()).size;
  for (std::size_t memberships = size.first; memberships <= size.last; ++memberships) {
    if (static_cast<double>(memberships) == option_or(law, "memberships", 3.0)) continue;
    try {
      const auto trained = fitting::train_rupture(samples, {.memberships = memberships, .iterations = 100});
      std::vector<double> values(law.values().begin(),
                                 law.values().begin() + static_cast<std::ptrdiff_t>(begins));
      values.insert(values.end(), trained.law.values().begin(), trained.law.values().end());
      models::Options options = law.options();
      options["memberships"] = static_cast<double>(memberships);
      to.all.push_back({fmt::format("{} rules", memberships * memberships),
                        with_law(file, models::Law::make(law.model(), values, options)), rate_hz});
    } catch (const std::invalid_argument& error) {
      to.notes.push_back(
          fmt::format("{} with {} memberships is left out: {}", law.model(), memberships, error.what()));
    }
  }
}

}  // namespace kerf::bench
