#pragma once

#include <atomic>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace kerf::bench {

/// Work that goes through all rows of a recording on a thread of its own and gives way to what is asked of
/// the recording meanwhile. Ends with the object, after the rows that it is at.
class RowPreparation {
 public:
  /// To be told after every so many rows; throws where the work is to end.
  using GoOn = std::function<void(std::uint64_t rows)>;

  RowPreparation() = default;
  RowPreparation(const RowPreparation&) = delete;
  RowPreparation& operator=(const RowPreparation&) = delete;
  ~RowPreparation();

  /// Once. @param rows that the work will have told when it is done
  void start(std::uint64_t rows, std::function<void(const GoOn&)> work);

  /// From 0 to 1; 1 only when the work has ended well, or there was none.
  [[nodiscard]] double done() const noexcept;
  /// @throws what has ended the work.
  void rethrow_failure() const;

  /// As long as one lives, the work waits.
  class Request {
   public:
    explicit Request(RowPreparation& preparation) noexcept : preparation_(preparation) {
      ++preparation_.requests_;
    }
    Request(const Request&) = delete;
    Request& operator=(const Request&) = delete;
    ~Request() {
      --preparation_.requests_;
      preparation_.requests_.notify_all();
    }

   private:
    RowPreparation& preparation_;
  };

 private:
  void run(const std::function<void(const GoOn&)>& work);

  std::uint64_t rows_in_all_ = 0;
  std::atomic<std::uint64_t> rows_ = 0;
  std::atomic<bool> has_ended_well_ = true;
  std::atomic<bool> is_to_end_ = false;
  std::atomic<int> requests_ = 0;
  mutable std::mutex mutex_;
  std::exception_ptr failure_;
  std::thread thread_;
};

}  // namespace kerf::bench
