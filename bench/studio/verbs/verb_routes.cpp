#include "verbs/verb_routes.h"

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <utility>

#include <fmt/core.h>

#include "files/named_file.h"
#include "jobs/job_process.h"
#include "jobs/job_routes.h"
#include "verbs/made_files.h"
#include "verbs/verb_order.h"

namespace kerf::bench {
namespace {

constexpr std::uintmax_t largest_made = 64U << 20U;
constexpr std::size_t most_made_files = 500;
constexpr int check_failed_status = 1;  ///< exit status of a verb that ran, and whose check did not pass

/// What the program says at the end where it cannot do what it was asked for: "kerf: ...".
std::string last_words(const std::string& said) {
  constexpr std::string_view head = "kerf: ";
  const std::size_t found = said.rfind(head);
  if (found == std::string::npos) return "it ended without saying why";
  const std::size_t begin = found + head.size();
  return said.substr(begin, said.find('\n', begin) - begin);
}

/// The id of what a job made, where that has a page of its own.
std::string id_of_made(Workspace& workspace, const std::vector<std::string>& outputs) {
  const std::vector<WorkspaceEntry> entries = workspace.scan();
  for (const std::string& output : outputs) {
    for (const WorkspaceEntry& entry : entries) {
      if (entry.name == output) return entry.id;
    }
  }
  return "";
}

JobOrder verb_job(Workspace& workspace, const VerbForm& form, const VerbProgram& program, VerbOrder order) {
  std::vector<std::string> typed = order.words;
  typed.insert(typed.begin(), "kerf");
  if (form.needs_key) order.words.push_back(fmt::format("--key-file={}", program.key_file.string()));
  program.check(order.words);
  JobProcess process{.program = program.program, .words = order.words, .folder = workspace.folder()};
  return {.kind = "verb",
          .title = as_typed(typed),
          .work =
              [&workspace, process = std::move(process), outputs = order.outputs](JobProgress& progress) {
                const auto said = std::make_shared<std::string>();
                progress.log = [said, log = progress.log](std::string_view text) {
                  said->append(text);
                  if (said->size() > JobStore::longest_log)
                    said->erase(0, said->size() - JobStore::longest_log);
                  log(text);
                };
                const int status = run_process(process, progress);
                if (progress.stop) throw std::runtime_error("stopped");
                if (status > check_failed_status) throw std::runtime_error(last_words(*said));
                return JobEnd(id_of_made(workspace, outputs),
                              status == check_failed_status ? "did not pass" : "");
              },
          .outputs = order.outputs};
}

const VerbForm& form_named(const VerbProgram& program, const std::string& verb) {
  const auto found = std::ranges::find(program.forms, verb, &VerbForm::verb);
  if (found == program.forms.end())
    throw RequestError(400, fmt::format("there is no form of a verb '{}'", verb.substr(0, 40)));
  return *found;
}

HttpResponse run_verb(const HttpRequest& request, Workspace& workspace, Jobs& jobs,
                      const VerbProgram& program) {
  const nlohmann::json given = json_in(request);
  const VerbForm& form = form_named(program, text_in(given, "verb"));
  const nlohmann::json values = given.value("values", nlohmann::json::object());
  JobOrder job = verb_job(workspace, form, program, verb_order(form, values, workspace));
  job.again = {.path = request.path, .body = {{"verb", form.verb}, {"values", values}}};
  return json_response({{"job", jobs.add(std::move(job))}});
}

HttpResponse made_list(const HttpRequest& request, Workspace& workspace, const Jobs& jobs) {
  const JobRecord record = jobs.record_of(job_in_query(request));
  const std::vector<WorkspaceEntry> entries = workspace.scan();
  auto files = nlohmann::ordered_json::array();
  for (const MadeFile& made : made_files(workspace, record.outputs)) {
    const auto entry = std::ranges::find(entries, made.name, &WorkspaceEntry::name);
    const bool is_known = entry != entries.end();
    files.push_back({{"name", made.name},
                     {"what", made.what},
                     {"bytes", made.bytes},
                     {"id", is_known ? entry->id : ""},
                     {"kind", is_known ? name_of(entry->kind) : ""}});
  }
  return json_response({{"files", std::move(files)}});
}

/// By its place in the list that made_list() tells: no name comes in from outside.
HttpResponse made_file(const HttpRequest& request, const Workspace& workspace, const Jobs& jobs) {
  const JobRecord record = jobs.record_of(job_in_query(request));
  const std::size_t number = count_in_query(request, "file", most_made_files);
  const std::vector<MadeFile> made = made_files(workspace, record.outputs);
  if (number >= made.size()) throw RequestError(404, "the job has made no such file, or it is gone");
  const MadeFile& wanted = made[number];
  if (wanted.bytes > largest_made)
    throw RequestError(413, fmt::format("{} is larger than {} MB; it stands in the folder", wanted.name,
                                        largest_made >> 20U));
  HttpResponse response{.type = std::string(wanted.type), .body = read_named_file(wanted.path, largest_made)};
  response.is_document = wanted.what == "page" || wanted.what == "picture";
  return response;
}

}  // namespace

void add_verb_routes(Routes& routes, Workspace& workspace, Jobs& jobs, VerbProgram of) {
  const auto program = std::make_shared<const VerbProgram>([&] {
    if (of.key_file.empty()) std::erase_if(of.forms, [](const VerbForm& form) { return form.needs_key; });
    return std::move(of);
  }());
  using Pace = Routes::Pace;
  routes.get("/api/verbs", Pace::at_once, [program](const HttpRequest&) {
    auto forms = nlohmann::ordered_json::array();
    for (const VerbForm& form : program->forms) forms.push_back(to_json(form));
    return json_response(forms);
  });
  routes.get("/api/verbs/files", Pace::slow, [&workspace](const HttpRequest&) {
    const OfferedNames names = offered_names(workspace);
    return json_response({{"files", names.files}, {"folders", names.folders}});
  });
  routes.post("/api/verbs/run", Pace::slow, [&workspace, &jobs, program](const HttpRequest& request) {
    return run_verb(request, workspace, jobs, *program);
  });
  routes.get("/api/jobs/result", Pace::slow,
             [&workspace, &jobs](const HttpRequest& request) { return made_list(request, workspace, jobs); });
  routes.get("/api/jobs/file", Pace::slow,
             [&workspace, &jobs](const HttpRequest& request) { return made_file(request, workspace, jobs); });
}

}  // namespace kerf::bench
