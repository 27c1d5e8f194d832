#include "identify/identified_z_width.h"

#include <exception>

#include <fmt/format.h>

namespace kerf::bench {

void search_z_widths(IdentifiedDevice& identified, const StudyOptions& how, const std::string& file,
                     const std::atomic<bool>& stop) {
  StudyOptions options = how;
  options.on.device_uri = identified.device.uri;
  options.z_width.fresh_model = ModelFile{.file = file, .model = model_of(identified)};
  for (IdentifiedAxis& axis : identified.axes) {
    if (!axis.found || stop) continue;
    options.on.axis = identified.device.axes.at(axis.axis).name;
    try {
      axis.z_width = study_z_width(options, stop);
    } catch (const std::exception& why) {  // such as a device that was unplugged: the model stays
      axis.problem += fmt::format("{}Z-width: {}", axis.problem.empty() ? "" : "; ", why.what());
    }
  }
}

}  // namespace kerf::bench
