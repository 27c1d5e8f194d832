#include "own_code/new_device.h"

#include <fmt/format.h>

#include "own_code/compiler.h"

namespace kerf::bench {
namespace {

constexpr std::string_view beginning =
    R"(/* A %WHAT% of our own: 'kerf device build %NAME%.c -o %NAME%.so' makes a plug-in of it. What is here
   speaks to the toy that 'kerf-emulate %TOY%' plays; <kerf/device.h> says what is asked of each function. */
#define _DEFAULT_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <termios.h>
#include <unistd.h>

#include <kerf/device.h>

static const char* const options[] = {"port", NULL};

struct board {
  int port;
  size_t filled;
  unsigned char bytes[128]; /* of the frame that is coming in */
};

static void* open_board(const char* const* values, char* why, size_t why_size) {
  const char* path = values[0];
  struct termios line;
  int port = path ? open(path, O_RDWR | O_NOCTTY | O_CLOEXEC | O_NONBLOCK) : -1;
  /* The lock: nobody else may speak to a motor that we drive. */
  if (port < 0 || flock(port, LOCK_EX | LOCK_NB) != 0 || tcgetattr(port, &line) != 0) {
    if (!path) snprintf(why, why_size, "at which port? Give port=/dev/ttyACM0");
    if (path) snprintf(why, why_size, "%s: %s", path, errno == EWOULDBLOCK ? "another program has it" : strerror(errno));
    if (port >= 0) close(port);
    return NULL;
  }
  cfmakeraw(&line);
  cfsetspeed(&line, B115200);
  tcsetattr(port, TCSAFLUSH, &line);
  struct board* board = calloc(1, sizeof *board);
  board->port = port;
  return board;
}

static void close_board(void* device) {
  close(((struct board*)device)->port);
  free(device);
}

/* The next byte; 0: none within 10 ms; -1: the port is gone. */
static int next_byte(struct board* board, unsigned char* byte) {
  struct pollfd wanted = {board->port, POLLIN, 0};
  if (poll(&wanted, 1, 10) <= 0) return 0;
  ssize_t got = read(board->port, byte, 1);
  return got == 1 ? 1 : got < 0 && errno == EAGAIN ? 0 : -1;
}

)";

constexpr std::string_view rest_of_device =
    R"(static void describe(void* device, kerf_device_facts_v1* facts) {
  (void)device;
  facts->rate_hz = 1000.0;
  facts->jitter_s = 0.001;
  facts->flags = KERF_COUNTS_READINGS;
  facts->count_modulus = 256;
  facts->axis_count = 1;
  snprintf(facts->model, sizeof facts->model, "%NAME%");
  facts->axes[0] = (kerf_device_axis_v1){.name = "x", .position_unit = "m", .force_unit = "N",
                                         .resolution = 1e-5, .lower = -0.05, .upper = 0.05,
                                         .force_limit = 5.0, .slew_limit = 2000.0, /* N, N/s */
                                         .speed_limit = 5.0, .acceleration_limit = 200.0};
}

/* A5 n p0 p1 p2 s: n counts, p in steps of 10 um, s the sum of the others. */
static int read_board(void* device, kerf_device_reading_v1* reading) {
  struct board* board = device;
  unsigned char* b = board->bytes;
  for (;;) {
    int got = next_byte(board, &b[board->filled]);
    if (got <= 0) return got;
    if (++board->filled < 6) continue;
    if (b[0] == 0xA5 && b[5] == (unsigned char)(b[0] + b[1] + b[2] + b[3] + b[4])) break;
    memmove(b, b + 1, --board->filled); /* no frame begins here */
  }
  board->filled = 0;
  int steps = b[2] | b[3] << 8 | (signed char)b[4] * 65536;
  reading->position[0] = 1e-5 * steps;
  reading->number = b[1];
  return 1;
}

/* 5A f0 f1 s: f in mN. */
static int write_board(void* device, const double* force) {
  int mn = (int)(1000.0 * force[0]);
  unsigned char b[4] = {0x5A, (unsigned char)mn, (unsigned char)(mn >> 8), 0};
  b[3] = (unsigned char)(b[0] + b[1] + b[2]);
  ssize_t sent = write(((struct board*)device)->port, b, sizeof b);
  return sent == (ssize_t)sizeof b ? 0 : sent < 0 && errno == EAGAIN ? 1 : -1;
}

static void release(void* device) {
  double zero = 0.0;
  write_board(device, &zero);
}

static const kerf_device_v1 description = {
    .abi = KERF_DEVICE_ABI, .size = sizeof description, .name = "%NAME%", .about = "a carriage on a rail",
    .options = options, .open = open_board, .describe = describe, .read = read_board,
    .write = write_board, .release = release, .close = close_board};

const kerf_device_v1* kerf_plugin_device(void) { return &description; }
)";

constexpr std::string_view rest_of_sensor =
    R"(static void describe(void* device, kerf_device_facts_v1* facts) {
  (void)device;
  facts->rate_hz = 300.0;
  facts->flags = KERF_FORCE_SENSOR | KERF_COUNTS_READINGS;
  snprintf(facts->model, sizeof facts->model, "%NAME%");
}

/* "12 1.234 -0.123 0.567\n": its count, then fx, fy, fz in N; it measures no torque. */
static int read_board(void* device, kerf_device_reading_v1* reading) {
  struct board* board = device;
  char* line = (char*)board->bytes;
  for (;;) {
    int got = next_byte(board, &board->bytes[board->filled]);
    if (got <= 0) return got;
    if (line[board->filled] == '\n') break;
    if (++board->filled == sizeof board->bytes) board->filled = 0;
  }
  line[board->filled] = '\0';
  board->filled = 0;
  unsigned long long number;
  if (sscanf(line, "%llu %lf %lf %lf", &number, &reading->force[0], &reading->force[1], &reading->force[2]) != 4)
    return 0; /* half a line, at the beginning */
  reading->force[3] = reading->force[4] = reading->force[5] = NAN;
  reading->number = number;
  return 1;
}

static const kerf_device_v1 description = {
    .abi = KERF_DEVICE_ABI, .size = sizeof description, .name = "%NAME%", .about = "three strain gauges",
    .options = options, .open = open_board, .describe = describe, .read = read_board, .close = close_board};

const kerf_device_v1* kerf_plugin_device(void) { return &description; }
)";

constexpr std::string_view cmake_of_device =
    R"(# For who builds it within a project; 'kerf device build %NAME%.c' needs none of it.
cmake_minimum_required(VERSION 3.25)
project(%NAME% LANGUAGES C)
set(KERF_INCLUDE "%INCLUDE%" CACHE PATH "The folder with kerf/device.h")
add_library(%NAME% MODULE %NAME%.c)
set_target_properties(%NAME% PROPERTIES PREFIX "" C_VISIBILITY_PRESET hidden C_STANDARD 99)
target_include_directories(%NAME% PRIVATE ${KERF_INCLUDE})
target_link_libraries(%NAME% PRIVATE m)
)";

}  // namespace

NewDevice new_device(std::string_view name, bool sensor) {
  require_name(name, "a device");
  const std::string include = headers_with("kerf/device.h", "drivers/include").string();
  std::string source(beginning);
  source += sensor ? rest_of_sensor : rest_of_device;
  if (sensor) source.replace(source.find("#include <poll.h>"), 0, "#include <math.h>\n");
  return {.source = filled_in(source, {{"WHAT", sensor ? "force sensor" : "device"},
                                       {"TOY", sensor ? "gauge" : "slider"},
                                       {"NAME", std::string(name)}}),
          .cmake = filled_in(cmake_of_device, {{"INCLUDE", include}, {"NAME", std::string(name)}})};
}

}  // namespace kerf::bench
