#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace kerf::bench {

/// A file that a page hands over piece by piece, as far as it has come.
struct Upload {
  std::string id;    ///< 16 hexadecimal digits
  std::string name;  ///< as the file was called where it came from
  std::uintmax_t bytes = 0;
  std::uintmax_t have = 0;       ///< of these
  std::filesystem::path folder;  ///< its own

  [[nodiscard]] bool is_whole() const noexcept { return have == bytes; }
  [[nodiscard]] std::filesystem::path data() const;     ///< under its own name
  [[nodiscard]] std::filesystem::path head() const;     ///< its first lines as text (write_import_head())
  [[nodiscard]] std::filesystem::path result() const;   ///< what `kerf import` said of it, as JSON
  [[nodiscard]] std::filesystem::path errors() const;   ///< and on standard error
  [[nodiscard]] std::filesystem::path mapping() const;  ///< the import file that it was imported by
};

/// Files on their way into a workspace, in a hidden folder of it, where they outlive the studio: what has
/// come stays, and a file that is handed over again goes on where it stopped. Memory holds no more than a
/// piece. For one thread at a time.
class Uploads {
 public:
  static constexpr std::uintmax_t largest = std::uintmax_t{4} << 30U;  ///< as `kerf import` takes
  static constexpr std::size_t largest_piece = std::size_t{1} << 19U;
  static constexpr std::string_view folder_name = ".kerf-intake";

  explicit Uploads(const std::filesystem::path& workspace);

  /// Begins one, or goes on with it: the same name, size and time of change are the same file.
  /// @throws RequestError 400 for a name that no file can have, 413 for one that is too large, 507 where the
  ///         disk has no room for the rest of it.
  [[nodiscard]] Upload begin(const std::string& name, std::uintmax_t bytes, std::uint64_t modified_ms);
  /// @throws RequestError 404.
  [[nodiscard]] Upload find(const std::string& id) const;
  /// Adds a piece. @throws RequestError 409 unless it begins where the file ends, 413 for more than was told,
  ///         507 for a full disk, and nothing of the piece is kept; std::system_error.
  [[nodiscard]] Upload append(const std::string& id, std::uintmax_t at, std::string_view piece);
  /// Throws away what has come. Nothing if there is none such.
  void forget(const std::string& id);
  /// In order of their names.
  [[nodiscard]] std::vector<Upload> all() const;

 private:
  std::filesystem::path folder_;
};

/// A message with the upload's paths as the person knows the file.
[[nodiscard]] std::string as_named(std::string message, const Upload& upload);

}  // namespace kerf::bench
