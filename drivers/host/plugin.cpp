#include "plugin.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <dlfcn.h>

namespace kerf::host {
namespace {

constexpr double longest_open_s = 60.0;
constexpr std::size_t most_options = 64;

std::string joined(const std::vector<std::string_view>& names) {
  std::string all;
  for (const std::string_view name : names) all += (all.empty() ? "" : ", ") + std::string(name);
  return all.empty() ? "none" : all;
}

void check(const kerf_device_v1& description) {
  if (description.abi != KERF_DEVICE_ABI || description.size != sizeof(kerf_device_v1)) {
    throw Refusal("it describes version " + std::to_string(description.abi) + " of kerf/device.h in " +
                  std::to_string(description.size) + " bytes, expected version " +
                  std::to_string(KERF_DEVICE_ABI) + " in " + std::to_string(sizeof(kerf_device_v1)) +
                  ": build it again");
  }
  if (description.name == nullptr || *description.name == '\0') throw Refusal("it has no 'name'");
  const auto wanted = [](bool is_there, const char* what) {
    if (!is_there) throw Refusal(std::string("it has no ") + what);
  };
  wanted(description.open != nullptr, "open()");
  wanted(description.describe != nullptr, "describe()");
  wanted(description.read != nullptr, "read()");
  wanted(description.close != nullptr, "close()");
  wanted(description.write == nullptr || description.release != nullptr,
         "release(), which whoever has a write() needs: it lets the hand go");
  if (!(description.open_s >= 0.0 && description.open_s <= longest_open_s))
    throw Refusal("its 'open_s' is " + std::to_string(description.open_s) + ", expected 0 to 60 s");
}

}  // namespace

std::vector<std::string_view> option_names(const kerf_device_v1& description) {
  std::vector<std::string_view> names;
  for (const char* const* name = description.options;
       name != nullptr && *name != nullptr && names.size() < most_options; ++name) {
    names.emplace_back(*name);
  }
  return names;
}

const kerf_device_v1& load(const std::string& path) {
  void* const library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    const std::string why = dlerror();  // NOLINT(concurrency-mt-unsafe): of this thread, by glibc
    throw Refusal("it is no shared object that can be opened: " +
                  (why.starts_with(path + ": ") ? why.substr(path.size() + 2) : why));
  }
  const auto describing =
      reinterpret_cast<const kerf_device_v1* (*)()>(dlsym(library, "kerf_plugin_device"));  // NOLINT(*-cast)
  if (describing == nullptr) {
    throw Refusal(dlsym(library, "kerf_plugin_law") != nullptr
                      ? "it is a law, and no device: name it with --plugin"
                      : "it exports no kerf_plugin_device(): it is no device, or hides it");
  }
  const kerf_device_v1* const description = describing();
  if (description == nullptr) throw Refusal("its kerf_plugin_device() returns nothing");
  check(*description);
  return *description;
}

std::string one_line(std::string text) {
  std::ranges::replace_if(
      text, [](char c) { return static_cast<unsigned char>(c) < ' '; }, ' ');
  return text;
}

void* open_device(const kerf_device_v1& description, const Options& given) {
  const auto names = option_names(description);
  std::vector<const char*> values(names.size() + 1, nullptr);
  for (const auto& [name, value] : given) {
    const auto found = std::ranges::find(names, std::string_view(name));
    if (found == names.end()) throw Refusal("there is no option '" + name + "'; it takes " + joined(names));
    values[static_cast<std::size_t>(found - names.begin())] = value.c_str();
  }
  std::array<char, 512> why{};
  void* const device = description.open(values.data(), why.data(), why.size());
  if (device != nullptr) return device;
  why.back() = '\0';
  const std::string said = one_line(why.data());
  throw Refusal(said.empty() ? "its open() fails, and does not say why" : said);
}

}  // namespace kerf::host
