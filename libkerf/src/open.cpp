#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <span>

#include <fmt/format.h>
#include <sodium/crypto_hash_sha256.h>

#include "files/named_file.h"
#include "handles.h"
#include "laws/law_toml.h"
#include "laws/placement.h"
#include "plugins.h"

namespace kerf {
namespace {

std::string sha256_digits(std::string_view text) {
  std::array<unsigned char, crypto_hash_sha256_BYTES> digest{};
  crypto_hash_sha256(digest.data(), reinterpret_cast<const unsigned char*>(text.data()), text.size());
  std::string digits;
  for (const unsigned char byte : digest) digits += fmt::format("{:02x}", byte);
  return digits;
}

kerf_law* open_text(std::string text, const std::string& name) {
  bench::LawFile file =
      bench::parse_law_file(text, name,
                            {.advice = "which is not loaded: first kerf_plugin_load() of PATH/",
                             .of_unknown = "one of a plug-in is known after kerf_plugin_load()",
                             .of_any_content = false});
  return new kerf_law{std::make_shared<const OpenedLaw>(std::move(file), std::move(text))};
}

models::Options options_of(std::span<const kerf_option> given) {
  models::Options options;
  for (const kerf_option& one : given) {
    models::OptionValue value;
    if (one.kind == KERF_OPTION_FLAG) {
      value = one.number != 0.0;
    } else if (one.kind == KERF_OPTION_NUMBER) {
      value = one.number;
    } else if (one.kind == KERF_OPTION_TEXT && one.text != nullptr) {
      value = std::string(one.text);
    } else {
      throw std::invalid_argument(
          fmt::format("option '{}' has kind {}; expected KERF_OPTION_FLAG, _NUMBER, or _TEXT with a text",
                      one.name, one.kind));
    }
    if (!options.emplace(one.name, std::move(value)).second)
      throw std::invalid_argument(fmt::format("option '{}' is given twice", one.name));
  }
  return options;
}

/// In the order of the law.
std::vector<double> values_of(std::string_view model, std::span<const kerf_value> given,
                              const std::vector<models::ParameterInfo>& parameters) {
  std::map<std::string, double, std::less<>> by_name;
  for (const kerf_value& one : given) {
    if (!by_name.emplace(one.name, one.value).second)
      throw std::invalid_argument(fmt::format("law '{}': parameter '{}' is given twice", model, one.name));
  }
  std::vector<double> values;
  std::string known;
  for (const models::ParameterInfo& info : parameters) {
    known += (known.empty() ? "" : ", ") + info.name;
    const auto found = by_name.find(info.name);
    if (found == by_name.end()) continue;
    values.push_back(found->second);
    by_name.erase(found);
  }
  if (!by_name.empty())
    throw std::invalid_argument(fmt::format("law '{}': unknown parameter '{}'; the law takes {}", model,
                                            by_name.begin()->first, known));
  if (values.size() != parameters.size())
    throw std::invalid_argument(fmt::format("law '{}': {} of {} parameters are missing; the law takes {}",
                                            model, parameters.size() - values.size(), parameters.size(),
                                            known));
  return values;
}

bench::LawFile made_by_name(std::string_view model, std::span<const kerf_value> values,
                            const models::Options& options) {
  const models::LawInfo info = models::law_info(model);
  bench::LawFile file{.law = models::Law::make(
                          model, values_of(model, values, models::Law::parameters(model, options)), options),
                      .contact = {},
                      .axis = {},
                      .fit = {}};
  if (!info.position_unit.empty()) file.position_unit = info.position_unit;
  if (!info.force_unit.empty()) file.force_unit = info.force_unit;
  return file;
}

template <typename Handle, typename Action>
kerf_status opened_by(Handle** law, char* error, std::size_t size, Action&& action) noexcept {
  *law = nullptr;
  return at_set_up(error, size, [&] { *law = action(); });
}

template <typename Of>
std::span<const Of> span_of(const Of* first, std::size_t count) {
  if (first == nullptr && count > 0) throw std::invalid_argument("an array is NULL, and its count is not 0");
  return {first, count};
}

const char* required(const char* text, std::string_view what) {
  if (text == nullptr) throw std::invalid_argument(fmt::format("{} is NULL", what));
  return text;
}

}  // namespace

OpenedLaw::OpenedLaw(bench::LawFile read, std::string from)
    : file(std::move(read)),
      initial(file.law.initial_state()),
      axes(bench::axes_of(file)),
      parameters(file.law.parameters()),
      options(models::Law::options(file.law.model())),
      model(file.law.model()),
      equation(models::law_info(model).equation),
      text(std::move(from)),
      sha256(sha256_digits(text)),
      spatial(file.law.is_spatial()) {
  for (const models::ParameterInfo& info : parameters)
    units.push_back(models::unit_of(info.quantity, file.force_unit, file.position_unit));
}

void say(std::string_view message, char* error, std::size_t size) noexcept {
  if (error == nullptr || size == 0) return;
  std::size_t length = std::min(message.size(), size - 1);
  const auto continues = [&](std::size_t at) {
    return (static_cast<unsigned char>(message[at]) & 0xC0U) == 0x80U;
  };
  while (length < message.size() && length > 0 && continues(length)) --length;
  // One line, whatever was in it.
  std::transform(message.begin(), message.begin() + static_cast<std::ptrdiff_t>(length), error,
                 [](char one) { return one == '\n' || one == '\r' ? ' ' : one; });
  error[length] = '\0';
}

}  // namespace kerf

using namespace kerf;

kerf_status kerf_law_open(const char* path, kerf_law** law, char* error, size_t error_size) {
  return opened_by(law, error, error_size, [&] {
    const std::filesystem::path file(required(path, "the path of a law file"));
    return open_text(bench::read_named_file(file), file.string());
  });
}

kerf_status kerf_law_parse(const char* text, size_t size, const char* name, kerf_law** law, char* error,
                           size_t error_size) {
  return opened_by(law, error, error_size, [&] {
    return open_text(std::string(required(text, "the text of a law"), size),
                     name == nullptr ? "a law" : name);
  });
}

kerf_status kerf_law_make(const char* model, const kerf_value* values, size_t value_count,
                          const kerf_option* options, size_t option_count, kerf_law** law, char* error,
                          size_t error_size) {
  return opened_by(law, error, error_size, [&] {
    bench::LawFile file = made_by_name(required(model, "the name of a model"), span_of(values, value_count),
                                       options_of(span_of(options, option_count)));
    std::string text = bench::to_toml(file);
    return new kerf_law{std::make_shared<const OpenedLaw>(std::move(file), std::move(text))};
  });
}

kerf_status kerf_plugin_load(const char* path, const char** model, char* error, size_t error_size) {
  const char* unasked = nullptr;
  return opened_by(model == nullptr ? &unasked : model, error, error_size, [&] {
    const std::string file = required(path, "the path of a plug-in");
    return loaded_plugin(file, sha256_digits(bench::read_named_file(file, bench::LargestInput::table)));
  });
}

void kerf_law_close(kerf_law* law) { delete law; }
