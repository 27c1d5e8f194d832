#include "validate/tree_check.h"

#include <algorithm>
#include <regex>

namespace kerf::schema {
namespace {

std::string in_words(const h5::Description& found) {
  std::string words = found.type;
  for (std::size_t i = 0; i < found.extent.size(); ++i) {
    words += (i == 0 ? " of " : " x ") + std::to_string(found.extent[i]);
  }
  return words;
}

std::string child_of(const std::string& group, const std::string& name) {
  return group == "/" ? group + name : group + '/' + name;
}

std::string attribute_of(const std::string& object, std::string_view name) {
  return object + " attribute '" + std::string(name) + '\'';
}

}  // namespace

TreeCheck::TreeCheck(const std::filesystem::path& file) {
  opened_ = h5::open_file(file);
  require_sound_texts(file, opened_);
  size_ = std::filesystem::file_size(file);
}

const Finding* TreeCheck::first_fatal() const {
  const auto found = std::ranges::find(findings_, true, &Finding::fatal);
  return found == findings_.end() ? nullptr : &*found;
}

bool TreeCheck::is(std::string_view schema, std::uint32_t version) {
  if (!has_attribute("/", {.name = "schema", .type = "text", .always = schema}) ||
      !has_attribute("/", {.name = "schema_version", .type = "uint32"})) {
    return false;
  }
  std::uint32_t found = 0;
  h5::read_attribute(h5::open(file(), "/").id(), "schema_version", h5::native<std::uint32_t>(), &found);
  if (found == version) return true;
  fail("/ attribute 'schema_version'", std::to_string(found), std::to_string(version));
  return false;
}

bool TreeCheck::has_group(const std::string& path) {
  if (h5::is_group(file(), path)) return true;
  fail(path, "no group", "a group");
  return false;
}

bool TreeCheck::has_attribute(const std::string& object, const AttributeRule& rule) {
  const auto opened = h5::open(file(), object);
  const std::string name(rule.name);
  const h5::Extent extent = rule.list == 0 ? h5::Extent{} : h5::Extent{rule.list};
  const h5::Description expected{std::string(rule.type), extent};
  const std::string where = attribute_of(object, rule.name);
  if (!h5::has_attribute(opened.id(), name)) {
    if (rule.required) add(where, "nothing", in_words(expected), rule.fatal);
    return false;
  }
  const auto found = h5::describe_attribute(opened.id(), name);
  if (found.type != expected.type || found.extent != expected.extent) {
    add(where, in_words(found), in_words(expected), rule.fatal);
    return false;
  }
  if (rule.always.empty()) return true;
  const std::string text = h5::read_texts(opened.id(), name).front();
  if (text == rule.always) return true;
  fail(where, '\'' + text + '\'', '\'' + std::string(rule.always) + '\'');
  return false;
}

std::optional<h5::Extent> TreeCheck::extent_of(const std::string& path, const std::string& type,
                                               std::size_t dimensions) {
  const std::string expected = "a dataset " + type + " of " + std::to_string(dimensions) +
                               (dimensions == 1 ? " dimension" : " dimensions");
  if (!h5::is_dataset(file(), path)) {
    fail(path, "no dataset", expected);
    return std::nullopt;
  }
  const auto dataset = h5::open(file(), path);
  const auto found = h5::describe(dataset.id());
  if (found.type != type || found.extent.size() != dimensions) {
    fail(path, in_words(found), expected);
    return std::nullopt;
  }
  if (!h5::is_plausible(dataset.id(), size_)) {
    fail(path, in_words(found), "no more than the file can hold");
    return std::nullopt;
  }
  return found.extent;
}

void TreeCheck::only_attributes(const std::string& object, const std::vector<std::string_view>& known) {
  for (const std::string& name : h5::attributes(h5::open(file(), object).id())) {
    if (std::ranges::find(known, name) != known.end()) continue;
    mention(attribute_of(object, name), "an attribute", "nothing of this name");
  }
}

void TreeCheck::only_children(const std::string& group, const std::vector<std::string_view>& known) {
  for (const std::string& name : h5::children(h5::open(file(), group).id())) {
    if (std::ranges::find(known, name) != known.end()) continue;
    mention(child_of(group, name), "an object", "nothing of this name");
  }
}

bool is_utc_time(const std::string& text) {
  static const std::regex pattern(R"(\d{4}-[01]\d-[0-3]\dT[0-2]\d:[0-5]\d:[0-6]\d(\.\d+)?Z)");
  return std::regex_match(text, pattern);
}

bool is_uuid(const std::string& text) {
  static const std::regex pattern("[0-9a-f]{8}-[0-9a-f]{4}-[0-9a-f]{4}-[0-9a-f]{4}-[0-9a-f]{12}");
  return std::regex_match(text, pattern);
}

}  // namespace kerf::schema
