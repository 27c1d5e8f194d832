#pragma once

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <unordered_map>
#include <vector>

namespace kerf::bench {

enum class FileKind : std::uint8_t {
  recording,  ///< .h5 of schema kerf.recording, also NAME.h5.partial
  law,        ///< .law.toml
  session,    ///< .h5 of schema kerf.session
  fit,        ///< fit.json
  chart,      ///< chart.json
  choice,     ///< choose.json
  stability,  ///< stability.json
  suite,      ///< .suite.toml
  scene,      ///< .scene.toml
  protocol,   ///< .protocol.toml
  study,      ///< study.toml
  device,     ///< identify.json
  sweep       ///< sweep.h5 that kerf sweep merge wrote
};
[[nodiscard]] std::string_view name_of(FileKind kind) noexcept;

/// A file of the workspace.
struct WorkspaceEntry {
  std::string id;    ///< 16 hexadecimal digits of its name's SHA-256
  std::string name;  ///< path within the workspace, with "/"
  FileKind kind = FileKind::recording;
  std::filesystem::path path;
  std::uintmax_t bytes = 0;
  std::filesystem::file_time_type modified;
  bool is_looked_into = true;     ///< false: taken for a recording by its name alone, so far
  std::optional<double> seconds;  ///< of a recording that was looked into and can be read
  std::string uuid;               ///< of the same
  bool is_damaged = false;        ///< HDF5 can make nothing of it: it may have been a recording
  bool is_written = false;        ///< not closed, and a living process writes it

  /// NAME.h5.partial: it is written, or who wrote it died.
  [[nodiscard]] bool is_partial() const { return name.ends_with(".partial"); }
};

/// The folder that a studio works in: what is in it, four folders deep, hidden ones and symbolic links left
/// out.
///
/// A page names a file by its id, which is looked up among those that a scan has found: no path comes in from
/// outside, so that none can lead out of the folder. Names of new files are checked instead. For any thread.
class Workspace {
 public:
  /// @throws std::invalid_argument: no such folder.
  explicit Workspace(const std::filesystem::path& folder);

  [[nodiscard]] const std::filesystem::path& folder() const noexcept { return folder_; }
  /// Looks again; in order of their names. Up to 10,000 files. To look into a file of HDF5 takes
  /// milliseconds, since a process of its own reads it: up to 24 new ones are waited for, more are looked
  /// into by a thread after this has returned.
  [[nodiscard]] std::vector<WorkspaceEntry> scan();
  /// The file of an id. @throws RequestError 404: none has it, or it is of another kind or gone.
  [[nodiscard]] WorkspaceEntry find(const std::string& id, FileKind kind);
  /// Where a new file of the folder itself goes: NAME and the ending, such as ".law.toml".
  /// @throws RequestError 400 for a name that is not 1 to 80 letters, digits, "_", "-", "." beginning with a
  ///         letter or digit; 409 if it is there and may not be replaced.
  [[nodiscard]] std::filesystem::path new_file(const std::string& name, std::string_view ending,
                                               bool replace = false) const;
  /// Where a file of the folder is, by its path in there. Nothing for what is no regular file, is a symbolic
  /// link on any step of the way, or leads out of the folder.
  [[nodiscard]] std::optional<std::filesystem::path> regular_file(const std::string& name) const;
  /// The id that a file of this folder has. @throws std::invalid_argument if it is not within the folder.
  [[nodiscard]] std::string id_of(const std::filesystem::path& file) const;

 private:
  /// What a file was when it was looked into. Nothing within: it is none of ours.
  struct Looked {
    std::uintmax_t bytes = 0;
    std::filesystem::file_time_type modified;
    std::optional<FileKind> kind;
    std::optional<double> seconds;
    std::string uuid;
    bool is_damaged = false;
  };

  [[nodiscard]] std::vector<WorkspaceEntry> list() const;
  /// What is known of a file that has not changed since.
  [[nodiscard]] const Looked* known(const WorkspaceEntry& entry) const;
  void look_into(const WorkspaceEntry& entry);
  void look_into_all(std::vector<WorkspaceEntry> entries);
  /// False where it is none of ours.
  [[nodiscard]] bool take_what_is_known(WorkspaceEntry& entry) const;

  std::filesystem::path folder_;
  mutable std::mutex mutex_;                        ///< of all below
  std::vector<WorkspaceEntry> found_;               ///< by the last scan
  std::unordered_map<std::string, Looked> looked_;  ///< by id
  std::vector<WorkspaceEntry> to_look_into_;        ///< the next one last
  bool is_looking_ = false;                         ///< the thread is at work
  std::jthread looker_;                             ///< last: it uses the rest
};

}  // namespace kerf::bench
