#include "fits/asked_fit.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <stdexcept>
#include <string_view>

#include <fmt/format.h>

#include <kerf/models/law.h>

#include "files/file_names.h"
#include "fits/fit_series.h"
#include "fits/law_options.h"
#include "recordings/axes.h"
#include "recordings/whole_recording.h"
#include "report/charts.h"
#include "units/units.h"

namespace kerf::bench {
namespace {

constexpr std::size_t max_segments = 16;

struct Segments {
  fitting::CountBy by = fitting::CountBy::given;
  std::size_t count = 5;
};

Segments parse_segments(const std::string& text) {
  if (text == "bic") return {.by = fitting::CountBy::bic};
  if (text == "jnd") return {.by = fitting::CountBy::jnd};
  std::size_t count = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  if (error != std::errc() || end != text.data() + text.size() || count < 1 || count > max_segments) {
    throw std::invalid_argument(
        fmt::format("--segments: '{}' is not a number from 1 to {}, bic or jnd", text, max_segments));
  }
  return {.count = count};
}

fitting::Loss loss_of(const std::string& name) {
  if (name == "huber") return fitting::Loss::huber;
  if (name == "soft_l1") return fitting::Loss::soft_l1;
  if (name == "cauchy") return fitting::Loss::cauchy;
  return fitting::Loss::squares;
}

/// "7.5" in the unit that charts show, or "7.5mm".
double position_of(const std::string& text, const schema::Axis& axis) {
  double value = 0.0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || !std::isfinite(value)) {
    throw std::invalid_argument(
        fmt::format("--breakpoints: '{}' is not a position, for example 7.5 or 7.5mm", text));
  }
  if (rest == end) return value / drawn_position(axis).factor;
  const Unit unit = parse_unit(std::string(rest, end));
  if (unit.si == axis.position_unit) return value * unit.factor;
  throw std::invalid_argument(fmt::format("--breakpoints: '{}' is in {}, and axis '{}' is in {}", text,
                                          unit.si, axis.name, axis.position_unit));
}

/// Positions on the axis as penetrations, in order.
std::vector<double> breakpoints_of(const AskedFit& asked, const FitSource& source) {
  std::vector<double> penetrations;
  for (const std::string& text : asked.breakpoints) {
    const double position = position_of(text, source.recording->axes[source.axis]);
    penetrations.push_back(source.contact.motion(position, 0.0).penetration);
  }
  std::sort(penetrations.begin(), penetrations.end());
  return penetrations;
}

std::vector<std::string> law_options_of(const AskedFit& asked) {
  std::vector<std::string> all;
  if (asked.arms > 0) all.push_back(fmt::format("arms={}", asked.arms));
  if (asked.memberships > 0) all.push_back(fmt::format("memberships={}", asked.memberships));
  if (asked.thickness) all.push_back(fmt::format("thickness={}", *asked.thickness));
  all.insert(all.end(), asked.options.law_options.begin(), asked.options.law_options.end());
  return all;
}

[[noreturn]] void refuse_asked(const std::string& reason) { throw std::invalid_argument(reason); }

void require_within(std::string_view option, double value, AskedFit::Range range) {
  if (value >= range.lower && value <= range.upper) return;
  refuse_asked(fmt::format("{}: {} is not from {} to {}", option, value, range.lower, range.upper));
}

void require_within(std::string_view option, std::size_t value, AskedFit::Count range) {
  if (value >= static_cast<std::size_t>(range.lower) && value <= static_cast<std::size_t>(range.upper))
    return;
  refuse_asked(fmt::format("{}: {} is not from {} to {}", option, value, range.lower, range.upper));
}

void require_positive(std::string_view option, double value) {
  if (!(value > 0.0 && std::isfinite(value)))
    refuse_asked(fmt::format("{}: {} is not a positive number", option, value));
}

void require_one_of(std::string_view option, std::string_view value,
                    std::initializer_list<std::string_view> words) {
  if (std::find(words.begin(), words.end(), value) == words.end())
    refuse_asked(fmt::format("{}: '{}' is none of {}", option, value, fmt::join(words, ", ")));
}

/// The program has refused most of this as its words were read; who asks otherwise has not.
void check_ranges(const AskedFit& asked) {
  const fitting::FitOptions& fit = asked.options.fit;
  require_one_of("--rows", asked.rows, {"contact", "all"});
  require_one_of("--loss", asked.loss, {"squares", "huber", "soft_l1", "cauchy"});
  require_one_of("--direction", asked.contact.direction, {"", "increasing", "decreasing"});
  require_within("--points-per-segment", fit.points_per_segment, AskedFit::most_points);
  if (asked.arms > 0) require_within("--arms", asked.arms, AskedFit::most_arms);
  if (asked.memberships > 0) require_within("--memberships", asked.memberships, AskedFit::most_memberships);
  if (asked.thickness) require_positive("--thickness", *asked.thickness);
  if (asked.contact.position && !std::isfinite(*asked.contact.position))
    refuse_asked("--contact: it is not a finite number");
  require_within("--rate", asked.options.loop_rate_hz, AskedFit::rates_hz);
  for (const double noise : asked.noise) require_positive("--noise", noise);
  if (!asked.no_folds) require_within("--folds", fit.folds, AskedFit::most_folds);
  require_within("--test-share", fit.test_share, AskedFit::test_shares);
  if (fit.loss_scale_n != 0.0) require_positive("--loss-scale", fit.loss_scale_n);
  require_within("--confidence", fit.confidence, AskedFit::confidences);
  if (asked.jnd.weber_fraction)
    require_within("--weber", *asked.jnd.weber_fraction, AskedFit::weber_fractions);
  if (asked.jnd.threshold && !(*asked.jnd.threshold >= 0.0 && std::isfinite(*asked.jnd.threshold)))
    refuse_asked(fmt::format("--threshold: {} is negative or no number", *asked.jnd.threshold));
}

}  // namespace

models::Contact AskedContact::over(models::Contact known) const {
  if (position) known.position = *position;
  if (!direction.empty()) known.direction = direction == "increasing" ? 1.0 : -1.0;
  return known;
}

fitting::Jnd AskedJnd::over(const fitting::Jnd& known) const {
  return {.weber_fraction = weber_fraction.value_or(known.weber_fraction),
          .threshold = threshold.value_or(known.threshold)};
}

void AskedJnd::put_into(fitting::FitOptions& options, const schema::Axis& axis) const {
  take_jnd_of(axis, options);
  options.jnd = over(options.jnd);
  if (weber_fraction || threshold) options.jnd_source = "given, without a source";
  if (!source.empty()) options.jnd_source = source;
}

void check(const AskedFit& asked, std::size_t recordings) {
  check_ranges(asked);
  if (asked.noise.size() > 1 && asked.noise.size() != recordings) {
    refuse_asked(fmt::format("--noise: {} values for {} recordings; give one, or one a recording",
                             asked.noise.size(),
                             recordings == 0 ? "a batch of" : std::to_string(recordings)));
  }
  if (!asked.options.fit.per_recording.empty() && recordings < 2)
    refuse_asked("--per-recording needs several recordings in one fit");
  if (asked.options.fit.loss_scale_n > 0.0 && asked.loss == "squares")
    refuse_asked("--loss-scale needs a robust --loss: huber, soft_l1 or cauchy");
  (void)parse_segments(asked.segments);
  const auto models = models_of(asked.options);
  for (const std::string& model : models) fitting::check_model(model);
  if (!asked.breakpoints.empty() && !asked.fits_segments())
    refuse_asked("--breakpoints says nothing to the laws that are fitted; it is for piecewise");
  check_law_options(models, law_options_of(asked));
}

bool AskedFit::fits_segments() const {
  return std::ranges::any_of(models_of(options), [](const std::string& model) {
    return models::law_facts(model).search == models::Search::segments;
  });
}

FitSource source_of(const AskedFit& asked, const schema::Recording& recording, const std::string& name,
                    std::size_t place) {
  FitSource source{.recording = &recording, .name = name, .axis = find_cut_axis(recording, asked.axis)};
  source.contact = asked.contact.over(contact_of(recording, source.axis));
  const auto& noise = asked.noise;
  if (!noise.empty()) source.noise_n = noise.size() == 1 ? noise.front() : noise.at(place);
  return source;
}

FitRecordingOptions options_of(const AskedFit& asked, const FitSource& source) {
  FitRecordingOptions options = asked.options;
  const Segments segments = parse_segments(asked.segments);
  options.segments = segments.count;
  options.fit.segments = segments.by;
  options.fit.breakpoints = breakpoints_of(asked, source);
  options.fit.loss = loss_of(asked.loss);
  if (asked.no_folds) options.fit.folds = 0;
  options.rows = {.rows = asked.rows == "all" ? Counted::all : Counted::contact,
                  .cycles = parse_cycle_choice(asked.cycles)};
  asked.jnd.put_into(options.fit, source.recording->axes[source.axis]);
  options.law_options = law_options_of(asked);
  return options;
}

RecordingFit fit_files(const std::vector<std::string>& files, const AskedFit& asked) {
  std::vector<schema::Recording> recordings;
  for (const std::string& file : files) recordings.push_back(read_fitted_columns(file));
  NewNames new_names;
  std::vector<FitSource> sources;
  AskedFit along(asked);  // one axis, that of the first
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    if (i == 1 && recordings[0].dimensions() > 1) along.axis = recordings[0].axes[sources.front().axis].name;
    // What names each file apart from the others: its stem, with a number where two have the same.
    const std::string name = new_names.take(std::filesystem::path(files[i]).stem()).string();
    sources.push_back(source_of(along, recordings[i], name, i));
    sources.back().taken = [&recording = recordings[i]] { drop_rows(recording); };
  }
  RecordingFit fit = fit_recordings(sources, options_of(asked, sources.front()));
  if (const std::string reason = fit.refusal(); !reason.empty())
    throw std::invalid_argument(fmt::format("{}: {}", files.front(), reason));
  return fit;
}

}  // namespace kerf::bench
