#include "prepare/prepare_file.h"

#include <charconv>
#include <stdexcept>

#include <fmt/core.h>

#include "recordings/provenance.h"
#include "recordings/whole_recording.h"

namespace kerf::bench {

Prepared prepare_file(const std::filesystem::path& file, const PrepareOptions& options) {
  schema::Recording recording = read_whole_recording(file);
  recording.header.source =
      fmt::format("{} {} sha256:{}", file.filename().string(), recording.header.uuid, sha256_of(file));
  Prepared prepared;
  try {
    prepared = prepare(std::move(recording), options);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(fmt::format("{}: {}", file.string(), error.what()));
  }
  schema::Header& header = prepared.recording.header;
  header.uuid = schema::new_header("").uuid;
  header.software = software();
  return prepared;
}

BlankOptions read_blank(const std::filesystem::path& file) {
  return {
      .recording = read_whole_recording(file), .file = file.filename().string(), .sha256 = sha256_of(file)};
}

Labels parse_labels(const std::string& text) {
  const auto equals = text.rfind('=');
  Labels labels;
  if (equals != std::string::npos) {
    labels.channel = text.substr(0, equals);
    const char* const end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data() + equals + 1, end, labels.value);
    if (error == std::errc{} && rest == end && !labels.channel.empty()) return labels;
  }
  throw std::invalid_argument(
      fmt::format("--score-labels: '{}' is not CHANNEL=VALUE, for example label=3", text));
}

}  // namespace kerf::bench
