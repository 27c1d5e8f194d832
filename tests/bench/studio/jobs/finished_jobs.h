#pragma once

#include <chrono>
#include <cstddef>
#include <stdexcept>
#include <thread>

#include <nlohmann/json.hpp>

#include "jobs/jobs.h"

namespace kerf::test {

/// What the page is told of a job once it has ended, however it did.
inline nlohmann::ordered_json ended_job(const bench::Jobs& jobs, std::size_t number) {
  while (true) {
    bool is_known = false;
    for (const auto& job : jobs.list()) {
      if (job["job"] != number) continue;
      is_known = true;
      if (job["state"] != "waiting" && job["state"] != "running") return job;
    }
    if (!is_known) throw std::runtime_error("the job was forgotten");
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

}  // namespace kerf::test
