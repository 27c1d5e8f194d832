#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "http/routes.h"
#include "jobs/jobs.h"
#include "verbs/verb_form.h"
#include "workspace/workspace.h"

namespace kerf::bench {

/// The program whose verbs a page may run, each as a job in a process of its own.
struct VerbProgram {
  std::filesystem::path program;   ///< kerf itself
  std::vector<VerbForm> forms;     ///< in the order of `kerf --help`
  std::filesystem::path key_file;  ///< for sessions; empty: those verbs are not offered
  /// Says what is wrong with a command line before it becomes a job; throws std::invalid_argument.
  std::function<void(const std::vector<std::string>&)> check = [](const std::vector<std::string>&) {};
};

/// Verbs of the program as forms, and what they made. All must outlive the routes.
///
///     GET  /api/verbs                the forms, to_json(VerbForm)
///     GET  /api/verbs/files          {"files": [names], "folders": [names]} of the workspace
///     POST /api/verbs/run            {"verb": "prepare", "values": {...}}: {"job": N}; verb_order()
///     GET  /api/jobs/result?job=N    {"files": [{"name", "what", "bytes", "id"}]}: what a job has made;
///                                    `what`: picture, page, table, text or other; `id`: in the workspace
///     GET  /api/jobs/file?job=N&file=K   the K-th of these
void add_verb_routes(Routes& routes, Workspace& workspace, Jobs& jobs, VerbProgram program);

}  // namespace kerf::bench
