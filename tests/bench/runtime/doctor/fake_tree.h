#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "doctor/facts/host_tree.h"
#include "doctor/facts/trials.h"
#include "support/program.h"

namespace kerf::bench::doctor::test {

/// Files of another machine, in a folder of their own.
class FakeTree {
 public:
  FakeTree& file(std::string_view path, const std::string& text) {
    const auto at = place(path);
    std::filesystem::create_directories(at.parent_path());
    kerf::test::write_text(at, text + "\n");
    return *this;
  }
  /// A link from one path of the tree to another, both from its root.
  FakeTree& link(std::string_view path, std::string_view target) {
    const auto at = place(path);
    std::filesystem::create_directories(at.parent_path());
    std::filesystem::create_symlink(place(target).lexically_relative(at.parent_path()), at);
    return *this;
  }
  [[nodiscard]] HostTree tree() const { return HostTree(folder_.path()); }

 private:
  [[nodiscard]] std::filesystem::path place(std::string_view path) const {
    return folder_.path() / path.substr(path.find_first_not_of('/'));
  }
  kerf::test::TemporaryFolder folder_;
};

/// As a machine that lets a user do everything.
inline MachineTrials all_permitted() {
  return {.clock_read_us = 0.02,
          .work_us = 50.0,
          .work_after_sleep_us = 80.0,
          .slack_ns = 50'000,
          .with_slack = {.p50_us = 60.0, .p99_us = 90.0, .p999_us = 90.0, .max_us = 90.0},
          .without_slack = {.p50_us = 10.0, .p99_us = 40.0, .p999_us = 40.0, .max_us = 40.0},
          .may_be_realtime = true,
          .realtime_detail = "SCHED_FIFO at priority 79",
          .realtime = Percentiles{.p50_us = 5.0, .p99_us = 15.0, .p999_us = 15.0, .max_us = 15.0},
          .may_stay_awake = true,
          .awake_detail = "deep sleep states held off",
          .awake = Percentiles{.p50_us = 2.0, .p99_us = 5.0, .p999_us = 5.0, .max_us = 5.0}};
}

}  // namespace kerf::bench::doctor::test
