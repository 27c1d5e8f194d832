#include "regress/stored/summary.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <optional>
#include <span>
#include <string_view>

#include <fmt/ranges.h>

#include <kerf/compare/vibration.h>

#include "files/named_file.h"
#include "recordings/provenance.h"
#include "regress/compare.h"
#include "regress/path.h"
#include "regress/stored/conflict.h"
#include "units/units.h"

namespace kerf::bench {
namespace {

std::string in_one_line(std::string text) {
  std::ranges::replace(text, '\n', ' ');
  return text;
}

std::string summary_line(std::string_view key, std::string_view value) {
  return fmt::format("{:<10} {}\n", key, value);
}

/// The value of a key at the beginning of a line, up to its first blank.
std::string first_word_of(std::string_view text, std::string_view key) {
  const std::string begin = fmt::format("\n{:<10} ", key);
  const auto at = text.find(begin);
  if (at == std::string_view::npos) return {};
  text.remove_prefix(at + begin.size());
  return std::string(text.substr(0, text.find_first_of(" \n")));
}

std::string parameters_of(const LawFile& law) {
  const std::vector<models::ParameterInfo> about = law.law.parameters();
  std::vector<std::string> all;
  for (std::size_t i = 0; i < about.size(); ++i) {
    const std::string unit = models::unit_of(about[i].quantity, law.force_unit, law.position_unit);
    all.push_back(fmt::format("{} {}{}", about[i].name, law.law.values()[i], unit == "1" ? "" : " " + unit));
  }
  return fmt::format("{}", fmt::join(all, ", "));
}

/// What was stored for this motion, if it is still the motion of the case.
std::optional<SampledMotion> motion_of(const RegressionCase& about, const schema::StoredForces& stored) {
  try {
    SampledMotion motion = path_of(about);
    if (checksum(motion, stored.channels.size()) == stored.trajectory_sha256) return motion;
  } catch (const std::exception&) {  // a recording that is gone: nothing is known of its motion
  }
  return {};
}

/// The sum of force times step [work_unit()], with the force in the middle of the step.
double work_of(std::span<const double> force, const SampledMotion& motion, std::size_t axis) {
  double work = 0.0;
  for (std::size_t tick = 1; tick < force.size(); ++tick)
    work += 0.5 * (force[tick] + force[tick - 1]) *
            (motion.sample[tick].position[axis] - motion.sample[tick - 1].position[axis]);
  return work;
}

/// `position_unit` of its axis, where the motion is known.
std::string channel_lines(const compare::Channel& channel, const std::optional<SampledMotion>& motion,
                          std::size_t axis, const std::string& position_unit) {
  double peak = 0.0;
  double squares = 0.0;
  for (const double force : channel.value) {
    peak = std::max(peak, std::abs(force));
    squares += force * force;
  }
  const auto rows = static_cast<double>(std::max<std::size_t>(channel.value.size(), 1));
  std::string text = summary_line(
      channel.name, fmt::format("peak {0:.6g} {2}, RMS {1:.6g} {2}, work {3}", peak,
                                std::sqrt(squares / rows), channel.unit,
                                motion ? fmt::format("{:.6g} {}", work_of(channel.value, *motion, axis),
                                                     work_unit(channel.unit, position_unit))
                                       : "unknown"));
  if (!motion) return text;  // nor is the rate known
  const double rate_hz = 1.0 / motion->period_s.back();
  for (const compare::BandLevel& band : compare::band_levels(channel.value, rate_hz, channel.unit))
    text += summary_line("", fmt::format("RMS {:.0f} to {:.0f} Hz {:.4g} {}", band.from_hz, band.to_hz,
                                         band.rms, channel.unit));
  return text;
}

std::string block_of(const RegressionCase* about, const schema::StoredForces& stored) {
  // What the suite says of a case is of these forces only as long as it has not changed.
  const bool known = about != nullptr && about->error.empty() && checksum(*about) == stored.law_sha256;
  const auto motion = known ? motion_of(*about, stored) : std::nullopt;
  std::string text = fmt::format("[{}]\n", in_one_line(stored.name));
  text += summary_line("renderer", in_one_line(stored.renderer.empty() ? stored.model : stored.renderer));
  if (known && !about->outside) text += summary_line("parameters", parameters_of(about->law));
  text += summary_line("law", stored.law_sha256) + summary_line("trajectory", stored.trajectory_sha256);
  text += summary_line("stored", fmt::format("{} by {}", stored.date, stored.software));
  text += summary_line("reason", in_one_line(stored.reason));
  text += summary_line("ticks", fmt::format("{}, {} faults", stored.rows(), stored.faults));
  text += summary_line("forces", forces_sha256(stored));
  const compare::Series series = series_of(stored);
  for (std::size_t i = 0; i < series.channels.size(); ++i)
    text += channel_lines(series.channels[i], motion, i, motion ? axes_of(*about).at(i).position_unit : "");
  return text;
}

const SummaryBlock* block_named(const std::vector<SummaryBlock>& blocks, const std::string& name) {
  const auto found = std::ranges::find(blocks, in_one_line(name), &SummaryBlock::name);
  return found == blocks.end() ? nullptr : &*found;
}

}  // namespace

std::string forces_sha256(const schema::StoredForces& stored) {
  std::string bytes = fmt::format("{} faults\n", stored.faults);
  for (const schema::ForceChannel& channel : stored.channels)
    bytes += fmt::format("{} [{}]\n", channel.name, channel.unit);
  bytes.append(reinterpret_cast<const char*>(stored.force.data()), stored.force.size() * sizeof(double));
  return sha256_of(std::string_view(bytes));
}

std::filesystem::path summary_file(const Suite& suite) {
  std::filesystem::path file = suite.stored;
  return file.replace_extension(".forces.txt");
}

std::vector<SummaryBlock> read_summary(const Suite& suite) {
  const std::filesystem::path file = summary_file(suite);
  const std::string text = read_named_file(file, LargestInput::text);
  require_no_conflict(file, text, suite);
  std::vector<SummaryBlock> blocks;
  for (std::string_view rest = text; !rest.empty();) {
    const auto next = rest.find("\n[", 1);
    std::string_view block = rest.substr(0, next == std::string_view::npos ? next : next + 1);
    rest.remove_prefix(block.size());
    if (!block.starts_with('[')) continue;
    const auto end = block.find("]\n");
    while (block.ends_with("\n\n")) block.remove_suffix(1);
    if (end == std::string_view::npos) continue;
    blocks.push_back({.name = std::string(block.substr(1, end - 1)),
                      .date = first_word_of(block, "stored"),
                      .forces_sha256 = first_word_of(block, "forces"),
                      .text = std::string(block)});
  }
  return blocks;
}

std::string summary_text(const Suite& suite, const std::vector<schema::StoredForces>& stored,
                         const std::vector<SummaryBlock>& before) {
  std::string text = fmt::format(
      "# What is stored in {}, for people and for diffs.\n"
      "# 'kerf regress update' writes this, 'kerf regress run' checks it; do not edit it.\n",
      suite.stored.filename().string());
  for (const schema::StoredForces& one : stored) {
    const SummaryBlock* const there = block_named(before, one.name);
    const auto about = std::ranges::find(suite.cases, one.name, &RegressionCase::name);
    const bool same =
        there != nullptr && there->date == one.date && there->forces_sha256 == forces_sha256(one);
    text += '\n' + (same ? there->text : block_of(about == suite.cases.end() ? nullptr : &*about, one));
  }
  return text;
}

SummaryCheck check_summary(const Suite& suite, const std::vector<schema::StoredForces>& stored) {
  SummaryCheck check;
  const std::string file = summary_file(suite).string();
  const std::string mend =
      fmt::format("'kerf regress update {} --reason WHY' writes it anew", suite.file.string());
  if (!std::filesystem::exists(file)) {
    if (!stored.empty()) check.notes.push_back(fmt::format("{} is missing; {}", file, mend));
    return check;
  }
  const std::vector<SummaryBlock> blocks = read_summary(suite);
  std::vector<std::string> stale;
  for (const schema::StoredForces& one : stored) {
    const SummaryBlock* const block = block_named(blocks, one.name);
    if (block == nullptr || block->date != one.date) {
      stale.push_back(one.name);
    } else if (block->forces_sha256 != forces_sha256(one)) {
      check.wrong[one.name] = fmt::format(
          "{} says that other forces were stored on {} than {} holds: either was edited or taken from "
          "another "
          "branch; restore both from one commit, or look at the forces and {}",
          file, one.date, suite.stored.string(), mend);
    }
  }
  for (const SummaryBlock& block : blocks) {
    if (std::ranges::none_of(stored, [&](const auto& one) { return in_one_line(one.name) == block.name; }))
      stale.push_back(block.name);
  }
  if (!stale.empty())
    check.notes.push_back(fmt::format(
        "{} is of other forces than {} for {} (a merge that took one side of a binary file does this); {}",
        file, suite.stored.string(), fmt::join(stale, ", "), mend));
  return check;
}

}  // namespace kerf::bench
