#include <kerf/drivers/force_calibration.h>

#include "fuzz/target.h"

namespace kerf::fuzz {
namespace {

/// A calibration that is read is written so that it reads the same, to the last bit.
void fuzz_calibration(Bytes bytes) {
  drivers::ForceCalibration calibration;
  const std::string text(text_of(bytes));
  if (!is_taken<drivers::DeviceError>([&] { calibration = drivers::parse_force_calibration(text, "fuzz"); }))
    return;
  const std::string written = drivers::to_toml(calibration);
  drivers::ForceCalibration again;
  const bool is_read =
      is_taken<drivers::DeviceError>([&] { again = drivers::parse_force_calibration(written, "written"); });
  promise(is_read, "a calibration that is written is read:\n" + written);
  promise(again.matrix == calibration.matrix && again.bias_v == calibration.bias_v &&
              again.serial == calibration.serial && again.provenance == calibration.provenance,
          "a calibration is written as it is read:\n" + written);
  promise(drivers::to_toml(again) == written, "and its axes too");
}

const Registered registered("calibration", fuzz_calibration);

}  // namespace
}  // namespace kerf::fuzz
