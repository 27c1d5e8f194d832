#include <algorithm>
#include <array>
#include <functional>

#include <fmt/core.h>

#include "files/json_number.h"
#include "fits/batch.h"
#include "fits/fit_files.h"
#include "tables/csv.h"

namespace kerf::bench {
namespace {

using json = nlohmann::ordered_json;

constexpr std::size_t parameters_listed = 40;  ///< of a law; more are a table to be seen as a curve

struct TableColumn {
  const char* name;
  std::function<double(const fitting::FitResult&)> value;
};

const std::vector<TableColumn>& table_columns() {
  using fitting::FitResult;
  static const std::vector<TableColumn> all{
      {"free_parameters", [](const FitResult& fit) { return static_cast<double>(fit.free_parameters); }},
      {"rmse", [](const FitResult& fit) { return fit.rmse; }},
      {"max_abs", [](const FitResult& fit) { return fit.max_abs; }},
      {"r2", [](const FitResult& fit) { return fit.r2; }},
      {"aic", [](const FitResult& fit) { return fit.aic; }},
      {"bic", [](const FitResult& fit) { return fit.bic; }},
      {"cv_rmse", [](const FitResult& fit) { return fit.cv_rmse; }},
      {"test_rmse", [](const FitResult& fit) { return fit.test_rmse; }},
      {"jnd_fraction", [](const FitResult& fit) { return fit.jnd_fraction; }},
      {"correlation_time_samples", [](const FitResult& fit) { return fit.correlation_time; }}};
  return all;
}

const char* status_of(const FittedLaw& law) { return law.result.converged ? "fitted" : "not converged"; }

bool is_listed(const FittedLaw& law) { return law.result.parameters.size() <= parameters_listed; }

/// Every parameter of the table in the order in which the laws first name it.
std::vector<std::string> columns_of(const std::vector<BatchEntry>& entries) {
  std::vector<std::string> columns;
  for (const BatchEntry& entry : entries) {
    for (const FittedLaw& law : entry.fit.laws) {
      if (!is_listed(law)) continue;
      for (const fitting::Estimate& estimate : law.result.parameters) {
        if (std::find(columns.begin(), columns.end(), estimate.info.name) == columns.end())
          columns.push_back(estimate.info.name);
      }
    }
  }
  return columns;
}

std::string parameter_cells(const FittedLaw& law, const std::vector<std::string>& columns) {
  std::string cells;
  for (const std::string& column : columns) {
    const auto& all = law.result.parameters;
    const auto found = std::find_if(all.begin(), all.end(),
                                    [&](const auto& estimate) { return estimate.info.name == column; });
    if (!is_listed(law) || found == all.end()) {
      cells += ",,,";
    } else {
      cells += fmt::format(",{},{},{}", csv_number(found->value), csv_number(found->lower),
                           csv_number(found->upper));
    }
  }
  return cells;
}

/// A row of a law that was not fitted, or of a recording without one.
std::string bare_row(const std::string& recording, const Refusal& refusal, const char* status,
                     std::size_t columns) {
  const std::string empty(4 + table_columns().size() + 3 * columns, ',');
  return fmt::format("{},{},{}{},{}\n", csv_text(recording), refusal.model, status, empty,
                     csv_text(refusal.why));
}

std::string law_row(const BatchEntry& entry, const FittedLaw& law, const std::vector<std::string>& columns) {
  const fitting::FitResult& fit = law.result;
  std::string reason;
  for (const std::string& warning : fit.warnings) reason += (reason.empty() ? "" : "; ") + warning;
  std::string row = fmt::format("{},{},{},{},{},{},{}", csv_text(entry.recording), fit.model, status_of(law),
                                entry.fit.choice.model == fit.model ? "yes" : "no", fit.samples,
                                csv_text(law.file.position_unit), csv_text(law.file.force_unit));
  for (const TableColumn& column : table_columns()) row += fmt::format(",{}", csv_number(column.value(fit)));
  return fmt::format("{}{},{}\n", row, parameter_cells(law, columns), csv_text(reason));
}

json law_as_json(const FittedLaw& law, const std::string& interval) {
  const fitting::FitResult& fit = law.result;
  json row{{"law", fit.model}, {"status", status_of(law)}, {"samples", fit.samples}};
  for (const TableColumn& column : table_columns()) {
    const double value = column.value(fit);
    row[column.name] = json_number(value);
  }
  row["seconds"] = fit.seconds;
  row["warnings"] = fit.warnings;
  row["parameters"] = json::object();
  for (const fitting::Estimate& estimate : fit.parameters) {
    if (!is_listed(law)) break;
    row["parameters"][estimate.info.name] = {
        {"value", estimate.value},
        {"std_error", json_number(estimate.std_error)},
        {interval, {json_number(estimate.lower), json_number(estimate.upper)}},
        {"unit", models::unit_of(estimate.info.quantity, law.file.force_unit, law.file.position_unit)}};
  }
  return row;
}

}  // namespace

std::string batch_csv(const std::vector<BatchEntry>& entries, double confidence) {
  const auto columns = columns_of(entries);
  const std::string interval = interval_name(confidence);
  std::string text = "recording,law,status,chosen,samples,position_unit,force_unit";
  for (const TableColumn& column : table_columns()) text += fmt::format(",{}", column.name);
  for (const std::string& name : columns)
    text += fmt::format(",{0},{0}_{1}_lower,{0}_{1}_upper", name, interval);
  text += ",reason\n";
  for (const BatchEntry& entry : entries) {
    for (const FittedLaw& law : entry.fit.laws) text += law_row(entry, law, columns);
    for (const Refusal& refusal : entry.fit.refusals)
      text += bare_row(entry.recording, refusal, "refused", columns.size());
    if (entry.fit.laws.empty() && entry.fit.refusals.empty())
      text += bare_row(entry.recording, {.model = "", .why = entry.failure}, "failed", columns.size());
  }
  return text;
}

json batch_json(const std::vector<BatchEntry>& entries, double confidence) {
  json recordings = json::array();
  std::size_t failed = 0;
  for (const BatchEntry& entry : entries) {
    failed += entry.failure.empty() ? 0 : 1;
    json laws = json::array();
    for (const FittedLaw& law : entry.fit.laws) laws.push_back(law_as_json(law, interval_name(confidence)));
    for (const auto& [model, why] : entry.fit.refusals)
      laws.push_back({{"law", model}, {"status", "refused"}, {"why", why}});
    recordings.push_back({{"recording", entry.recording},
                          {"failure", entry.failure.empty() ? json(nullptr) : json(entry.failure)},
                          {"choice", {{"model", entry.fit.choice.model}, {"why", entry.fit.choice.why}}},
                          {"fits", laws},
                          {"warnings", entry.fit.warnings}});
  }
  return {{"count", entries.size()}, {"failed", failed}, {"recordings", recordings}};
}

}  // namespace kerf::bench
