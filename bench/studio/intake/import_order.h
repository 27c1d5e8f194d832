#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "imports/import_file.h"
#include "intake/uploads.h"
#include "jobs/jobs.h"
#include "workspace/workspace.h"

namespace kerf::bench {

/// A file that has come, what its recording is to be called, without an ending, and how its columns are read.
struct FileToTakeIn {
  Upload upload;
  std::string name;
  ImportFile mapping;
};

struct ImportOrder {
  std::vector<FileToTakeIn> files;
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
