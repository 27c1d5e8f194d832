#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hdf5/h5.h"
#include "validate/inspect.h"

namespace kerf::schema {

/// What an attribute has to be. One value, or a list of so many.
struct AttributeRule {
  std::string_view name;
  std::string_view type;      ///< as h5::type_name() says it
  std::size_t list = 0;       ///< 0: one value
  bool required = true;       ///< its lack departs from the schema
  bool fatal = true;          ///< and the file cannot be read for it
  std::string_view always{};  ///< the text that it always has, if it has one
};

/// Compares a file's tree with what it has to be, and keeps what departs from it.
class TreeCheck {
 public:
  explicit TreeCheck(const std::filesystem::path& file);

  [[nodiscard]] hid_t file() const { return opened_.id(); }
  [[nodiscard]] const std::vector<Finding>& findings() const noexcept { return findings_; }
  [[nodiscard]] const Finding* first_fatal() const;

  /// Schema and version of the root. Nothing else need be asked if they are others.
  bool is(std::string_view schema, std::uint32_t version);
  bool has_group(const std::string& path);
  bool has_attribute(const std::string& object, const AttributeRule& rule);
  /// Of `type` and so many dimensions. @returns its extent.
  std::optional<h5::Extent> extent_of(const std::string& path, const std::string& type,
                                      std::size_t dimensions);
  /// Mentions attributes of an object, or objects of a group, that are not among those named.
  void only_attributes(const std::string& object, const std::vector<std::string_view>& known);
  void only_children(const std::string& group, const std::vector<std::string_view>& known);

  void mention(std::string where, std::string found, std::string expected) {
    add(std::move(where), std::move(found), std::move(expected), false);
  }
  void fail(std::string where, std::string found, std::string expected) {
    add(std::move(where), std::move(found), std::move(expected), true);
  }

 private:
  void add(std::string where, std::string found, std::string expected, bool fatal) {
    findings_.push_back({{std::move(where), std::move(found), std::move(expected)}, fatal});
  }

  h5::Handle opened_;
  std::uintmax_t size_ = 0;
  std::vector<Finding> findings_;
};

/// Checks of texts that several schemas have.
[[nodiscard]] bool is_utc_time(const std::string& text);
[[nodiscard]] bool is_uuid(const std::string& text);
inline constexpr std::string_view expected_utc_time = "ISO 8601 in UTC, '2026-01-31T12:00:00Z'";
inline constexpr std::string_view expected_uuid = "a UUID in lower case, 8-4-4-4-12 hexadecimal digits";

}  // namespace kerf::schema
