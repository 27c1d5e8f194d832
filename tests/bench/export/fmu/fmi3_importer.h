#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include <dlfcn.h>

namespace kerf::test {

/// Every function that a library of FMI 3.0 exports.
inline const std::vector<std::string>& fmi3_functions() {
  static const std::vector<std::string> all = [] {
    std::vector<std::string> names;
    for (const char* const name : {"GetVersion",
                                   "SetDebugLogging",
                                   "InstantiateModelExchange",
                                   "InstantiateCoSimulation",
                                   "InstantiateScheduledExecution",
                                   "FreeInstance",
                                   "EnterInitializationMode",
                                   "ExitInitializationMode",
                                   "EnterEventMode",
                                   "Terminate",
                                   "Reset",
                                   "GetNumberOfVariableDependencies",
                                   "GetVariableDependencies",
                                   "GetFMUState",
                                   "SetFMUState",
                                   "FreeFMUState",
                                   "SerializedFMUStateSize",
                                   "SerializeFMUState",
                                   "DeserializeFMUState",
                                   "GetDirectionalDerivative",
                                   "GetAdjointDerivative",
                                   "EnterConfigurationMode",
                                   "ExitConfigurationMode",
                                   "GetIntervalDecimal",
                                   "GetIntervalFraction",
                                   "GetShiftDecimal",
                                   "GetShiftFraction",
                                   "SetIntervalDecimal",
                                   "SetIntervalFraction",
                                   "SetShiftDecimal",
                                   "SetShiftFraction",
                                   "EvaluateDiscreteStates",
                                   "UpdateDiscreteStates",
                                   "EnterContinuousTimeMode",
                                   "CompletedIntegratorStep",
                                   "SetTime",
                                   "SetContinuousStates",
                                   "GetContinuousStateDerivatives",
                                   "GetEventIndicators",
                                   "GetContinuousStates",
                                   "GetNominalsOfContinuousStates",
                                   "GetNumberOfEventIndicators",
                                   "GetNumberOfContinuousStates",
                                   "EnterStepMode",
                                   "GetOutputDerivatives",
                                   "DoStep",
                                   "ActivateModelPartition"})
      names.push_back(std::string("fmi3") + name);
    for (const char* const type : {"Float32", "Float64", "Int8", "UInt8", "Int16", "UInt16", "Int32",
                                   "UInt32", "Int64", "UInt64", "Boolean", "String", "Binary", "Clock"}) {
      names.push_back(std::string("fmi3Get") + type);
      names.push_back(std::string("fmi3Set") + type);
    }
    return names;
  }();
  return all;
}

enum FmiStatus { fmi_ok = 0, fmi_error = 3 };

/// The library of an FMU, with what an importer of FMI 3.0 Co-Simulation calls.
class FmuLibrary {
 public:
  explicit FmuLibrary(const std::filesystem::path& file)
      : library_(dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL)) {
    if (library_ == nullptr) throw std::runtime_error(dlerror());
    get_version = function<const char*()>("fmi3GetVersion");
    set_debug_logging = function<int(void*, bool, std::size_t, const char* const*)>("fmi3SetDebugLogging");
    instantiate = function<Instantiate>("fmi3InstantiateCoSimulation");
    initialize = function<int(void*, bool, double, double, bool, double)>("fmi3EnterInitializationMode");
    do_step = function<int(void*, double, double, bool, bool*, bool*, bool*, double*)>("fmi3DoStep");
    get = function<int(void*, const std::uint32_t*, std::size_t, double*, std::size_t)>("fmi3GetFloat64");
    set =
        function<int(void*, const std::uint32_t*, std::size_t, const double*, std::size_t)>("fmi3SetFloat64");
    get_state = function<int(void*, void**)>("fmi3GetFMUState");
    set_state = function<int(void*, void*)>("fmi3SetFMUState");
    free_state = function<int(void*, void**)>("fmi3FreeFMUState");
    state_size = function<int(void*, void*, std::size_t*)>("fmi3SerializedFMUStateSize");
    serialize = function<int(void*, void*, std::uint8_t*, std::size_t)>("fmi3SerializeFMUState");
    deserialize = function<int(void*, const std::uint8_t*, std::size_t, void**)>("fmi3DeserializeFMUState");
    free_instance = function<void(void*)>("fmi3FreeInstance");
  }
  FmuLibrary(const FmuLibrary&) = delete;
  FmuLibrary& operator=(const FmuLibrary&) = delete;
  ~FmuLibrary() { dlclose(library_); }

  [[nodiscard]] bool has(const std::string& name) const { return dlsym(library_, name.c_str()) != nullptr; }
  /// One that takes nothing but the instance.
  int call(const char* name, void* instance) const { return function<int(void*)>(name)(instance); }

  using Log = void(void* environment, int status, const char* category, const char* message);
  using Instantiate = void*(const char*, const char*, const char*, bool, bool, bool, bool,
                            const std::uint32_t*, std::size_t, void*, Log*, void*);
  const char* (*get_version)();
  int (*set_debug_logging)(void*, bool, std::size_t, const char* const*);
  Instantiate* instantiate;
  int (*initialize)(void*, bool, double, double, bool, double);
  int (*do_step)(void*, double, double, bool, bool*, bool*, bool*, double*);
  int (*get)(void*, const std::uint32_t*, std::size_t, double*, std::size_t);
  int (*set)(void*, const std::uint32_t*, std::size_t, const double*, std::size_t);
  int (*get_state)(void*, void**);
  int (*set_state)(void*, void*);
  int (*free_state)(void*, void**);
  int (*state_size)(void*, void*, std::size_t*);
  int (*serialize)(void*, void*, std::uint8_t*, std::size_t);
  int (*deserialize)(void*, const std::uint8_t*, std::size_t, void**);
  void (*free_instance)(void*);

 private:
  template <typename Type>
  [[nodiscard]] Type* function(const char* name) const {
    void* const found = dlsym(library_, name);
    if (found == nullptr) throw std::runtime_error(std::string("no ") + name);
    return reinterpret_cast<Type*>(found);
  }

  void* library_;
};

/// An instance of an FMU, and what it said.
class FmuInstance {
 public:
  FmuInstance(const FmuLibrary& library, const std::string& token, bool logging = true)
      : library_(library),
        instance_(library.instantiate("test", token.c_str(), nullptr, false, logging, false, false, nullptr,
                                      0, this, keep, nullptr)) {}
  FmuInstance(const FmuInstance&) = delete;
  FmuInstance& operator=(const FmuInstance&) = delete;
  ~FmuInstance() { library_.free_instance(instance_); }

  [[nodiscard]] void* get() const { return instance_; }
  [[nodiscard]] const std::vector<std::string>& said() const { return said_; }
  [[nodiscard]] std::string last_said() const { return said_.empty() ? "" : said_.back(); }

  int call(const char* name) const { return library_.call(name, instance_); }
  int set(std::uint32_t reference, double value) const {
    return library_.set(instance_, &reference, 1, &value, 1);
  }
  int get(std::uint32_t reference, double& value) const {
    return library_.get(instance_, &reference, 1, &value, 1);
  }
  /// Both modes until a step is allowed.
  int begin(double start = 0.0) {
    time = start;
    if (const int status = library_.initialize(instance_, false, 0.0, start, false, 0.0); status != fmi_ok)
      return status;
    return call("fmi3ExitInitializationMode");
  }
  int step(double point, double size) {
    bool event = true;
    bool terminate = true;
    bool early = true;
    const int status = library_.do_step(instance_, point, size, false, &event, &terminate, &early, &time);
    if (status == fmi_ok && (event || terminate || early))
      throw std::runtime_error("a step asked for more than time");
    return status;
  }

  double time = 0.0;  ///< where the last step ended

 private:
  static void keep(void* environment, int /*status*/, const char* category, const char* message) {
    static_cast<FmuInstance*>(environment)->said_.push_back(std::string(category) + " | " + message);
  }

  const FmuLibrary& library_;
  std::vector<std::string> said_;
  void* instance_;
};

}  // namespace kerf::test
