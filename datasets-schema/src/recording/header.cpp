#include <array>
#include <chrono>
#include <ctime>
#include <random>

#include <kerf/schema/recording.h>

namespace kerf::schema {
namespace {

std::string now_utc() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm parts{};
  gmtime_r(&now, &parts);
  std::array<char, 32> text{};
  return {text.data(), std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts)};
}

// Version 4: 122 random bits.
std::string random_uuid() {
  constexpr std::string_view digits = "0123456789abcdef";
  constexpr std::string_view variants = "89ab";
  std::random_device random;
  std::string uuid = "xxxxxxxx-xxxx-4xxx-yxxx-xxxxxxxxxxxx";
  for (auto& character : uuid) {
    if (character == 'x') character = digits[random() % digits.size()];
    if (character == 'y') character = variants[random() % variants.size()];
  }
  return uuid;
}

}  // namespace

Header new_header(std::string software) {
  Header header;
  header.created = now_utc();
  header.software = std::move(software);
  header.uuid = random_uuid();
  return header;
}

}  // namespace kerf::schema
