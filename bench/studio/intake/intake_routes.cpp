#include "intake/intake_routes.h"

#include <algorithm>
#include <map>
#include <memory>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "files/whole_file.h"
#include "import/preview.h"
#include "intake/import_order.h"
#include "intake/mapping_json.h"
#include "intake/page_words.h"
#include "intake/preview_json.h"
#include "intake/uploads.h"

namespace kerf::bench {
namespace {

using Json = nlohmann::ordered_json;
using Pace = Routes::Pace;

constexpr std::size_t most_files = 500;
constexpr std::size_t most_unpacked = std::size_t{256} << 20U;  // of what is looked at before it is imported
constexpr std::string_view mapping_ending = ".import.toml";
constexpr double most_bytes = 9e15;  // whole numbers in JSON

/// Heads of uploads that are looked at, by upload and sheet: unpacking is done once.
class Heads {
 public:
  const ImportHead& of(const Upload& upload, const std::string& sheet) {
    const auto known = known_.find(upload.id);
    if (known != known_.end() && known->second.sheet == sheet && std::filesystem::exists(upload.head()))
      return known->second.head;
    if (known_.size() > most_files) known_.clear();
    known_.erase(upload.id);
    ImportHead head =
        write_import_head(upload.data(), upload.head(), {.max_bytes = most_unpacked, .sheet = sheet});
    return known_.insert_or_assign(upload.id, Known{.sheet = sheet, .head = std::move(head)})
        .first->second.head;
  }

 private:
  struct Known {
    std::string sheet;
    ImportHead head;
  };
  std::map<std::string, Known> known_;
};

/// What the routes share; for the thread of slow answers.
class Intake {
 public:
  Intake(Workspace& workspace, Jobs& jobs, std::filesystem::path program)
      : workspace_(workspace), jobs_(jobs), program_(std::move(program)), uploads_(workspace.folder()) {}

  Json overview() {
    Json json{{"uploads", Json::array()},
              {"mappings", Json::array()},
              {"largest", Uploads::largest},
              {"piece", Uploads::largest_piece}};
    for (const Upload& upload : uploads_.all()) {
      json["uploads"].push_back({{"upload", upload.id},
                                 {"name", upload.name},
                                 {"bytes", upload.bytes},
                                 {"have", upload.have},
                                 {"result", import_result(workspace_, upload)}});
    }
    for (const auto& file : mapping_files())
      json["mappings"].push_back({{"id", workspace_.id_of(file)}, {"name", file.filename().string()}});
    return json;
  }

  Json begin(const nlohmann::json& given) {
    const Upload upload = uploads_.begin(
        text_in(given, "name"), static_cast<std::uintmax_t>(number_in(given, "bytes", 0.0, most_bytes)),
        static_cast<std::uint64_t>(number_or(given, "modified", 0.0, 0.0, most_bytes)));
    return {{"upload", upload.id}, {"have", upload.have}};
  }

  Json append(const HttpRequest& request) {
    const Upload upload = uploads_.append(
        text_in_query(request, "upload"),
        count_in_query(request, "at", static_cast<std::size_t>(Uploads::largest)), request.body);
    return {{"have", upload.have}};
  }

  Json forget(const nlohmann::json& given) {
    uploads_.forget(text_in(given, "upload"));
    return Json::object();
  }

  Json preview(const nlohmann::json& given) {
    const Upload upload = whole(text_in(given, "upload"));
    try {
      const ImportFile mapping = mapping_in(given, false);
      const ImportHead& head = heads_.of(upload, mapping.options.sheet);
      return preview_as_json(preview_import(upload.head(), upload.name, import_options_of(mapping)), head,
                             upload);
    } catch (const std::invalid_argument& refused) {
      throw RequestError(400, in_page_words(as_named(refused.what(), upload)));
    }
  }

  Json mapping(const std::string& id) {
    for (const auto& file : mapping_files()) {
      if (workspace_.id_of(file) == id) return mapping_as_json(read_import_file(file));
    }
    throw RequestError(404, "there is no such mapping in this folder any more");
  }

  Json save_mapping(const nlohmann::json& given) {
    const ImportFile mapping = mapping_in(given, true);
    const bool replace = flag_in(given, "replace", false);
    const auto file = workspace_.new_file(text_in(given, "name"), mapping_ending, replace);
    write_whole_file(file, import_file_text(mapping), schema::existing_if(replace));
    return {{"id", workspace_.id_of(file)}, {"name", file.filename().string()}};
  }

  Json start(const nlohmann::json& given) {
    ImportOrder order{.files = {}, .program = program_};
    const auto files = given.find("files");
    if (files == given.end() || !files->is_array() || files->empty() || files->size() > most_files)
      throw RequestError(400, fmt::format("'files' is not a list of 1 to {} files", most_files));
    std::set<std::string> names;
    for (const nlohmann::json& file : *files) {
      if (!file.is_object()) throw RequestError(400, "'files' is not a list of files");
      Upload upload = whole(text_in(file, "upload"));
      std::string name = text_in(file, "name");
      (void)workspace_.new_file(name, ".h5");
      if (!names.insert(name).second)
        throw RequestError(409,
                           fmt::format("two files are to become {}.h5; choose another name for one", name));
      std::error_code ignored;
      std::filesystem::remove(upload.result(), ignored);  // of an attempt before
      order.files.push_back(
          {.upload = std::move(upload), .name = std::move(name), .mapping = mapping_in(file, true)});
    }
    return {{"job", jobs_.add(import_job(workspace_, std::move(order)))}};
  }

  Json result(const std::string& id) { return import_result(workspace_, uploads_.find(id)); }

 private:
  /// Those of the folder itself, in order of their names.
  [[nodiscard]] std::vector<std::filesystem::path> mapping_files() const {
    std::vector<std::filesystem::path> files;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(workspace_.folder(), error)) {
      const std::string name = entry.path().filename().string();
      if (name.ends_with(mapping_ending) && !name.starts_with('.') && !entry.is_symlink(error) &&
          entry.is_regular_file(error))
        files.push_back(entry.path());
    }
    std::ranges::sort(files);
    return files;
  }

  [[nodiscard]] Upload whole(const std::string& id) const {
    Upload upload = uploads_.find(id);
    if (!upload.is_whole())
      throw RequestError(409, fmt::format("{}: {} of {} bytes have come; drop it again, and it goes on",
                                          upload.name, upload.have, upload.bytes));
    return upload;
  }

  Workspace& workspace_;
  Jobs& jobs_;
  std::filesystem::path program_;
  Uploads uploads_;
  Heads heads_;
};

}  // namespace

void add_intake_routes(Routes& routes, Workspace& workspace, Jobs& jobs, std::filesystem::path program) {
  const auto intake = std::make_shared<Intake>(workspace, jobs, std::move(program));
  const auto post = [&](const char* path, Json (Intake::*answer)(const nlohmann::json&)) {
    routes.post(path, Pace::slow, [intake, answer](const HttpRequest& request) {
      return json_response(((*intake).*answer)(json_in(request)));
    });
  };
  routes.get("/api/import", Pace::slow,
             [intake](const HttpRequest&) { return json_response(intake->overview()); });
  routes.post("/api/import/piece", Pace::slow,
              [intake](const HttpRequest& request) { return json_response(intake->append(request)); });
  post("/api/import/begin", &Intake::begin);
  post("/api/import/forget", &Intake::forget);
  post("/api/import/preview", &Intake::preview);
  post("/api/import/mapping", &Intake::save_mapping);
  post("/api/import/start", &Intake::start);
  routes.get("/api/import/mapping", Pace::slow, [intake](const HttpRequest& request) {
    return json_response(intake->mapping(text_in_query(request, "id")));
  });
  routes.get("/api/import/result", Pace::slow, [intake](const HttpRequest& request) {
    return json_response(intake->result(text_in_query(request, "upload")));
  });
}

}  // namespace kerf::bench
