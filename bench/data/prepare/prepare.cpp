#include "prepare/prepare.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include "prepare/rows.h"
#include "recordings/axes.h"
#include "recordings/provenance.h"
#include "signal/quantiles.h"
#include "signal/signal.h"

namespace kerf::bench {
namespace {

std::vector<double> column(const std::vector<double>& values, std::size_t axes, std::size_t axis) {
  std::vector<double> one;
  for (std::size_t i = axis; i < values.size(); i += axes) one.push_back(values[i]);
  return one;
}

const std::vector<double>& force_of(const schema::Recording& recording) {
  return recording.force_measured.empty() ? recording.force_commanded : recording.force_measured;
}

/// The axis along which onsets are told, if there is one.
std::optional<std::size_t> onset_axis(const schema::Recording& recording, const PrepareOptions& options) {
  if (!options.axis.empty() || recording.dimensions() == 1) return find_axis(recording, options.axis);
  return std::nullopt;
}

void add_component(ContactSignal& signal, const schema::Recording& recording, const std::string& name) {
  const auto axis = std::ranges::find(recording.axes, name, &schema::Axis::name);
  const auto channel = std::ranges::find(recording.channels, name, &schema::Channel::name);
  const bool is_axis = axis != recording.axes.end();
  if (!is_axis && channel == recording.channels.end()) {
    std::vector<std::string> known;
    for (const schema::Axis& one : recording.axes) known.push_back(one.name);
    for (const schema::Channel& one : recording.channels) known.push_back(one.name);
    throw std::invalid_argument(fmt::format(
        "--signal: there is no axis or channel '{}'; the recording has {}", name, fmt::join(known, ", ")));
  }
  const std::string unit = is_axis ? axis->force_unit : channel->unit;
  if (!signal.components.empty() && unit != signal.unit) {
    throw std::invalid_argument(fmt::format("--signal: {} is in {} and {} in {}; expected one unit",
                                            signal.name, signal.unit, name, unit));
  }
  if (is_axis && force_of(recording).empty()) {
    throw std::invalid_argument("the recording holds no force to find contacts in");
  }
  signal.unit = unit;
  signal.name += (signal.name.empty() ? "" : ", ") + name;
  signal.components.push_back(is_axis ? column(force_of(recording), recording.dimensions(),
                                               static_cast<std::size_t>(axis - recording.axes.begin()))
                                      : channel->values);
}

ContactSignal signal_of(const schema::Recording& recording, const PrepareOptions& options) {
  ContactSignal signal{.time_s = recording.time};
  const auto along = onset_axis(recording, options);
  std::vector<std::string> names = options.signal;
  if (names.empty() && along) names = {recording.axes[*along].name};
  if (names.empty()) {
    const auto& force = force_of(recording);
    for (std::size_t axis = 0; axis < recording.dimensions(); ++axis) {
      const auto one = column(force, recording.dimensions(), axis);
      const bool measured = std::ranges::any_of(one, [](double f) { return std::isfinite(f); });
      if (recording.axes[axis].force_unit == "N" && measured) names.push_back(recording.axes[axis].name);
    }
  }
  if (names.empty()) throw std::invalid_argument("the recording holds no force to find contacts in");
  for (const std::string& name : names) add_component(signal, recording, name);
  if (along) {
    signal.position = column(recording.position, recording.dimensions(), *along);
    signal.position_unit = recording.axes[*along].position_unit;
  }
  return signal;
}

std::string place_text(const schema::Recording& recording, double time_s) {
  std::string text;
  for (std::size_t axis = 0; axis < recording.dimensions(); ++axis) {
    const auto position = column(recording.position, recording.dimensions(), axis);
    text += fmt::format("{}{} {:.6g} {}", text.empty() ? "" : ", ", recording.axes[axis].name,
                        interpolate(recording.time, position, std::span(&time_s, 1)).front(),
                        recording.axes[axis].position_unit);
  }
  return text;
}

/// One run over a recording: each member a step.
class Run {
 public:
  Run(schema::Recording recording, const PrepareOptions& options) : options_(options) {
    done_.rows_before = recording.rows();
    done_.recording = std::move(recording);
  }

  Prepared run() {
    if (options_.drop_gaps) drop_gaps();
    const bool needs_free = (options_.weight && !options_.weight_options.mass_kg) || options_.bias;
    if (options_.weight) take_weight();
    if (options_.blank) take_blank();
    if (options_.onset || options_.labels || (needs_free && options_.bias)) find();
    if (options_.bias) take_bias();
    if (options_.onset) store_onsets();
    if (options_.labels) score();
    if (options_.filter) filter();
    if (options_.from_s || options_.to_s) keep_time();
    if (!options_.cycles.empty()) choose_cycles();
    if (done_.steps.empty() && !done_.score) {
      throw std::invalid_argument(
          "nothing to do: ask for --drop-gaps, --weight, --blank, --bias, --onset, --filter, --from, --to or "
          "--cycles");
    }
    if (done_.recording.rows() == 0) throw std::invalid_argument("no row is left");
    return std::move(done_);
  }

 private:
  schema::Recording& recording() { return done_.recording; }

  void note(const std::string& step) {
    done_.steps.push_back(step);
    add_history(recording().header, "prepare: " + step);
  }

  void drop_gaps() {
    const auto finite = finite_rows(recording());
    done_.gap_rows = static_cast<std::size_t>(std::count(finite.begin(), finite.end(), false));
    keep_rows(recording(), finite);
    note(fmt::format("{} of {} rows left out that were not finite", done_.gap_rows, done_.rows_before));
    if (recording().rows() == 0) throw std::invalid_argument("no row is finite in all its values");
  }

  std::vector<bool> free_now() {
    find();
    return free_rows(recording().time, *done_.contacts, options_.contact.free);
  }

  void find() {
    const ContactSignal signal = signal_of(recording(), options_);
    done_.contact_signal = signal.name;
    done_.contacts = find_contacts(signal, options_.contact);
  }

  void take_weight() {
    std::vector<bool> free(recording().rows(), true);
    if (!options_.weight_options.mass_kg) free = free_now();
    const Weight weight = remove_weight(recording(), free, options_.weight_options);
    done_.weight = weight;
    const auto& c = weight.centre_m;
    std::string text = fmt::format("weight of {:.6g} kg at {:.6g}, {:.6g}, {:.6g} m taken off",
                                   weight.mass_kg, c[0], c[1], c[2]);
    if (weight.estimated) {
      const auto& f = weight.force_bias_n;
      const auto& t = weight.torque_bias_nm;
      text += fmt::format(
          ", estimated with {:.2g} kg standard error from {} free rows, with bias {:.6g}, {:.6g}, {:.6g} N "
          "and "
          "{:.6g}, {:.6g}, {:.6g} N·m",
          weight.mass_error_kg, weight.rows, f[0], f[1], f[2], t[0], t[1], t[2]);
      if (weight.mass_kg < 3.0 * weight.mass_error_kg) {
        done_.warnings.push_back(
            fmt::format("the weight is {:.3g} +- {:.2g} kg: not told from zero, or the sensor counts forces "
                        "in the other direction",
                        weight.mass_kg, weight.mass_error_kg));
      }
    }
    note(text);
  }

  void take_blank() {
    done_.blank = remove_blank(recording(), *options_.blank);
    done_.warnings.insert(done_.warnings.end(), done_.blank->warnings.begin(), done_.blank->warnings.end());
    note(blank_step(*done_.blank));
  }

  void take_bias() {
    const auto free = free_rows(recording().time, *done_.contacts, options_.contact.free);
    if (options_.contact.free.empty() && done_.contacts->contacts.empty()) {
      done_.warnings.emplace_back(
          "no contact was found, so every row counts as free; --free A:B says what is");
    }
    done_.bias = remove_bias(recording(), free, options_.drift);
    std::string text = fmt::format("bias taken off, from {} free rows:", done_.bias->rows);
    for (const AxisBias& axis : done_.bias->axes) {
      text += fmt::format(" {} {:.6g}+-{:.2g} {}", axis.axis, axis.offset, axis.offset_error, axis.unit);
      if (options_.drift) {
        text += fmt::format(" {:+.6g}+-{:.2g} {}/min", axis.drift_per_minute, axis.drift_per_minute_error,
                            axis.unit);
      }
    }
    note(text);
  }

  void store_onsets() {
    const auto& found = *done_.contacts;
    std::erase_if(recording().events, [](const schema::Event& event) {
      return event.kind == "contact" || event.kind == "release";
    });
    for (const ContactFound& contact : found.contacts) {
      recording().events.push_back(
          {.time_s = contact.onset_s,
           .kind = "contact",
           .text =
               fmt::format("at {:.6f} s (+-{:.2g} s), {}; peak {:.4g}", contact.onset_s,
                           contact.onset_error_s, place_text(recording(), contact.onset_s), contact.peak)});
      const double end_s = recording().time[contact.rows.end - 1];
      recording().events.push_back(
          {.time_s = end_s,
           .kind = "release",
           .text = fmt::format("at {:.6f} s, {}", end_s, place_text(recording(), end_s))});
    }
    std::ranges::stable_sort(recording().events, {}, &schema::Event::time_s);
    std::string text = fmt::format("{} contacts in the force of {}: noise {:.3g}, threshold {:.3g}",
                                   found.contacts.size(), done_.contact_signal, found.noise, found.threshold);
    if (found.contacts.empty()) {
      done_.warnings.emplace_back("no contact was found; --sigmas and --least set the threshold");
    } else if (const auto axis = onset_axis(recording(), options_)) {
      text += place_contact(*axis);
    }
    note(text);
  }

  /// The middle of the onsets becomes the axis' contact, where `kerf fit` begins to count.
  std::string place_contact(std::size_t axis) {
    const auto place = place_of(done_.contacts->contacts);
    schema::Axis& about = recording().axes[axis];
    if (!place) {
      done_.warnings.push_back(fmt::format(
          "{} moves in neither direction from the onsets to the peaks, so no contact position is stored",
          about.name));
      return {};
    }
    about.contact_position = place->position;
    about.contact_direction = place->direction;
    about.contact_error = place->error;
    const std::string error =
        std::isfinite(place->error) ? fmt::format(" (+-{:.2g} {})", place->error, about.position_unit) : "";
    return fmt::format("; contact at {} {:.6g} {}{}, {}", about.name, about.contact_position,
                       about.position_unit, error,
                       about.contact_direction > 0.0 ? "increasing" : "decreasing");
  }

  void score() {
    const auto channel =
        std::ranges::find(recording().channels, options_.labels->channel, &schema::Channel::name);
    if (channel == recording().channels.end()) {
      throw std::invalid_argument(
          fmt::format("--score-labels: the recording has no channel '{}'", options_.labels->channel));
    }
    const auto labels = labelled_spans(channel->values, options_.labels->value);
    if (labels.empty()) {
      throw std::invalid_argument(fmt::format("--score-labels: channel '{}' is never {:g}",
                                              options_.labels->channel, options_.labels->value));
    }
    std::vector<RowSpan> detected;
    for (const ContactFound& contact : done_.contacts->contacts) detected.push_back(contact.rows);
    done_.score = score_contacts(detected, labels, recording().time);
  }

  void filter() {
    done_.filter = apply_filter(recording(), *options_.filter, options_.filter_position);
    std::string text = fmt::format("filter {} on the force{}", to_text(*options_.filter),
                                   options_.filter_position ? ", position and velocity" : "");
    text += "; gain, phase:";
    for (const Response& response : done_.filter->responses) {
      text +=
          fmt::format(" {:g} Hz {:.4g} {:.4g} deg", response.frequency_hz, response.gain, response.phase_deg);
    }
    note(text);
    if (done_.filter->stretches > 1) {
      done_.warnings.push_back(
          fmt::format("rows are missing: {} stretches were filtered apart", done_.filter->stretches));
    }
  }

  void keep_time() {
    const double from_s = options_.from_s.value_or(recording().time.front());
    const double to_s = options_.to_s.value_or(recording().time.back());
    std::vector<bool> rows;
    for (const double time_s : recording().time) rows.push_back(time_s >= from_s && time_s <= to_s);
    const auto kept = std::count(rows.begin(), rows.end(), true);
    if (kept == 0) {
      throw std::invalid_argument(
          fmt::format("--from {:g} --to {:g} keeps no row; the recording runs from {:g} "
                      "to {:g} s",
                      from_s, to_s, recording().time.front(), recording().time.back()));
    }
    keep_rows(recording(), rows);
    note(fmt::format("the {} rows from {:g} to {:g} s kept", kept, from_s, to_s));
  }

  void choose_cycles() {
    keep_cycles(recording(), options_.cycles);
    note(fmt::format("cycles {} kept, {} rows", fmt::join(options_.cycles, ", "), recording().rows()));
  }

  const PrepareOptions& options_;
  Prepared done_;
};

}  // namespace

Prepared prepare(schema::Recording recording, const PrepareOptions& options) {
  return Run(std::move(recording), options).run();
}

}  // namespace kerf::bench
