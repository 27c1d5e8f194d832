#include "apart/serve.h"

#include <algorithm>
#include <new>
#include <optional>
#include <string_view>
#include <system_error>
#include <vector>

#include <sys/socket.h>

#include "apart/archive.h"
#include "in_process.h"
#include "open_sweep_tables.h"
#include "validate/inspect.h"

namespace kerf::schema::apart {
namespace {

class Server {
 public:
  Server(const std::filesystem::path& file, int socket, Window window)
      : file_(file), socket_(socket), sink_(socket, window) {}

  void run() {
    Request request;
    while (::recv(socket_, &request, sizeof request, 0) == sizeof request) answer_or_refuse(request);
  }

 private:
  void answer_or_refuse(const Request& request) {
    try {
      answer(request);
      sink_.end();
    } catch (const DamageError& error) {
      refuse(Kind::damage, error.reason);
    } catch (const h5::Error& error) {
      refuse(Kind::damage, error.what());
    } catch (const std::system_error& error) {
      refuse(Kind::system_error, error.what(), error.code().value());
    } catch (const std::bad_alloc&) {
      refuse(Kind::format_error, file_.string() + ": more than fits into the memory");
    } catch (const std::exception& error) {
      refuse(Kind::format_error, error.what());
    }
  }

  void refuse(Kind kind, std::string_view why, int error_number = 0) {
    sink_.take_back();
    sink_.put(why.data(), std::min(why.size(), half_bytes));
    sink_.end(kind, error_number);
  }

  void answer(const Request& request) {
    switch (request.what) {
      case Ask::whole_recording:
        return put_whole();
      case Ask::recording:
        return open(true);
      case Ask::recording_with_trusted_texts:
        return open(false);
      case Ask::rows:
        return put_rows(request.dataset, request.first, request.rows);
      case Ask::tail:
        return put(in_process::read_tail(file_));
      case Ask::stored_forces:
        return put(in_process::read_regression(file_));
      case Ask::session:
        return put(in_process::read_session(file_));
      case Ask::session_facts:
        return put(in_process::read_session_facts(file_));
      case Ask::sealed:
        return put(in_process::read_sealed(file_, request.first));
      case Ask::schema:
        return put(in_process::schema_of(file_));
      case Ask::violations:
        return put(in_process::validate(file_));
      case Ask::sweep_tables:
        return put(sweep_.emplace(file_).facts());
      case Ask::sweep_column:
        return put_column(request.dataset, request.first);
    }
  }

  template <typename T>
  void put(const T& value) {
    ValueWriter(sink_).write(value);
  }

  void open(bool look_through_texts) {
    recording_.emplace(file_, look_through_texts);
    put(recording_->facts());
  }

  void put_whole() {
    open(true);
    const auto& facts = recording_->facts();
    const std::size_t datasets = in_process::first_channel + facts.about.channels.size();
    for (std::size_t dataset = 0; dataset < datasets; ++dataset) {
      if (recording_->row_bytes(dataset) > 0) put_rows(dataset, 0, facts.rows);
    }
  }

  void put_rows(std::size_t dataset, std::uint64_t first, std::uint64_t left) {
    const std::size_t row_bytes = recording_.value().row_bytes(dataset);
    while (left > 0) {
      const auto room = sink_.room(row_bytes);
      const auto rows = std::min<std::uint64_t>(left, room.size() / std::max<std::size_t>(row_bytes, 1));
      recording_->read(dataset, first, rows, room.first(rows * row_bytes));
      sink_.filled(rows * row_bytes);
      first += rows;
      left -= rows;
    }
  }

  void put_column(std::size_t table, std::size_t column) {
    const std::uint64_t rows = sweep_.value().facts().tables.at(table).rows;
    constexpr std::uint64_t at_once = half_bytes / sizeof(double);
    std::vector<double> values;
    for (std::uint64_t first = 0; first < rows; first += values.size()) {
      values.resize(std::min(at_once, rows - first));
      sweep_->read(table, column, first, values);
      sink_.put(values.data(), values.size() * sizeof(double));
    }
  }

  std::filesystem::path file_;
  int socket_;
  PieceSink sink_;
  std::optional<in_process::OpenRecording> recording_;
  std::optional<in_process::OpenSweepTables> sweep_;
};

}  // namespace

void serve(const std::filesystem::path& file, int socket, Window window) {
  Server(file, socket, window).run();
}

}  // namespace kerf::schema::apart
