#include <new>
#include <utility>
#include <vector>

#include <kerf/schema/live_recording.h>
#include <kerf/schema/recording.h>
#include <kerf/schema/regression.h>
#include <kerf/schema/session.h>
#include <kerf/schema/validate.h>

#include "apart/reader_process.h"
#include "hdf5/files.h"

namespace kerf::schema {

using apart::Ask;
using apart::ReaderProcess;

namespace {

/// The rows of one dataset after the other, as a reader's process sends them.
class WholeDatasets {
 public:
  WholeDatasets(ReaderProcess& reader, const in_process::RecordingFacts& facts)
      : reader_(reader), facts_(facts) {}

  template <typename Number>
  void next(std::vector<Number>& values) {
    const std::size_t width = dataset_ < facts_.widths.size() ? facts_.widths.at(dataset_) : 1;
    ++dataset_;
    reader_.get(values, facts_.rows * width);
  }

 private:
  ReaderProcess& reader_;
  const in_process::RecordingFacts& facts_;
  std::size_t dataset_ = 0;
};

}  // namespace

Recording read_recording(const std::filesystem::path& file) try {
  ReaderProcess reader(file, "a recording");
  reader.begin({.what = Ask::whole_recording});
  auto facts = reader.get_facts();
  Recording all = std::move(facts.about);
  WholeDatasets datasets(reader, facts);
  datasets.next(all.time);
  datasets.next(all.position);
  datasets.next(all.velocity);
  datasets.next(all.force_commanded);
  datasets.next(all.force_measured);
  datasets.next(all.wake_latency);
  datasets.next(all.read_time);
  datasets.next(all.compute_time);
  datasets.next(all.write_time);
  datasets.next(all.tick);
  datasets.next(all.flags);
  for (Channel& channel : all.channels) datasets.next(channel.values);
  reader.end();
  return all;
} catch (const std::bad_alloc&) {
  throw FormatError(file.string() + ": more rows than fit into the memory");
}

Tail read_tail(const std::filesystem::path& file) {
  return ReaderProcess(file, "a recording").ask<Tail>({.what = Ask::tail});
}

std::vector<StoredForces> read_regression(const std::filesystem::path& file) {
  return ReaderProcess(file, "stored forces").ask<std::vector<StoredForces>>({.what = Ask::stored_forces});
}

Session read_session(const std::filesystem::path& file) {
  return ReaderProcess(file, "a session").ask<Session>({.what = Ask::session});
}

struct SessionFile::Implementation {
  explicit Implementation(const std::filesystem::path& file)
      : reader(file, "a session"), facts(reader.ask<Session>({.what = Ask::session_facts})) {}

  ReaderProcess reader;
  Session facts;
};

SessionFile::SessionFile(const std::filesystem::path& file)
    : implementation_(std::make_unique<Implementation>(file)) {}

SessionFile::SessionFile(SessionFile&&) noexcept = default;
SessionFile& SessionFile::operator=(SessionFile&&) noexcept = default;
SessionFile::~SessionFile() = default;

const Session& SessionFile::facts() const noexcept { return implementation_->facts; }

std::vector<std::uint8_t> SessionFile::sealed(std::size_t entry) const {
  return implementation_->reader.ask<std::vector<std::uint8_t>>({.what = Ask::sealed, .first = entry});
}

Session read_session_facts(const std::filesystem::path& file) { return SessionFile(file).facts(); }

std::vector<std::uint8_t> read_sealed(const std::filesystem::path& file, std::size_t entry) {
  return ReaderProcess(file, "a session")
      .ask<std::vector<std::uint8_t>>({.what = Ask::sealed, .first = entry});
}

std::string schema_of(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) return {};
  try {
    return ReaderProcess(file, "a file of Kerf").ask<std::string>({.what = Ask::schema});
  } catch (const std::exception&) {
    return {};  // whoever reads it says why
  }
}

std::vector<Violation> validate(const std::filesystem::path& file) {
  try {
    return ReaderProcess(file, "a file of Kerf").ask<std::vector<Violation>>({.what = Ask::violations});
  } catch (const DamageError& error) {
    return {{"the file", "damage (" + error.reason + ')', "a sound HDF5 file"}};
  }
}

}  // namespace kerf::schema
