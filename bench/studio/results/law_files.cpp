#include "results/law_files.h"

#include <stdexcept>
#include <utility>
#include <vector>

#include "export_law.h"
#include "hosts/fmu/archive.h"

namespace kerf::bench {

HttpResponse hosts_list() {
  auto list = nlohmann::ordered_json::array();
  for (const Host& host : hosts()) list.push_back({{"name", host.name}, {"what", host.what}});
  return json_response(list);
}

HttpResponse exported_law(const HttpRequest& request, Workspace& workspace) {
  const WorkspaceEntry entry = workspace.find(text_in_query(request, "id"), FileKind::law);
  try {
    const Host& host = host_named(text_in_query(request, "host"));
    const ExportedLaw law = read_for(host, entry.path, "");
    std::vector<HostFile> files = host.files(law);
    if (files.size() == 1)
      return {.type = "application/octet-stream", .body = std::move(files.front().content)};
    return {.type = "application/zip", .body = zipped(files)};
  } catch (const std::invalid_argument& error) {
    // The page calls the file as the workspace does.
    std::string why = error.what();
    const std::string path = entry.path.string();
    if (why.starts_with(path)) why.replace(0, path.size(), entry.name);
    throw RequestError(400, why);
  }
}

}  // namespace kerf::bench
