#pragma once

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>

#include <kerf/drivers/device.h>
#include <kerf/schema/recording.h>

#include "record/recorder.h"
#include "scene/scene.h"

namespace kerf::bench {

/// A recording that begins while the loop runs. Its time and its ticks count from its own first row, as the
/// schema has it ("from the start"); gaps stay gaps. Rows and events come from one thread.
class RunningRecording {
 public:
  struct Options {
    double period_s = 1e-3;  ///< of the loop
    bool replace = false;    ///< an existing file may be replaced
    std::string plugins;     ///< plugin_in_words() of the law that is rendered when it begins
  };

  /// @throws std::invalid_argument, std::system_error as schema::RecordingWriter does.
  RunningRecording(std::filesystem::path file, const drivers::DeviceInfo& device,
                   const std::optional<Scene>& scene, const Options& options);

  void push(schema::Row row);
  /// An event of a tick of the loop; before the first row it goes to the beginning.
  void mark(std::uint64_t tick, std::string kind, std::string text);

  /// How a recording ends.
  struct Ending {
    std::string fault;  ///< what happened to the device; empty: nothing
    std::string why;    ///< in words
    std::vector<drivers::Figure> figures{};
  };
  /// Ends the file. Returns why it could not be written to its end; empty if it could.
  [[nodiscard]] std::string close(const Ending& ending);

  [[nodiscard]] const std::filesystem::path& file() const noexcept { return file_; }
  [[nodiscard]] bool has_begun() const noexcept { return first_tick_.has_value(); }
  [[nodiscard]] std::uint64_t rows() const noexcept { return rows_ - recorder_.lost(); }
  [[nodiscard]] double seconds() const noexcept;  ///< from the first row to the last
  /// Why nothing more is recorded; empty if all is well. For any thread.
  [[nodiscard]] std::string failure() const;

 private:
  [[nodiscard]] double time_of(std::uint64_t tick) const noexcept;

  std::filesystem::path file_;
  double period_s_;
  std::optional<std::uint64_t> first_tick_;
  std::uint64_t last_tick_ = 0;
  std::uint64_t rows_ = 0;
  mutable std::mutex mutex_;  ///< of failure_, which the writer's thread tells
  std::string failure_;
  Recorder recorder_;  ///< last: its thread uses the rest
};

}  // namespace kerf::bench
