#include "fits/fit_files.h"

#include <fmt/core.h>

#include "files/json_file.h"
#include "files/whole_file.h"
#include "recordings/provenance.h"
#include "tables/csv.h"

namespace kerf::bench {
namespace {

constexpr auto csv_name = "fit.csv";
constexpr auto json_name = "fit.json";

std::string law_file_name(const std::string& model) { return model + ".law.toml"; }

std::string as_csv(const RecordingFit& fit) {
  const std::string interval = interval_name(fit.settings.confidence);
  std::string text =
      fmt::format("model,parameter,value,std_error,{0}_lower,{0}_upper,unit,recording\n", interval);
  for (const FittedLaw& law : fit.laws) {
    const auto add = [&](const fitting::Estimate& estimate) {
      const bool shared = estimate.recording == fitting::Estimate::shared;
      text +=
          fmt::format("{},{},{},{},{},{},{},{}\n", law.result.model, estimate.info.name, estimate.value,
                      estimate.std_error, estimate.lower, estimate.upper,
                      models::unit_of(estimate.info.quantity, law.file.force_unit, law.file.position_unit),
                      shared ? "" : csv_text(fit.recordings.at(estimate.recording).name));
    };
    for (const fitting::Estimate& estimate : law.result.parameters) add(estimate);
    for (const fitting::Estimate& estimate : law.result.others) add(estimate);
  }
  return text;
}

}  // namespace

std::string interval_name(double confidence) { return fmt::format("ci{:.6g}", 100.0 * confidence); }

std::vector<std::string> law_file_names(const RecordingFit& fit, const FittedLaw& law) {
  std::vector<std::string> names{law_file_name(law.result.model)};
  for (std::size_t i = 0; i < law.others.size(); ++i) {
    names.push_back(law_file_name(law.result.model + "." + fit.recordings[i + 1].name));
  }
  return names;
}

void refuse_to_replace_fits(const FitRecordingOptions& options, const std::filesystem::path& folder) {
  for (const std::string& model : models_of(options)) require_output(folder / law_file_name(model), false);
  for (const auto* table : {csv_name, json_name}) require_output(folder / table, false);
}

std::future<std::vector<FitProvenance>> name_meanwhile(std::vector<std::filesystem::path> recordings) {
  return std::async(std::launch::async, [recordings = std::move(recordings)] {
    std::vector<FitProvenance> named(recordings.size());
    for (std::size_t i = 0; i < named.size(); ++i) name_recording(named[i], recordings[i]);
    return named;
  });
}

void write_fits(RecordingFit& fit, std::span<const FitProvenance> named,
                const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  for (std::size_t i = 0; i < named.size(); ++i)
    fit.recordings.at(i).content_sha256 = named[i].recording_content;
  for (FittedLaw& law : fit.laws) {
    const auto names = law_file_names(fit, law);
    for (std::size_t i = 0; i < names.size(); ++i) {
      LawFile& file = i == 0 ? law.file : law.others[i - 1];
      file.fit.recording_sha256 = named[i].recording_sha256;
      file.fit.recording_content = named[i].recording_content;
      write_law_file(folder / names[i], file);
    }
  }
  write_whole_file(folder / csv_name, as_csv(fit));
  write_json_file(folder / json_name, fits_as_json(fit));
}

void write_fits(RecordingFit& fit, const std::filesystem::path& file, const std::filesystem::path& folder) {
  FitProvenance named;
  name_recording(named, file);
  write_fits(fit, std::span(&named, 1), folder);
}

}  // namespace kerf::bench
