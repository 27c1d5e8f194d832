#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "built_in.h"
#include "kerf/drivers/toml_text.h"
#include "kerf/drivers/uri.h"
#include "makers/dhd.h"
#include "makers/vendor_library.h"
#include "own_device.h"
#include "work.h"

namespace kerf::host {
namespace {

using drivers::UriOptions;

constexpr int oldest_known_version = 3;
constexpr int looks_every = 10;  // readings
constexpr double usual_reach_m = 0.1;
constexpr double highest_force_n = 50.0;

/// Where the maker's installations are, as its own bindings look for them; the newest of a folder first.
std::vector<std::string> libraries() {
  std::vector<std::string> all;
  std::vector<std::filesystem::path> folders;
  for (const char* const root : {"FDSDK", "FORCEDIM_SDK"}) {
    const char* const place = std::getenv(root);  // NOLINT(concurrency-mt-unsafe): before any thread
    if (place != nullptr) folders.push_back(std::filesystem::path(place) / "lib/release/lin-x86_64-gcc");
  }
  const char* const home = std::getenv("HOME");  // NOLINT(concurrency-mt-unsafe)
  if (home != nullptr) folders.push_back(std::filesystem::path(home) / ".local/lib");
  folders.emplace_back("/usr/local/lib");
  for (const std::string_view name : {"libdrd.so", "libdhd.so"}) {
    for (const auto& folder : folders) {
      std::vector<std::string> here;
      std::error_code error;
      for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
        const std::string file = entry.path().filename().string();
        if (file == name || file.starts_with(std::string(name) + ".")) here.push_back(entry.path().string());
      }
      // "3.9" is older than "3.17": the longer of two first, then by their digits.
      std::ranges::sort(here, [](const std::string& a, const std::string& b) {
        return a.size() != b.size() ? a.size() > b.size() : a > b;
      });
      all.insert(all.end(), here.begin(), here.end());
    }
    all.emplace_back(name);
  }
  return all;
}

struct ForceDimensionOptions {
  int number = 0;
  double most_force_n = 0.0;  ///< 0: as it tells, or as is assumed of its type
  double rate_hz = 1000.0;
  bool has_brakes = true;
  bool has_gravity_compensation = true;
  bool calibrates = false;
};

/// A device of Force Dimension, or a Falcon, by DHD: calls that come back when the device has answered.
class ForceDimension {
 public:
  static constexpr const char* name = "dhd";
  static constexpr double open_s = 30.0;  // it may have to find its stops
  static constexpr std::array<const char*, 8> options{"number", "library", "most_force", "rate",
                                                      "brakes", "gravity", "calibrate",  nullptr};
  static std::unique_ptr<ForceDimension> open(UriOptions& given) {
    ForceDimensionOptions wanted{.number = static_cast<int>(given.number("number", {"1", 0.0, 0.0, 63.0})),
                                 .most_force_n = given.number("most_force", {"N", 0.0, 0.1, highest_force_n}),
                                 .rate_hz = given.number("rate", {"Hz", 1000.0, 100.0, 4000.0}),
                                 .has_brakes = given.flag("brakes", true),
                                 .has_gravity_compensation = given.flag("gravity", true),
                                 .calibrates = given.flag("calibrate", false)};
    const auto named = given.text("library");
    VendorLibrary library = find(named ? std::vector{*named} : libraries());
    return std::make_unique<ForceDimension>(library, wanted);
  }

  [[nodiscard]] static VendorLibrary find(const std::vector<std::string>& files) {
    return VendorLibrary({.files = files,
                          .what = "Force Dimension's SDK",
                          .mend = "install it and let FDSDK name its folder, or name the library: "
                                  "library=/path/libdrd.so"});
  }

  ForceDimension(VendorLibrary& library, const ForceDimensionOptions& wanted)
      : dhd_(library), file_(library.file()), wanted_(wanted) {
    std::array<int, 4> version{};
    dhd_.sdk_version(&version[0], &version[1], &version[2], &version[3]);
    version_ = fmt::format("{}.{}.{}.{}", version[0], version[1], version[2], version[3]);
    if (version[0] < oldest_known_version) {
      throw std::runtime_error(fmt::format("{} is version {} of the SDK, expected {}.0 or later", file_,
                                           version_, oldest_known_version));
    }
    const int count = dhd_.device_count();
    if (wanted.number >= count) {
      throw std::runtime_error(fmt::format(
          "{}: {} devices are there{}; look at cable, power and permission (udev: USB vendor 1451)", file_,
          count < 0 ? 0 : count, count > 0 ? fmt::format(", numbers 0 to {}", count - 1) : ""));
    }
    const auto number = static_cast<dhd::Id>(wanted.number);
    // With DRD, which knows whether it is calibrated.
    has_drd_ = dhd_.drd_open_id != nullptr && dhd_.drd_close != nullptr;
    const int id = has_drd_ ? dhd_.drd_open_id(number) : dhd_.open_id(number);
    if (id < 0) throw std::runtime_error("it cannot be opened: " + why());
    id_ = static_cast<dhd::Id>(id);
    try {
      set_up();
    } catch (...) {
      close();
      throw;
    }
  }
  ForceDimension(const ForceDimension&) = delete;
  ForceDimension& operator=(const ForceDimension&) = delete;
  ~ForceDimension() {
    let_go_for_good();
    close();
  }

  void describe(kerf_device_facts_v1& facts) const {
    facts.flags = KERF_ANSWERS_AT_ONCE;
    facts.rate_hz = wanted_.rate_hz;
    facts.jitter_s = 1e-3;
    tell(facts.model, model_);
    tell(facts.about,
         fmt::format("{} by Force Dimension's SDK, 3 axes with force; {:g} Hz", model_, wanted_.rate_hz));
    tell(facts.serial, serial_);
    for (std::size_t i = 0; i < 3; ++i)
      add_axis(facts, {std::string_view("xyz").substr(i, 1), 0.0, -reach_m_, reach_m_, most_n_});
    add_channel(facts, "buttons", "1", KERF_CHANNEL_BUTTON);
    add_channel(facts, "saturated", "1");
    add_channel(facts, "read_took", "s");
    add_channel(facts, "write_took", "s");
    tell(facts.settings, fmt::format("library = {}\nlibrary_version = \"{}\"\nsystem_type = {}\nbrakes = "
                                     "{}\ngravity_compensation = {}\n"
                                     "range = \"{}\"\n",
                                     drivers::toml_text(file_), version_, type_, wanted_.has_brakes,
                                     wanted_.has_gravity_compensation,
                                     is_assumed_ ? "assumed" : "as CHAI3D assumes of this type"));
  }

  int read(kerf_device_reading_v1& reading) {
    std::array<double, 3> place{};
    const std::int64_t asked_ns = now_ns();
    const int said = dhd_.position(&place[0], &place[1], &place[2], id_);
    const std::int64_t answered_ns = now_ns();
    if (said < 0) return lose("it does not answer: " + why());
    if (readings_++ % looks_every == 0) {
      if (std::string wrong = ill(); !wrong.empty()) return lose(std::move(wrong));
    }
    if (said == dhd::same_sample) return 0;
    std::ranges::copy(place, reading.position);
    if (dhd_.button_mask != nullptr) reading.channels[0] = dhd_.button_mask(id_);
    reading.channels[1] = is_saturated_ ? 1.0 : 0.0;
    reading.channels[2] = 1e-9 * static_cast<double>(answered_ns - asked_ns);
    reading.channels[3] = write_took_s_;
    return 1;
  }

  int write(const double* force) {
    const bool is_zero = force[0] == 0.0 && force[1] == 0.0 && force[2] == 0.0;
    // Its forces are put on with the first, and never again where the device itself has put them off.
    if (!is_on_) {
      if (is_zero) return 0;
      if (dhd_.enable_force(1, id_) < 0) return lose("its forces cannot be put on: " + why());
      is_on_ = true;
    }
    const std::int64_t began_ns = now_ns();
    const int said = set(force[0], force[1], force[2]);
    write_took_s_ = 1e-9 * static_cast<double>(now_ns() - began_ns);
    if (said < 0) return lose("it does not take a force: " + why());
    is_saturated_ = said == dhd::saturated;
    return 0;
  }

  void release() noexcept {
    if (getpid() != opened_by_) return let_go_for_good();
    if (is_on_) (void)set(0.0, 0.0, 0.0);
  }

  [[nodiscard]] const char* trouble() const noexcept { return trouble_.c_str(); }

 private:
  void set_up() {
    type_ = dhd_.system_type(id_);
    const char* const told = dhd_.system_name(id_);
    model_ = told == nullptr || *told == '\0' ? fmt::format("Force Dimension type {}", type_) : told;
    unsigned short serial = 0;
    if (dhd_.serial_number != nullptr && dhd_.serial_number(&serial, id_) >= 0)
      serial_ = std::to_string(serial);
    set_limits();
    calibrate();
    if (dhd_.enable_force(0, id_) < 0 || dhd_.set_brakes(wanted_.has_brakes ? 1 : 0, id_) < 0 ||
        dhd_.set_gravity_compensation(wanted_.has_gravity_compensation ? 1 : 0, id_) < 0) {
      throw std::runtime_error(fmt::format("{} cannot be set up: {}", model_, why()));
    }
    if (const std::string wrong = ill(); !wrong.empty())
      throw std::runtime_error(fmt::format("{}: {}", model_, wrong));
  }

  void set_limits() {
    const dhd::Assumed assumed = dhd::assumed_of(type_);
    is_assumed_ = assumed.reach_m == 0.0;
    reach_m_ = is_assumed_ ? usual_reach_m : assumed.reach_m;
    double most_n = assumed.force_n;
    const double told_n = dhd_.max_force == nullptr ? 0.0 : dhd_.max_force(id_);
    if (std::isfinite(told_n) && told_n > 0.0) most_n = most_n == 0.0 ? told_n : std::min(most_n, told_n);
    if (most_n == 0.0 && wanted_.most_force_n == 0.0) {
      throw std::runtime_error(
          fmt::format("what {} (type {}) bears is not known here, and it does not tell; give the largest "
                      "force: most_force=1N",
                      model_, type_));
    }
    if (most_n > 0.0 && wanted_.most_force_n > most_n) {
      throw std::runtime_error(
          fmt::format("most_force={:g}N: {} gives at most {:g} N", wanted_.most_force_n, model_, most_n));
    }
    most_n_ = wanted_.most_force_n > 0.0 ? wanted_.most_force_n : most_n;
  }

  void calibrate() {
    if (!has_drd_ || dhd_.is_supported == nullptr || dhd_.is_initialized == nullptr ||
        !dhd_.is_supported(id_) || dhd_.is_initialized(id_)) {
      return;
    }
    if (!wanted_.calibrates || dhd_.auto_init == nullptr) {
      throw std::runtime_error(fmt::format(
          "{} is not calibrated; with calibrate=on it moves by itself, to its stops: hands off", model_));
    }
    if (dhd_.auto_init(id_) < 0 || !dhd_.is_initialized(id_))
      throw std::runtime_error(fmt::format("{} could not calibrate itself: {}", model_, why()));
  }

  /// What is wrong with its power or its forces; empty where nothing is.
  [[nodiscard]] std::string ill() const {
    std::array<int, dhd::status_count> status{};
    if (dhd_.status(status.data(), id_) < 0) return "it does not answer: " + why();
    if (status[dhd::status_power] == 0) return "it has no power";
    if (status[dhd::status_connected] == 0) return "it is not connected";
    if (status[dhd::status_error] != 0) return "it says that it has an error: " + why();
    if (!is_on_) return {};
    const char* const cause = dhd::cause_in_words(status[dhd::status_force_off_cause]);
    if (status[dhd::status_force] != 0 && cause == nullptr) return {};
    return fmt::format("its forces went off: {}", cause == nullptr ? "it does not say why" : cause);
  }

  int set(double x, double y, double z) const noexcept {
    if (dhd_.set_all != nullptr && dhd_.has_wrist != nullptr && dhd_.has_wrist(id_))
      return dhd_.set_all(x, y, z, 0.0, 0.0, 0.0, 0.0, id_);
    if (dhd_.set_force_and_gripper != nullptr && dhd_.has_gripper != nullptr && dhd_.has_gripper(id_))
      return dhd_.set_force_and_gripper(x, y, z, 0.0, id_);
    return dhd_.set_force(x, y, z, id_);
  }

  void let_go_for_good() noexcept {
    (void)set(0.0, 0.0, 0.0);
    (void)dhd_.enable_force(0, id_);
    (void)dhd_.stop(id_);
  }
  void close() noexcept { (void)(has_drd_ ? dhd_.drd_close : dhd_.close)(id_); }

  int lose(std::string what) {
    trouble_ = std::move(what);
    return -1;
  }
  [[nodiscard]] std::string why() const {
    const int error = dhd_.last_error();
    const char* const text = dhd_.last_error_text();
    return fmt::format("{} (error {} of DHD)",
                       text == nullptr || *text == '\0' ? "it does not say why" : text, error);
  }

  dhd::Functions dhd_;
  std::string file_;
  ForceDimensionOptions wanted_;
  std::string version_;
  dhd::Id id_ = -1;
  bool has_drd_ = false;
  int type_ = 0;
  std::string model_;
  std::string serial_;
  double most_n_ = 0.0;
  double reach_m_ = 0.0;
  bool is_assumed_ = false;
  bool is_on_ = false;
  bool is_saturated_ = false;
  double write_took_s_ = 0.0;  ///< of the last force; 0 before the first
  int readings_ = 0;
  std::string trouble_;
  pid_t opened_by_ = getpid();
};

}  // namespace

std::string look_for_force_dimension() {
  VendorLibrary library = ForceDimension::find(libraries());
  const dhd::Functions dhd(library);
  return fmt::format("{}; devices: {}", library.file(), std::max(0, dhd.device_count()));
}

const kerf_device_v1 force_dimension_device =
    as_plugin<ForceDimension>("Force Dimension's devices and Falcon by DHD");

}  // namespace kerf::host
