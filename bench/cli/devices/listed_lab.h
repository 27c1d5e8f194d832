#pragma once

#include <vector>

#include <kerf/drivers/attached_ports.h>
#include <kerf/drivers/device.h>

namespace kerf::bench {

struct Context;

/// Says the serial ports on the USB, what may hang on each, and whether ModemManager speaks to them; as
/// `serial_ports` and `modem_manager` of the result.
void list_ports(const std::vector<drivers::AttachedPort>& ports, Context& context);

/// Says which libraries of makers are installed, and what devices wait for them; as `libraries` of the
/// result.
void list_libraries(const std::vector<drivers::MakerLibrary>& libraries, Context& context);

/// Says each entry of the bench file with its state, as `bench` of the result: null without a file. A file
/// that is wrong is said, and ends nothing.
void list_bench(const std::vector<drivers::AttachedDevice>& attached, Context& context);

}  // namespace kerf::bench
