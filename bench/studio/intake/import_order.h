#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "imports/import_file.h"
#include "intake/uploads.h"
#include "jobs/jobs.h"
#include "workspace/workspace.h"

namespace kerf::bench {

/// A file that has come, and what its recording is to be called, without an ending.
struct FileToTakeIn {
  Upload upload;
  std::string name;
};

/// Files to import by one mapping.
struct ImportOrder {
  std::vector<FileToTakeIn> files;
  ImportFile mapping;
  std::filesystem::path program;  ///< kerf itself
};

/// `kerf import` of each file in turn, in a process of its own. What is wrong with one is told beside it, and
/// the others go on; the job fails where none came in. What has come in is not kept as a file as well. The
/// workspace must outlive the job.
[[nodiscard]] JobOrder import_job(Workspace& workspace, ImportOrder order);

/// What became of an upload: {"state": "waiting" | "failed" | "done", "error", "recording" (id), "name",
/// "about"}, the latter what `kerf import --json` has said.
[[nodiscard]] nlohmann::ordered_json import_result(Workspace& workspace, const Upload& upload);

}  // namespace kerf::bench
