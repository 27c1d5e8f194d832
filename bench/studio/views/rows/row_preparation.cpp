#include "views/rows/row_preparation.h"

#include <algorithm>
#include <utility>

namespace kerf::bench {
namespace {

/// Nobody waits for the work any more.
struct Ended {};

}  // namespace

RowPreparation::~RowPreparation() {
  is_to_end_ = true;
  if (thread_.joinable()) thread_.join();
}

void RowPreparation::start(std::uint64_t rows, std::function<void(const GoOn&)> work) {
  rows_in_all_ = rows;
  has_ended_well_ = false;
  thread_ = std::thread([this, work = std::move(work)] { run(work); });
}

void RowPreparation::run(const std::function<void(const GoOn&)>& work) {
  try {
    work([this](std::uint64_t rows) {
      rows_ += rows;
      for (int requests = requests_; requests > 0; requests = requests_) requests_.wait(requests);
      if (is_to_end_) throw Ended();
    });
    has_ended_well_ = true;
  } catch (const Ended&) {  // and nothing of it is needed
  } catch (...) {
    const std::lock_guard lock(mutex_);
    failure_ = std::current_exception();
  }
}

double RowPreparation::done() const noexcept {
  if (has_ended_well_) return 1.0;
  constexpr double most = 0.99;
  return std::min(most, static_cast<double>(rows_) / static_cast<double>(rows_in_all_));
}

void RowPreparation::rethrow_failure() const {
  const std::lock_guard lock(mutex_);
  if (failure_) std::rethrow_exception(failure_);
}

}  // namespace kerf::bench
