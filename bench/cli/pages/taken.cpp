#include "pages/taken.h"

#include <algorithm>
#include <string_view>

#include <fmt/core.h>
#include <fmt/ranges.h>

namespace kerf::bench {
namespace {

struct NamedValue {
  std::string_view name;  ///< an option's or a value's; "laws NAME" is NAME of that verb alone
  Taken taken;
};

/// A text that is not named here is any file's name: so a shell takes it where it knows nothing.
const std::vector<NamedValue>& named_values() {
  using enum Taken::Kind;
  static const std::vector<NamedValue> all{
      {"RECORDING", {files, {".h5"}}},
      {"recording", {files, {".h5", ".h5.partial"}}},
      {"FILE", {files, {".h5"}}},
      {"session key FILE", {files, {}}},
      {"FILES", {files, {".h5", ".csv"}}},
      {"EXPECTED", {files, {".h5", ".csv"}}},
      {"GOT", {files, {".h5", ".csv"}}},
      {"LAW", {files, {".law.toml", ".so"}}},
      {"PROTOCOL", {files, {".protocol.toml"}}},
      {"SUITE", {files, {".toml"}}},
      {"STUDY", {files, {".toml"}}},
      {"SWEEP", {files, {".toml"}}},
      {"PLAN", {files, {".plan.json"}}},
      {"TABLE", {files, {".csv"}}},
      {"RESULTS", {files, {".json"}}},
      {"DIR", {folders, {}}},
      {"FOLDER", {folders, {}}},
      {"laws NAME", {laws, {}}},
      {"PAPER", {words, {"Henry2004", "Sepulveda2008", "FuzzyKelvin", "Weiss2004", "Okamura2003"}}},
      {"--models", {laws, {}}},
      {"--laws", {laws, {}}},
      {"--device", {devices, {}}},
      {"URI", {devices, {}}},
      {"--probe", {devices, {}}},
      {"identify URI", {devices, {}}},
      {"--sensor",
       {words,
        {"u6:0?calibration=", "net-ft:", "onrobot:", "t7:", "bota:/dev/", "optoforce:/dev/", "ft300:/dev/",
         "plugin:./"}}},
      {"--several", {files, {".toml"}}},
      {"--device-model", {files, {".device.toml"}}},
      {"--scene", {files, {".scene.toml"}}},
      {"--law", {files, {".law.toml", ".so"}}},
      {"--plugin", {files, {".so"}}},
      {"--through", {files, {".law.toml"}}},
      {"--switch", {files, {".law.toml"}}},
      {"--shape", {files, {".law.toml"}}},
      {"--map", {files, {".toml"}}},
      {"--join-map", {files, {".toml"}}},
      {"--blank", {files, {".h5"}}},
      {"--check", {files, {".json"}}},
      {"--fits", {folders, {}}},
      {"--batch", {folders, {}}},
      {"--cycles", {words, {"good", "all"}}},
      {"--rerun", {words, {"all"}}},
      {"--folder", {folders, {}}},
      {"--shard", {nothing, {}}},
      {"--hosts", {nothing, {}}},
      {"--only", {nothing, {}}},
      {"--fidelity", {words, {"exact", "strips:", "paper"}}},
      {"--case", {nothing, {}}},
      {"--tolerance", {files, {".toml"}}},
      {"CASE", {nothing, {}}},
      {"--axis", {nothing, {}}},
      {"--along", {nothing, {}}},
      {"--channel", {nothing, {}}},
      {"--from", {nothing, {}}},
      {"--to", {nothing, {}}},
      {"--listen", {nothing, {}}},
      {"--option", {nothing, {}}},
      {"--per-recording", {nothing, {}}},
      {"--reason", {nothing, {}}},
      {"--segments", {nothing, {}}},
      {"--sheet", {nothing, {}}},
      {"--subject", {nothing, {}}},
      {"--trial", {nothing, {}}}};
  return all;
}

}  // namespace

Taken taken_by(const DescribedVerb& verb, const DescribedOption& option) {
  if (!option.takes_text) return {};
  if (!option.choices.empty()) return {.kind = Taken::Kind::words, .words = option.choices};
  const std::string& name = option.names.back();
  const std::string of_verb = fmt::format("{} {}", fmt::join(verb.words, " "), name);
  for (const std::string_view wanted : {std::string_view(of_verb), std::string_view(name)}) {
    const auto found = std::ranges::find(named_values(), wanted, &NamedValue::name);
    if (found != named_values().end()) return found->taken;
  }
  return {.kind = Taken::Kind::files, .words = {}};
}

}  // namespace kerf::bench
