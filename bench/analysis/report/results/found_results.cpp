#include "report/results/found_results.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <fstream>
#include <optional>
#include <stdexcept>

#include <fmt/core.h>

#include "files/named_file.h"

namespace kerf::bench {
namespace {

using json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr int folders_down = 2;

/// By keys that its verb has written since its first version, and no other verb does.
std::optional<ResultKind> kind_of(const json& result) {
  const auto has = [&](std::initializer_list<const char*> names) {
    return result.is_object() &&
           std::ranges::all_of(names, [&](const char* name) { return result.contains(name); });
  };
  if (has({"sampling", "signals", "cycles"})) return ResultKind::inspection;
  if (has({"candidates", "choice"})) return ResultKind::choice;
  if (has({"fits", "choice"})) return ResultKind::fits;
  if (has({"points", "front"})) return ResultKind::chart;
  if (has({"study", "in_words"})) return ResultKind::stability;
  if (has({"device", "held", "good", "axes"})) return ResultKind::device;
  if (has({"mode", "laws", "recording_uuid"})) return ResultKind::replay;
  if (has({"verdict", "histograms", "missed"})) return ResultKind::check;
  return std::nullopt;
}

const char* owner_key(ResultKind kind) {
  switch (kind) {
    case ResultKind::inspection:
    case ResultKind::fits:
    case ResultKind::chart:
      return "recording";
    case ResultKind::choice:
      return "uuid";
    case ResultKind::replay:
      return "recording_uuid";
    case ResultKind::stability:
    case ResultKind::check:
      return "law_of_recording";
    case ResultKind::device:
      break;
  }
  return "";
}

Belongs belongs_to(const json& result, ResultKind kind, const std::string& uuid) {
  if (kind == ResultKind::fits && result.contains("recordings")) {
    for (const json& one : result.at("recordings")) {
      if (one.is_object() && one.value("uuid", std::string()) == uuid) return Belongs::here;
    }
  }
  const auto owner = result.find(owner_key(kind));
  if (owner == result.end() || !owner->is_string() || owner->get<std::string>().empty())
    return Belongs::unknown;
  return owner->get<std::string>() == uuid ? Belongs::here : Belongs::elsewhere;
}

std::optional<FoundResult> result_of(const fs::path& file, json content, const std::string& uuid) {
  const auto kind = kind_of(content);
  if (!kind) return std::nullopt;
  const Belongs belongs = belongs_to(content, *kind, uuid);
  return FoundResult{.kind = *kind,
                     .file = file,
                     .name = (file.parent_path().filename() / file.filename()).string(),
                     .json = std::move(content),
                     .belongs = belongs};
}

std::vector<fs::path> json_files_in(const fs::path& folder) {
  require_named_folder(folder);
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::recursive_directory_iterator at(folder, fs::directory_options::skip_permission_denied, error), end;
       !error && at != end; at.increment(error)) {
    if (at.depth() >= folders_down) at.disable_recursion_pending();
    std::error_code ignored;
    if (at->path().extension() == ".json" && at->is_regular_file(ignored)) files.push_back(at->path());
  }
  std::ranges::sort(files);
  return files;
}

/// What a folder holds of the recording. A lab keeps the results of many beside each other: what says that it
/// is of another one is passed over.
void look_through(const fs::path& folder, const std::string& uuid, std::vector<FoundResult>& found) {
  const std::size_t before = found.size();
  std::size_t of_others = 0;
  for (const fs::path& file : json_files_in(folder)) {
    try {
      auto result = result_of(file, read_result(file), uuid);
      if (!result) continue;
      if (result->belongs == Belongs::elsewhere) {
        ++of_others;
      } else {
        found.push_back(std::move(*result));
      }
    } catch (const std::invalid_argument&) {  // somebody else's
    }
  }
  if (found.size() > before) return;
  if (of_others > 0) {
    throw std::invalid_argument(
        fmt::format("{}: holds results of other recordings alone; one that is named as a file is shown all "
                    "the same",
                    folder.string()));
  }
  throw std::invalid_argument(
      fmt::format("{}: holds no JSON of fit, choose, chart, stability, identify, replay, check or inspect",
                  folder.string()));
}

/// Takes the UUIDs from the keys that a result's owner has (owner_key()), and from those of "recordings";
/// ends at the first key of the whole that follows them.
class OwnerReader : public nlohmann::json_sax<json> {
 public:
  [[nodiscard]] std::vector<std::string> take() { return std::move(uuids_); }

  bool key(std::string& name) override {
    key_ = name;
    return depth_ != 1 || uuids_.empty() || name == "recordings";
  }
  bool string(std::string& value) override {
    constexpr std::array<std::string_view, 4> of_the_whole{"recording", "uuid", "recording_uuid",
                                                           "law_of_recording"};
    const bool is_owner = depth_ == 1 ? std::ranges::find(of_the_whole, key_) != of_the_whole.end()
                                      : depth_ == 3 && list_ == "recordings" && key_ == "uuid";
    if (is_owner && is_uuid(value) && std::ranges::find(uuids_, value) == uuids_.end())
      uuids_.push_back(value);
    return true;
  }
  bool start_object(std::size_t) override { return go_down(); }
  bool start_array(std::size_t) override {
    if (depth_ == 1) list_ = key_;
    return go_down();
  }
  bool end_object() override { return go_up(); }
  bool end_array() override { return go_up(); }
  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(number_integer_t) override { return true; }
  bool number_unsigned(number_unsigned_t) override { return true; }
  bool number_float(number_float_t, const string_t&) override { return true; }
  bool binary(binary_t&) override { return true; }
  bool parse_error(std::size_t, const std::string&, const json::exception&) override { return false; }

 private:
  [[nodiscard]] static bool is_uuid(std::string_view text) {
    return text.size() == 36 && text[8] == '-' && text[13] == '-' && text[18] == '-' && text[23] == '-';
  }
  bool go_down() {
    ++depth_;
    return true;
  }
  bool go_up() {
    if (--depth_ == 1) list_.clear();
    return true;
  }

  std::vector<std::string> uuids_;
  std::string key_;
  std::string list_;  ///< of the whole, that is being read
  int depth_ = 0;
};

}  // namespace

std::vector<std::string> recordings_of(const fs::path& file) {
  std::ifstream text(file);
  OwnerReader reader;
  if (text) (void)json::sax_parse(text, &reader);
  return reader.take();
}

std::string_view verb_of(ResultKind kind) noexcept {
  switch (kind) {
    case ResultKind::inspection:
      return "kerf inspect";
    case ResultKind::fits:
      return "kerf fit";
    case ResultKind::choice:
      return "kerf choose";
    case ResultKind::chart:
      return "kerf chart";
    case ResultKind::stability:
      return "kerf stability";
    case ResultKind::device:
      return "kerf identify";
    case ResultKind::replay:
      return "kerf replay";
    case ResultKind::check:
      return "kerf check";
  }
  return "";
}

json read_result(const fs::path& file) {
  try {
    return json::parse(read_named_file(file, LargestInput::table));
  } catch (const json::exception& error) {
    throw std::invalid_argument(fmt::format("{}: not JSON: {}", file.string(), error.what()));
  }
}

std::vector<FoundResult> find_results(const std::vector<fs::path>& paths, const std::string& uuid) {
  std::vector<FoundResult> found;
  for (const fs::path& path : paths) {
    std::error_code ignored;
    if (fs::is_directory(path, ignored)) {
      look_through(path, uuid, found);
      continue;
    }
    auto result = result_of(path, read_result(path), uuid);
    if (!result) {
      throw std::invalid_argument(
          fmt::format("{}: not the JSON of fit, choose, chart, stability, identify, replay, check or inspect",
                      path.string()));
    }
    found.push_back(std::move(*result));
  }
  std::ranges::stable_sort(found, {}, &FoundResult::kind);
  return found;
}

}  // namespace kerf::bench
