#include "views/recording_routes.h"

#include <exception>
#include <memory>
#include <utility>

#include <fmt/core.h>

#include "views/recording_json.h"
#include "views/thumbnail.h"

namespace kerf::bench {
namespace {

constexpr std::size_t max_view_columns = 4000;
constexpr std::size_t max_traces = 32;
constexpr std::size_t max_loops = 200;
constexpr double farthest_s = 1e12;  // thirty thousand years

HttpResponse stretch(const HttpRequest& request, RecordingView& recording) {
  const std::size_t count = recording.traces().size();
  if (count == 0) throw RequestError(400, "the recording has no traces");
  const auto traces = counts_in_query(request, "traces", count - 1);
  if (traces.size() > max_traces) {
    throw RequestError(400, fmt::format("parameter 'traces' names {} traces, at most {} are shown at once",
                                        traces.size(), max_traces));
  }
  const double from_s = number_in_query(request, "from", -farthest_s, farthest_s);
  const double to_s = number_in_query(request, "to", -farthest_s, farthest_s);
  return bytes_response(
      bytes_of(recording.view(traces, from_s, to_s, count_in_query(request, "columns", max_view_columns))));
}

HttpResponse loops(const HttpRequest& request, RecordingView& recording) {
  const std::size_t axis =
      count_in_query(request, "axis", recording.file().about().axes.size() - 1);  // it has at least one
  const std::size_t first = count_in_query(request, "first", 1'000'000'000);
  return json_text_response(loops_json(recording, axis, first, count_in_query(request, "count", max_loops)));
}

}  // namespace

void add_recording_routes(Routes& routes, RecordingViews& views,
                          std::function<std::filesystem::path(const std::string& id)> path_of) {
  const auto file_of = [path_of = std::move(path_of)](const HttpRequest& request) {
    return path_of(text_in_query(request, "id"));
  };
  routes.get("/api/recording", Routes::Pace::slow, [&views, file_of](const HttpRequest& request) {
    return json_text_response(recording_json(*views.current(file_of(request)), text_in_query(request, "id")));
  });
  routes.get("/api/recording/view", Routes::Pace::slow, [&views, file_of](const HttpRequest& request) {
    return stretch(request, *views.opened(file_of(request)));
  });
  routes.get("/api/recording/thumbnail", Routes::Pace::slow,
             [thumbnails = std::make_shared<Thumbnails>(), file_of](const HttpRequest& request) {
               try {
                 return json_text_response(thumbnails->of(file_of(request)));
               } catch (const std::exception&) {
                 // Why there is none is said where it is opened; a list asks for many, of which some are
                 // gone.
                 return json_response(nullptr);
               }
             });
  routes.get("/api/recording/inspection", Routes::Pace::slow, [&views, file_of](const HttpRequest& request) {
    return json_text_response(views.opened(file_of(request))->inspection());
  });
  routes.get("/api/recording/loops", Routes::Pace::slow, [&views, file_of](const HttpRequest& request) {
    return loops(request, *views.opened(file_of(request)));
  });
}

}  // namespace kerf::bench
