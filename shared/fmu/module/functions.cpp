/// The functions of FMI 2.0: pointers and states of C turned into calls of an Instance. Nothing that is
/// thrown leaves them.
#include <fmt/format.h>

#include <memory>
#include <optional>

#include "core/try.hpp"
#include "fmu/module/fmi2.hpp"
#include "fmu/module/instance.hpp"

namespace tractus {
namespace fmu {
namespace {

using core::Errc;
using core::Error;
using core::Result;

void log(const fmi2CallbackFunctions& callbacks, const std::string& name, const std::string& what) {
  if (callbacks.logger)
    callbacks.logger(callbacks.componentEnvironment, name.c_str(), fmi2Error, "logStatusError",
                     "%s", what.c_str());
}

/// What an fmi2Component points to.
struct Component {
  std::string name;
  fmi2CallbackFunctions callbacks;
  std::unique_ptr<Instance> instance;
};

/// Runs a call; an error is told to the importer's logger.
template <class Call>
fmi2Status run(fmi2Component component, const Call& call) noexcept {
  if (!component) return fmi2Error;
  auto& one = *static_cast<Component*>(component);
  try {
    const Result<void> done = call(*one.instance);
    if (done) return fmi2OK;
    log(one.callbacks, one.name, done.error().what);
  } catch (const std::exception& failure) {
    log(one.callbacks, one.name, failure.what());
  }
  return fmi2Error;
}

Error nothing_given(const char* call) {
  return {Errc::bad_input, fmt::format("{}: a pointer is null", call)};
}

/// A function that this model has no use for: there is no variable of that type, or its capability
/// flag is false.
fmi2Status absent(fmi2Component component, const char* call, std::size_t count = 1) noexcept {
  return run(component, [&](Instance&) -> Result<void> {
    if (count == 0) return {};
    return Error{Errc::bad_input, fmt::format("{}: this model has nothing of the kind", call)};
  });
}

template <class Call>
fmi2Status with_values(fmi2Component component, const char* name, const void* references,
                       std::size_t count, const void* values, const Call& call) noexcept {
  return run(component, [&](Instance& instance) -> Result<void> {
    if (count == 0) return {};
    if (!references || !values) return nothing_given(name);
    return call(instance);
  });
}

Result<std::unique_ptr<Component>> made(fmi2String name, fmi2Type type, fmi2String guid,
                                        fmi2String resources,
                                        const fmi2CallbackFunctions& callbacks) {
  if (type != fmi2CoSimulation)
    return Error{Errc::bad_input, "this FMU is for co-simulation, not for model exchange"};
  if (!guid || !resources) return nothing_given("fmi2Instantiate");
  auto instance = TRY(Instance::make(guid, resources));
  return std::make_unique<Component>(Component{name ? name : "", callbacks, std::move(instance)});
}

}  // namespace
}  // namespace fmu
}  // namespace tractus

using namespace tractus::fmu;  // NOLINT: the functions below have C names
using tractus::core::Result;

extern "C" {

const char* fmi2GetTypesPlatform() { return "default"; }
const char* fmi2GetVersion() { return "2.0"; }

/// Errors are logged whatever is chosen; there is nothing else to log.
fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean, std::size_t, const fmi2String[]) {
  return c ? fmi2OK : fmi2Error;
}

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                              const fmi2CallbackFunctions* callbacks, fmi2Boolean, fmi2Boolean) {
  const fmi2CallbackFunctions used = callbacks ? *callbacks : fmi2CallbackFunctions{};
  const char* const who = name ? name : "";
  try {
    auto component = made(name, type, guid, resources, used);
    if (component) return std::move(component).value().release();
    log(used, who, component.error().what);
  } catch (const std::exception& failure) {
    log(used, who, failure.what());
  }
  return nullptr;
}

void fmi2FreeInstance(fmi2Component c) { delete static_cast<Component*>(c); }

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean, fmi2Real, fmi2Real start_s,
                               fmi2Boolean has_stop, fmi2Real stop_s) {
  return run(c, [&](Instance& i) {
    return i.set_up(start_s, has_stop ? std::optional(stop_s) : std::nullopt);
  });
}

fmi2Status fmi2EnterInitializationMode(fmi2Component c) {
  return run(c, [](Instance& i) { return i.begin_initialization(); });
}
fmi2Status fmi2ExitInitializationMode(fmi2Component c) {
  return run(c, [](Instance& i) { return i.end_initialization(); });
}
fmi2Status fmi2Terminate(fmi2Component c) {
  return run(c, [](Instance& i) { return i.terminate(); });
}
fmi2Status fmi2Reset(fmi2Component c) {
  return run(c, [](Instance& i) { return i.reset(), Result<void>(); });
}

fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference vr[], std::size_t n,
                       fmi2Real values[]) {
  return with_values(c, "fmi2GetReal", vr, n, values, [&](Instance& i) {
    return i.get({vr, n}, values);
  });
}
fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference vr[], std::size_t n,
                       const fmi2Real values[]) {
  return with_values(c, "fmi2SetReal", vr, n, values, [&](Instance& i) {
    return i.set({vr, n}, values);
  });
}
fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference vr[],
                                       std::size_t n, const fmi2Integer orders[],
                                       const fmi2Real values[]) {
  return with_values(c, "fmi2SetRealInputDerivatives", vr, orders ? n : n + 1,
                     orders ? values : nullptr, [&](Instance& i) {
                       return i.set_derivatives({vr, n}, orders, values);
                     });
}

fmi2Status fmi2GetInteger(fmi2Component c, const fmi2ValueReference[], std::size_t n,
                          fmi2Integer[]) {
  return absent(c, "fmi2GetInteger", n);
}
fmi2Status fmi2GetBoolean(fmi2Component c, const fmi2ValueReference[], std::size_t n,
                          fmi2Boolean[]) {
  return absent(c, "fmi2GetBoolean", n);
}
fmi2Status fmi2GetString(fmi2Component c, const fmi2ValueReference[], std::size_t n, fmi2String[]) {
  return absent(c, "fmi2GetString", n);
}
fmi2Status fmi2SetInteger(fmi2Component c, const fmi2ValueReference[], std::size_t n,
                          const fmi2Integer[]) {
  return absent(c, "fmi2SetInteger", n);
}
fmi2Status fmi2SetBoolean(fmi2Component c, const fmi2ValueReference[], std::size_t n,
                          const fmi2Boolean[]) {
  return absent(c, "fmi2SetBoolean", n);
}
fmi2Status fmi2SetString(fmi2Component c, const fmi2ValueReference[], std::size_t n,
                         const fmi2String[]) {
  return absent(c, "fmi2SetString", n);
}

fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate* state) {
  return run(c, [&](Instance& i) -> Result<void> {
    if (!state) return nothing_given("fmi2GetFMUstate");
    auto kept = i.state();
    delete static_cast<Instance::State*>(*state);  // one that is given is used again
    *state = kept.release();
    return {};
  });
}
fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate state) {
  return run(c, [&](Instance& i) -> Result<void> {
    if (!state) return nothing_given("fmi2SetFMUstate");
    i.restore(*static_cast<const Instance::State*>(state));
    return {};
  });
}
fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate* state) {
  return run(c, [&](Instance&) -> Result<void> {
    if (!state) return {};
    delete static_cast<Instance::State*>(*state);
    *state = nullptr;
    return {};
  });
}
fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate, std::size_t*) {
  return absent(c, "fmi2SerializedFMUstateSize");
}
fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate, fmi2Byte[], std::size_t) {
  return absent(c, "fmi2SerializeFMUstate");
}
fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte[], std::size_t, fmi2FMUstate*) {
  return absent(c, "fmi2DeSerializeFMUstate");
}
fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference[], std::size_t,
                                        const fmi2ValueReference[], std::size_t, const fmi2Real[],
                                        fmi2Real[]) {
  return absent(c, "fmi2GetDirectionalDerivative");
}
fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference[], std::size_t n,
                                        const fmi2Integer[], fmi2Real[]) {
  return absent(c, "fmi2GetRealOutputDerivatives", n);
}

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real t_s, fmi2Real length_s, fmi2Boolean) {
  return run(c, [&](Instance& i) { return i.step(t_s, length_s); });
}
fmi2Status fmi2CancelStep(fmi2Component c) { return absent(c, "fmi2CancelStep"); }

/// No step is ever pending, so there is one question that has an answer.
fmi2Status fmi2GetRealStatus(fmi2Component c, fmi2StatusKind kind, fmi2Real* value) {
  if (kind != fmi2LastSuccessfulTime) return absent(c, "fmi2GetRealStatus");
  return run(c, [&](Instance& i) -> Result<void> {
    if (!value) return nothing_given("fmi2GetRealStatus");
    *value = i.time_s();
    return {};
  });
}
fmi2Status fmi2GetStatus(fmi2Component c, fmi2StatusKind, fmi2Status*) {
  return absent(c, "fmi2GetStatus");
}
fmi2Status fmi2GetIntegerStatus(fmi2Component c, fmi2StatusKind, fmi2Integer*) {
  return absent(c, "fmi2GetIntegerStatus");
}
fmi2Status fmi2GetBooleanStatus(fmi2Component c, fmi2StatusKind, fmi2Boolean*) {
  return absent(c, "fmi2GetBooleanStatus");
}
fmi2Status fmi2GetStringStatus(fmi2Component c, fmi2StatusKind, fmi2String*) {
  return absent(c, "fmi2GetStringStatus");
}
}
