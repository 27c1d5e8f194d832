#include "sweeps/sweep_routes.h"

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "atlas/atlas_answer.h"
#include "sweeps/open_sweeps.h"
#include "sweeps/sweep_json.h"

namespace kerf::bench {
namespace {

constexpr double most_lines = 4000;
constexpr std::size_t most_columns = 16;

}  // namespace

void add_sweep_routes(Routes& routes, Workspace& workspace, SweepVerbs verbs) {
  const auto sweeps = std::make_shared<OpenSweeps>(verbs);
  const auto opened = [&workspace, sweeps](const std::string& id) {
    return sweeps->opened(workspace.find(id, FileKind::sweep).path);
  };
  routes.get("/api/sweep", Routes::Pace::slow, [opened](const HttpRequest& request) {
    return json_text_response(sweep_json(*opened(text_in_query(request, "id"))));
  });
  routes.post("/api/sweep/answer", Routes::Pace::slow, [opened](const HttpRequest& request) {
    const nlohmann::json body = json_in(request);
    return json_text_response(answer_json(answer(*opened(text_in(body, "id")), question_from_json(body))));
  });
  routes.post("/api/sweep/sample", Routes::Pace::slow, [opened](const HttpRequest& request) {
    nlohmann::json body = json_in(request);
    const auto most = static_cast<std::size_t>(number_in(body, "most", 1, most_lines));
    const nlohmann::json listed = body.value("columns", nlohmann::json::array());
    std::vector<std::string> columns;
    for (const nlohmann::json& one : listed) {
      if (!one.is_string() || columns.size() == most_columns)
        throw RequestError(400, "'columns' has up to 16 names");
      columns.push_back(one.get<std::string>());
    }
    const auto atlas = opened(text_in(body, "id"));
    return json_text_response(sample_json(sample(*atlas, question_from_json(body), columns, most)));
  });
}

}  // namespace kerf::bench
