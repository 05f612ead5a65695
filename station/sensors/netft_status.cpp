/// What a Net F/T's status word says.
#include <fmt/format.h>

#include <span>

#include "station/sensors/netft.hpp"

namespace tractus {
namespace sensors {
namespace {
constexpr std::uint32_t kError = 1u << 31, kThreshold = 1u << 16;

struct Bit {
  int number;
  const char* says;
};
constexpr Bit kAxia[]{{0, "inner temperature out of range"},
                      {1, "supply voltage out of range"},
                      {2, "a gage is broken"},
                      {3, "busy"},
                      {5, "an error of its hardware"},
                      {7, "its calibration cannot be read"},
                      {16, "a threshold was passed"},
                      {27, "a gage is out of range"},
                      {28, "simulated error"},
                      {29, "the calibration's checksum is wrong"},
                      {30, "force or torque out of range"}};
constexpr Bit kBox[]{{1, "HTTP failed"},
                     {2, "inner temperature out of range"},
                     {3, "reference voltage or power monitoring failed"},
                     {4, "no data on the serial link"},
                     {5, "the analog board's supply is too low"},
                     {6, "the analog board's supply is too high"},
                     {7, "the analog ground is out of range"},
                     {8, "the gages' excitation is too weak"},
                     {9, "the gages' excitation is too strong"},
                     {10, "the analog board's watchdog ran out"},
                     {11, "the flash memory failed"},
                     {12, "the EEPROM failed"},
                     {13, "the stack is damaged"},
                     {14, "the watchdog ran out"},
                     {16, "a threshold was passed"},
                     {17, "the transducer is saturated, or its A/D conversion failed"},
                     {18, "DeviceNet failed"},
                     {19, "EtherNet/IP failed"},
                     {20, "RDT failed"},
                     {21, "CAN failed"},
                     {22, "the network failed"},
                     {23, "the configuration does not fit the calibration"},
                     {24, "a setting is not valid"},
                     {25, "halted by errors of the configuration"},
                     {26, "the program memory is damaged"},
                     {27, "the serial link failed"},
                     {28, "the analog board failed"},
                     {29, "the digital board failed"},
                     {30, "processor or memory failed"}};

std::span<const Bit> bits_of(NetFtStatus of) {
  return of == NetFtStatus::axia ? std::span<const Bit>(kAxia) : std::span<const Bit>(kBox);
}
}  // namespace

bool is_faulty(std::uint32_t status) noexcept {
  return (status & kError) != 0 && status != (kError | kThreshold);
}

bool is_saturated(std::uint32_t status, NetFtStatus of) noexcept {
  return (status & (of == NetFtStatus::axia ? 0x48000000u : 0x00020000u)) != 0;
}

std::string status_words(std::uint32_t status, NetFtStatus of) {
  std::string words;
  for (const Bit& bit : bits_of(of))
    if (status & 1u << bit.number)
      words += fmt::format("{}{}", words.empty() ? "" : ", ", bit.says);
  if (words.empty()) words = is_faulty(status) ? "an error" : "no error";
  return fmt::format("{:#010x} ({})", status, words);
}

}  // namespace sensors
}  // namespace tractus
