#include "results/study_tables.h"

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/ranges.h>

#include "files/whole_file.h"
#include "tables/described_table.h"

namespace kerf::bench {
namespace {

std::string lower_cell(const std::optional<population::Interval>& interval) {
  return interval ? cell(std::optional(interval->lower)) : "";
}
std::string upper_cell(const std::optional<population::Interval>& interval) {
  return interval ? cell(std::optional(interval->upper)) : "";
}

DescribedTable recordings_table(const StudyResults& results) {
  DescribedTable table{"recordings",
                       {{"recording", "", "name in the study"},
                        {"file", "", "path below the drawer"},
                        {"sha256", "", "of the file"},
                        {"content_sha256", "", "of what was sampled, whatever is said of it"},
                        {"tissue", "", "as study.toml has it"},
                        {"speed", "", "as study.toml has it"},
                        {"specimen", "", "empty: not known"},
                        {"blank", "", "the tool without a tissue"},
                        {"blank_taken_off", "", "name of the blank; empty: none"},
                        {"blank_rows", "1", "samples that it covers"},
                        {"blank_rms", "column force_unit", "what was taken off, root mean square"},
                        {"blank_spread", "column force_unit", "of it from cycle to cycle of the blank"},
                        {"negative_after", "1", "share of these samples below zero then"},
                        {"counts", "", "in what is said of its tissue and speed"},
                        {"why_not", "", "failure, doubts or why no law was fitted"},
                        {"rows", "1", "samples"},
                        {"duration", "s", "from the first row to the last"},
                        {"period", "s", "usual step of time"},
                        {"position_unit", "", "of travel"},
                        {"travel", "column position_unit", "range of the positions"},
                        {"force_unit", "", "of the four next"},
                        {"peak", "column force_unit", "largest force of the rows that count"},
                        {"rms", "column force_unit", "root mean square force of the rows that count"},
                        {"jnd", "column force_unit", "just noticeable difference at that force"},
                        {"floor", "column force_unit",
                         "error on held-out data of the best map of position, direction and velocity"},
                        {"cycles", "1", "closings"},
                        {"good_cycles", "1", "without a flag, or accepted"},
                        {"law", "", "the simplest that serves, or the best"},
                        {"warnings", "", "what is to be known of it, with ' | ' between"}}};
  for (const DrawerRecording& one : results.recordings) {
    const StudiedRecording& found = one.result;
    const bool is_there = found.failure.empty();
    std::size_t good = 0;
    for (const StudiedCycle& cycle : found.cycles) good += cycle.is_good ? 1 : 0;
    std::vector<std::string> why = one.doubts;
    if (!found.failure.empty()) why.push_back(found.failure);
    if (!found.not_fitted.empty()) why.push_back(found.not_fitted);
    const auto of_blank = [&](std::string (*what)(const StudiedBlank&)) {
      return found.blank && found.blank->is_taken() ? what(*found.blank) : std::string();
    };
    const auto known = [&](const std::string& text) { return is_there ? text : std::string(); };
    table.add({cell(one.name),
               cell(one.file.path),
               one.file.sha256,
               found.content,
               cell(one.file.tissue),
               cell(one.file.speed),
               cell(one.file.specimen),
               cell(one.file.blank),
               of_blank([](const StudiedBlank& blank) { return cell(blank.name); }),
               of_blank([](const StudiedBlank& blank) { return cell(std::size_t{blank.covered}); }),
               of_blank([](const StudiedBlank& blank) { return csv_number(blank.taken_rms); }),
               of_blank([](const StudiedBlank& blank) { return csv_number(blank.spread_rms); }),
               of_blank([](const StudiedBlank& blank) { return csv_number(blank.negative_after); }),
               cell(one.counts()),
               csv_text(fmt::format("{}", fmt::join(why, " | "))),
               known(cell(std::size_t{found.rows})),
               known(csv_number(found.duration_s)),
               known(csv_number(found.period_s)),
               found.position_unit,
               known(csv_number(found.travel)),
               found.force_unit,
               known(csv_number(found.peak)),
               known(csv_number(found.rms)),
               known(csv_number(found.jnd)),
               found.laws.empty() ? "" : csv_number(found.floor),
               known(cell(found.cycles.size())),
               known(cell(good)),
               found.chosen,
               csv_text(fmt::format("{}", fmt::join(found.warnings, " | ")))});
  }
  return table;
}

DescribedTable cycles_table(const StudyResults& results) {
  DescribedTable table{"cycles",
                       {{"recording", "", "name in the study"},
                        {"cycle", "", "number, from 1"},
                        {"begin", "s", "time of its first row"},
                        {"closing", "s", "duration of the closing"},
                        {"peak", "N (N·m about an axis)", "largest force"},
                        {"closing_work", "J (N·rad of a force over an angle)",
                         "from the begin of the closing to the most closed row"},
                        {"good", "", "counts"},
                        {"reason", "", "what is wrong with it; of a good one what was found and accepted"}}};
  for (const DrawerRecording& one : results.recordings) {
    for (const StudiedCycle& cycle : one.result.cycles)
      table.add({cell(one.name), cell(std::size_t{cycle.number}), csv_number(cycle.begin_s),
                 csv_number(cycle.closing_s), csv_number(cycle.peak), csv_number(cycle.closing_work),
                 cell(cycle.is_good), cell(cycle.reason)});
  }
  return table;
}

DescribedTable parameters_table(const StudyResults& results) {
  DescribedTable table{"parameters",
                       {{"recording", "", "name in the study"},
                        {"law", "", "name of the law"},
                        {"parameter", "", "name of the parameter"},
                        {"value", "column unit", "estimate"},
                        {"std_error", "column unit", "standard error; empty: the recording sets no limit"},
                        {"unit", "", "in SI"}}};
  const auto add = [&](const std::string& recording, const std::string& law,
                       const std::vector<StudiedParameter>& parameters) {
    for (const StudiedParameter& parameter : parameters)
      table.add({cell(recording), law, parameter.name, csv_number(parameter.value),
                 csv_number(parameter.std_error), cell(parameter.unit)});
  };
  for (const DrawerRecording& one : results.recordings) {
    for (const StudiedLaw& law : one.result.laws) add(one.name, law.model, law.parameters);
    if (one.result.blade) add(one.name, "blade", one.result.blade->parameters);
  }
  return table;
}

DescribedTable groups_table(const StudyResults& results) {
  DescribedTable table{
      "groups",
      {{"tissue", "", "as study.toml has it"},
       {"speed", "", "as study.toml has it"},
       {"quantity", "", "peak, work, or LAW.PARAMETER"},
       {"unit", "", "of the values"},
       {"logarithm", "", "true: the numbers that follow are natural logarithms of values, spreads relative"},
       {"recordings", "1", "that counted"},
       {"specimens", "1", "empty: not known"},
       {"mean", "column unit", "over specimens"},
       {"std_error", "column unit", "of the mean"},
       {"lower", "column unit", "95 % interval of the mean"},
       {"upper", "column unit", "95 % interval of the mean"},
       {"between_specimens", "column unit", "standard deviation"},
       {"between_recordings", "column unit",
        "standard deviation, of one specimen, beyond the standard errors"},
       {"together", "column unit", "standard deviation, where the two cannot be told apart"},
       {"next_lower", "column unit", "95 % interval of the next specimen"},
       {"next_upper", "column unit", "95 % interval of the next specimen"}}};
  for (const StudiedGroup& group : results.groups) {
    for (const StudiedQuantity& quantity : group.quantities) {
      const population::GroupEstimate& found = quantity.estimate;
      const auto spread = [](const std::optional<population::Spread>& of) {
        return of ? csv_number(of->value) : std::string();
      };
      table.add({cell(group.tissue), cell(group.speed), quantity.name, cell(quantity.unit),
                 cell(quantity.is_logarithm), cell(found.recordings),
                 found.specimens ? cell(*found.specimens) : "", cell(found.mean), cell(found.standard_error),
                 lower_cell(found.interval), upper_cell(found.interval), spread(found.between_specimens),
                 spread(found.between_recordings), spread(found.together), lower_cell(found.of_the_next),
                 upper_cell(found.of_the_next)});
    }
  }
  return table;
}

DescribedTable held_out_table(const StudyResults& results) {
  DescribedTable table{
      "held_out",
      {{"recording", "", "name in the study"},
       {"law", "", "name of the law"},
       {"free_parameters", "1", "that were fitted"},
       {"rmse", "JND", "error on what it was fitted to"},
       {"held_out", "JND", "error on cycles of the recording that it was not fitted to"},
       {"on_others", "JND",
        "error of the law fitted to the other specimens (recordings, where those are not named) of "
        "its tissue and speed; empty: there are none, or it could not be fitted"}}};
  for (const DrawerRecording& one : results.recordings) {
    for (const StudiedLaw& law : one.result.laws) {
      std::string others;
      for (const StudiedGroup& group : results.groups)
        for (const ErrorOnOthers& error : group.on_others)
          if (error.recording == one.name && error.law == law.model) others = csv_number(error.error_jnd);
      table.add({cell(one.name), law.model, cell(law.free_parameters), csv_number(law.rmse / one.result.jnd),
                 csv_number(law.held_out / one.result.jnd), others});
    }
  }
  return table;
}

DescribedTable comparisons_table(const StudyResults& results) {
  DescribedTable table{"comparisons",
                       {{"quantity", "", "peak, work, or LAW.PARAMETER"},
                        {"by", "", "tissue or speed"},
                        {"first", "", "tissue and speed"},
                        {"second", "", "tissue and speed"},
                        {"verdict", "", "differ, not told apart, or cannot be told"},
                        {"logarithm", "", "true: the difference is the logarithm of a ratio"},
                        {"first_units", "1", "specimens (recordings, where those are not known)"},
                        {"second_units", "1", "specimens (recordings, where those are not known)"},
                        {"difference", "column unit", "first less second"},
                        {"lower", "column unit", "95 % interval of the difference"},
                        {"upper", "column unit", "95 % interval of the difference"},
                        {"hedges_g", "1", "difference in standard deviations of specimens"},
                        {"p", "1", "of the permutation test"},
                        {"p_holm", "1", "corrected for all comparisons of the study"},
                        {"p_benjamini_hochberg", "1", "of the share of false alarms"},
                        {"unit", "", "of the difference, unless it is a logarithm"}}};
  for (const StudiedComparison& one : results.comparisons) {
    const population::Comparison& found = one.found;
    const auto tested = [&](double p) { return found.test ? csv_number(p) : std::string(); };
    table.add({one.quantity, one.by, cell(one.first), cell(one.second), population::name_of(found.verdict),
               cell(one.is_logarithm), cell(found.first_units), cell(found.second_units),
               cell(found.difference), lower_cell(found.interval), upper_cell(found.interval),
               cell(found.hedges_g), found.test ? csv_number(found.test->p) : "", tested(found.holm_p),
               tested(found.benjamini_hochberg_p), cell(one.unit)});
  }
  return table;
}

}  // namespace

void write_study_tables(const StudyResults& results, const std::filesystem::path& folder) {
  const std::array tables{recordings_table(results), cycles_table(results),   parameters_table(results),
                          groups_table(results),     held_out_table(results), comparisons_table(results)};
  std::string dictionary = "table,column,unit,meaning\n";
  for (const DescribedTable& table : tables) {
    write_whole_file(folder / (std::string(table.name) + ".csv"), table.text());
    for (const TableColumn& column : table.columns)
      dictionary += fmt::format("{},{},{},{}\n", table.name, column.name, csv_text(column.unit),
                                csv_text(column.meaning));
  }
  write_whole_file(folder / "data_dictionary.csv", dictionary);
}

}  // namespace kerf::bench
