#include "intake/import_order.h"

#include <algorithm>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/core.h>

#include "files/whole_file.h"
#include "intake/page_words.h"
#include "jobs/job_process.h"

namespace kerf::bench {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t steps_a_file = 1000;

/// The sentence of the program, which is the last line that is no warning.
std::string sentence_in(std::string_view errors, int status) {
  std::string sentence;
  while (!errors.empty()) {
    std::string_view line = errors.substr(0, errors.find('\n'));
    errors.remove_prefix(std::min(errors.size(), line.size() + 1));
    if (line.empty() || line.starts_with("warning: ") || line.starts_with(' ')) continue;
    if (line.starts_with("kerf: ")) line.remove_prefix(6);
    sentence = line;
  }
  return sentence.empty() ? fmt::format("the import ended with status {} and said nothing", status)
                          : sentence;
}

/// Its result is kept beside it, as a file that is whole or not there.
void keep_result(const Upload& upload, const Json& result) {
  write_whole_file(upload.result(), result.dump(-1, ' ', false, Json::error_handler_t::replace));
}

Json failed(const std::string& why) { return {{"state", "failed"}, {"error", why}}; }

class ImportRun {
 public:
  ImportRun(Workspace& workspace, const ImportOrder& order, JobProgress& progress)
      : workspace_(workspace), order_(order), progress_(progress) {}

  JobEnd run() {
    std::size_t refused = 0;
    progress_.steps = order_.files.size() * steps_a_file;
    std::string first;
    std::string why;
    for (std::size_t i = 0; i < order_.files.size() && !progress_.stop; ++i) {
      Json result = take_in(order_.files[i], i);
      if (progress_.stop && result["state"] != "done") break;
      if (result["state"] == "done" && first.empty()) first = result["recording"];
      if (result["state"] != "done" && why.empty()) why = result["error"];
      if (result["state"] != "done") ++refused;
      keep_result(order_.files[i].upload, result);
      progress_.done = (i + 1) * steps_a_file;
    }
    if (progress_.stop && first.empty()) throw std::runtime_error("stopped");
    if (first.empty()) throw std::invalid_argument(why);
    return {first, refused == 0 ? "" : fmt::format("{} did not come in", refused)};
  }

 private:
  Json take_in(const FileToTakeIn& file, std::size_t number) {
    const Upload& upload = file.upload;
    try {
      const fs::path output = workspace_.new_file(file.name, ".h5");
      write_whole_file(upload.mapping(), import_file_text(file.mapping));
      const fs::path said = upload.folder / "said.json";
      const auto told = [&](std::size_t done, std::size_t of) {
        const double share = of == 0 ? 0.0 : static_cast<double>(done) / static_cast<double>(of);
        progress_.done = number * steps_a_file + static_cast<std::size_t>(share * (steps_a_file - 1.0));
      };
      const int status = run_process({.program = order_.program,
                                      .words = {"import", upload.data().string(), "--map",
                                                upload.mapping().string(), "-o", output.string(), "--json"},
                                      .folder = workspace_.folder(),
                                      .output = said,
                                      .errors = upload.errors(),
                                      .told = told},
                                     progress_);
      if (status != 0)
        return failed(in_page_words(as_named(sentence_in(read_whole_file(upload.errors()), status), upload)));
      auto about = Json::parse(read_whole_file(said));
      for (Json& warning : about["warnings"]) warning = in_page_words(warning.get<std::string>());
      (void)workspace_.scan();
      std::error_code ignored;
      fs::remove(upload.data(), ignored);  // the recording names it and its SHA-256
      return {{"state", "done"},
              {"error", ""},
              {"recording", workspace_.id_of(output)},
              {"name", output.filename().string()},
              {"about", about}};
    } catch (const std::exception& error) {
      return failed(in_page_words(as_named(error.what(), upload)));
    }
  }

  Workspace& workspace_;
  const ImportOrder& order_;
  JobProgress& progress_;
};

}  // namespace

JobOrder import_job(Workspace& workspace, ImportOrder order) {
  const std::string title = order.files.size() == 1
                                ? fmt::format("Import of {}", order.files.front().upload.name)
                                : fmt::format("Import of {} files", order.files.size());
  return {.kind = "import",
          .title = title,
          .work = [&workspace, order = std::move(order)](JobProgress& progress) {
            return ImportRun(workspace, order, progress).run();
          }};
}

Json import_result(Workspace& workspace, const Upload& upload) {
  std::error_code error;
  if (!fs::is_regular_file(fs::symlink_status(upload.result(), error))) return {{"state", "waiting"}};
  try {
    Json result = Json::parse(read_whole_file(upload.result()));
    if (result.at("state") != "done") return result;
    try {
      (void)workspace.find(result.at("recording"), FileKind::recording);
    } catch (const std::exception&) {
      result["gone"] = true;  // removed or renamed since
    }
    return result;
  } catch (const Json::exception&) {
    return {{"state", "waiting"}};
  }
}

}  // namespace kerf::bench
