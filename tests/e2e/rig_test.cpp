/// The rig's peer as a station meets it: a real libmodbus client over loopback TCP and over a pair
/// of pseudo-terminals, the program itself, and rubbish on the wire.
#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <modbus/modbus.h>
#include <poll.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <checkout.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <random>
#include <string>

#include "core/json.hpp"
#include "station/rig/modbus_peer.hpp"

namespace tractus {
namespace {

namespace registers = devices::rig;
using registers::put_wide;
using registers::wide;

struct FreeContext {
  void operator()(modbus_t* context) const {
    modbus_close(context);
    modbus_free(context);
  }
};
using Client = std::unique_ptr<modbus_t, FreeContext>;

Client connected(int port, int unit = registers::kUnit) {
  Client client(modbus_new_tcp("127.0.0.1", port));
  modbus_set_slave(client.get(), unit);
  modbus_set_response_timeout(client.get(), 5, 0);
  EXPECT_EQ(modbus_connect(client.get()), 0) << modbus_strerror(errno);
  return client;
}

struct Readings {
  std::uint16_t at[registers::kReadingCount] = {};
  std::uint16_t status() const { return at[0]; }
  registers::RigFault fault() const { return static_cast<registers::RigFault>(at[0] >> 8); }
  std::int32_t wide_at(int address) const {
    return wide(at + (address - registers::kReadingStart));
  }
};

/// The cycle of a station: command out, readings back, FC 23.
Readings cycle(modbus_t* client, std::uint16_t control, int speed_um_s, int torque_uNm = 0,
               std::uint16_t sequence = 0) {
  std::uint16_t command[registers::kCommandCount] = {control, sequence};
  put_wide(command + registers::kSpeed_um_s, speed_um_s);
  put_wide(command + registers::kTorque_uNm, torque_uNm);
  Readings readings;
  EXPECT_EQ(modbus_write_and_read_registers(
                client, registers::kCommandStart, registers::kCommandCount, command,
                registers::kReadingStart, registers::kReadingCount, readings.at),
            registers::kReadingCount)
      << modbus_strerror(errno);
  return readings;
}

/// A peer whose machine's time stands until it is told.
class RigOnTheWire : public testing::Test {
 protected:
  void SetUp() override {
    auto peer = rig::listen_tcp(electronics_, traffic_, "127.0.0.1", 0);
    ASSERT_TRUE(peer) << peer.error().what;
    peer_ = std::move(*peer);
  }
  /// Milliseconds of the machine's time, a cycle each.
  Readings run(modbus_t* client, int milliseconds, std::uint16_t control, int speed_um_s) {
    Readings last;
    for (int k = 0; k < milliseconds; ++k) {
      cycle(client, control, speed_um_s);
      clock_.advance(1'000'000);
      last = cycle(client, control, speed_um_s);
    }
    return last;
  }
  void silence(int milliseconds) {
    for (int k = 0; k < milliseconds; ++k) {
      clock_.advance(1'000'000);
      electronics_.advance();
    }
  }
  core::ManualClock clock_;
  rig::Electronics electronics_{{}, {}, clock_};
  rig::Traffic traffic_;
  std::unique_ptr<rig::ModbusPeer> peer_;
};

TEST_F(RigOnTheWire, SaysWhatItIs) {
  const auto client = connected(peer_->port());
  std::uint16_t identity[registers::kIdentityCount];
  ASSERT_EQ(modbus_read_registers(client.get(), registers::kIdentityStart,
                                  registers::kIdentityCount, identity),
            registers::kIdentityCount);
  const auto at = [&](int address) { return identity + (address - registers::kIdentityStart); };
  EXPECT_EQ(*at(registers::kVersion), registers::kMapVersion);
  EXPECT_EQ(wide(at(registers::kTravel_um)), 100000);
  EXPECT_EQ(wide(at(registers::kTopSpeed_um_s)), 230000);  // [Probing, section 3]
  EXPECT_EQ(*at(registers::kSimulatedPeer), 1);
  EXPECT_TRUE(cycle(client.get(), 0, 0).status() & registers::kSimulated);
}

TEST_F(RigOnTheWire, MovesAsItIsTold) {
  const auto client = connected(peer_->port());
  const auto there = run(client.get(), 500, registers::kEnable, 40000);
  // v (t − τ) = 0.04 · (0.5 − 0.002) = 19.92 mm, to a step of 5 µm
  EXPECT_NEAR(there.wide_at(registers::kPosition_um), 19920, 5);
  EXPECT_NEAR(there.wide_at(registers::kVelocity_um_s), 40000, 1);
  EXPECT_EQ(there.wide_at(registers::kPosition_um) % registers::kResolution_um, 0);
  EXPECT_EQ(there.wide_at(registers::kTime_100us), 5000);
  const auto back = run(client.get(), 100, registers::kEnable, -40000);
  EXPECT_LT(back.wide_at(registers::kPosition_um), there.wide_at(registers::kPosition_um));
  EXPECT_EQ(cycle(client.get(), 0, 0, 0, 4711).at[1], 4711);  // the sequence comes back
}

TEST_F(RigOnTheWire, StopsWhenTheBusIsLostAndSaysWhy) {
  auto client = connected(peer_->port());
  run(client.get(), 100, registers::kEnable, 200000);
  client.reset();  // the station is gone
  silence(10);
  const auto again = connected(peer_->port());
  const auto readings = cycle(again.get(), 0, 0);
  EXPECT_EQ(readings.wide_at(registers::kVelocity_um_s), 0);
  EXPECT_EQ(readings.fault(), registers::RigFault::watchdog);
  const int stopped_um = readings.wide_at(registers::kPosition_um);
  silence(50);
  EXPECT_EQ(cycle(again.get(), 0, 0).wide_at(registers::kPosition_um), stopped_um);
}

TEST_F(RigOnTheWire, LeavesTheEmergencyStopToAPerson) {
  const auto station = connected(peer_->port());
  const auto people = connected(peer_->port(), registers::kWorldUnit);
  run(station.get(), 50, registers::kEnable, 50000);
  ASSERT_EQ(modbus_write_register(people.get(), registers::kStopButton, 1), 1);
  auto readings = run(station.get(), 10, registers::kEnable, 50000);
  EXPECT_EQ(readings.wide_at(registers::kVelocity_um_s), 0);
  EXPECT_TRUE(readings.status() & registers::kEmergency);
  ASSERT_EQ(modbus_write_register(people.get(), registers::kStopButton, 0), 1);
  for (const std::uint16_t control : std::initializer_list<std::uint16_t>{2, 0, 1, 0, 3, 0, 7, 0})
    readings = run(station.get(), 3, control, 50000);
  EXPECT_TRUE(readings.status() & registers::kEmergency);  // nothing over the bus clears it
  ASSERT_EQ(modbus_write_register(people.get(), registers::kResetButton, 1), 1);
  readings = run(station.get(), 3, 0, 0);
  EXPECT_FALSE(readings.status() & registers::kEmergency);
  readings = run(station.get(), 20, registers::kEnable, 50000);
  EXPECT_GT(readings.wide_at(registers::kVelocity_um_s), 45000);
}

TEST_F(RigOnTheWire, MeasuresTheHandThatPushes) {
  const auto station = connected(peer_->port());
  const auto people = connected(peer_->port(), registers::kWorldUnit);
  std::uint16_t hand[4];
  put_wide(hand, -20000);    // −20 N
  put_wide(hand + 2, 3000);  // 3 mN·m
  ASSERT_EQ(modbus_write_registers(people.get(), registers::kHandForce_mN, 4, hand), 4);
  const auto readings = run(station.get(), 5, 0, 0);
  EXPECT_NEAR(readings.wide_at(registers::kForce_mN), -20000, 2500);  // bias 0.5 N, five of them
  EXPECT_NEAR(readings.wide_at(registers::kHandTorque_uNm), 3000, 12500);
  EXPECT_GT(readings.wide_at(registers::kTurning_urad_s), 0);
}

TEST_F(RigOnTheWire, RefusesRequestsThatItsMapDoesNotHave) {
  const auto client = connected(peer_->port());
  std::uint16_t values[8] = {};
  EXPECT_EQ(modbus_read_registers(client.get(), 39, 2, values), -1);
  EXPECT_EQ(errno, EMBXILADD);
  EXPECT_EQ(modbus_write_register(client.get(), registers::kControl, 1), -1);  // half a command
  EXPECT_EQ(errno, EMBXILADD);
  EXPECT_EQ(modbus_write_registers(client.get(), registers::kStatus, 6, values), -1);
  EXPECT_EQ(errno, EMBXILADD);
  std::uint8_t bits[1];
  EXPECT_EQ(modbus_read_bits(client.get(), 0, 1, bits), -1);
  EXPECT_EQ(errno, EMBXILFUN);
  const auto stranger = connected(peer_->port(), 17);
  EXPECT_EQ(modbus_read_registers(stranger.get(), 0, 1, values), -1);
  EXPECT_EQ(errno, EMBXGTAR);
  EXPECT_EQ(traffic_.refused, 5u);
  EXPECT_EQ(cycle(client.get(), 0, 0).fault(), registers::RigFault::none);
}

int raw_socket(int port) {
  const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(static_cast<std::uint16_t>(port));
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  EXPECT_EQ(::connect(socket, reinterpret_cast<sockaddr*>(&to), sizeof to), 0);
  return socket;
}

TEST_F(RigOnTheWire, OutlivesGarbageAndGoesOnAnswering) {
  const auto client = connected(peer_->port());
  std::mt19937 random(11);
  for (int round = 0; round < 60; ++round) {
    const int socket = raw_socket(peer_->port());
    std::string bytes(1 + random() % 600, '\0');
    for (char& byte : bytes) byte = static_cast<char>(random());
    if (round % 3 == 0) bytes = "GET / HTTP/1.1\r\nHost: rig\r\n\r\n";
    if (round % 3 == 1) bytes.replace(0, 4, std::string(4, '\0'));  // a header that may pass
    ::send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    ::shutdown(socket, SHUT_WR);
    pollfd closed{socket, POLLIN, 0};
    EXPECT_EQ(::poll(&closed, 1, 10000), 1) << "the peer neither answers nor hangs up";
    ::close(socket);
    EXPECT_EQ(cycle(client.get(), 0, 0).fault(), registers::RigFault::none);
  }
  EXPECT_GT(traffic_.garbage, 0u);
}

TEST_F(RigOnTheWire, HangsUpOnTheNinthClientAndTakesOneWhenAnotherLeaves) {
  std::vector<Client> clients;
  for (int k = 0; k < 8; ++k) clients.push_back(connected(peer_->port()));
  for (const auto& client : clients) cycle(client.get(), 0, 0);
  const int ninth = raw_socket(peer_->port());
  pollfd closed{ninth, POLLIN, 0};
  ASSERT_EQ(::poll(&closed, 1, 10000), 1);
  char byte;
  EXPECT_LE(::recv(ninth, &byte, 1, 0), 0);
  ::close(ninth);
  clients.pop_back();
  std::uint16_t version = 0;  // the peer has to notice first
  for (int tries = 0; tries < 1000 && version == 0; ++tries) {
    modbus_read_registers(connected(peer_->port()).get(), registers::kVersion, 1, &version);
    ::poll(nullptr, 0, 10);
  }
  EXPECT_EQ(version, registers::kMapVersion);
}

TEST(RigPeer, RefusesAPortThatIsTakenInOneLine) {
  core::ManualClock clock;
  rig::Electronics electronics({}, {}, clock);
  rig::Traffic traffic;
  const auto first = rig::listen_tcp(electronics, traffic, "127.0.0.1", 0);
  ASSERT_TRUE(first);
  const int port = (*first)->port();
  const auto second = rig::listen_tcp(electronics, traffic, "127.0.0.1", port);
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().what,
            "Modbus TCP on 127.0.0.1:" + std::to_string(port) + ": Address already in use");
  EXPECT_FALSE(rig::listen_tcp(electronics, traffic, "somewhere", 0));
  EXPECT_FALSE(rig::open_rtu(electronics, traffic, "/nonexistent/tty", 115200));
}

/// Another program, ended with the test.
class Process {
 public:
  explicit Process(std::vector<std::string> words) {
    int ends[2];
    EXPECT_EQ(::pipe(ends), 0);
    pid_ = ::fork();
    if (pid_ == 0) {
      ::dup2(ends[1], STDOUT_FILENO);
      ::close(ends[0]);
      std::vector<char*> arguments;
      for (auto& word : words) arguments.push_back(word.data());
      arguments.push_back(nullptr);
      ::execvp(arguments[0], arguments.data());
      ::_exit(127);
    }
    ::close(ends[1]);
    out_.reset(::fdopen(ends[0], "r"));
  }
  ~Process() {
    if (pid_ > 0) end();
  }
  std::string line() {
    char text[512] = {};
    return std::fgets(text, sizeof text, out_.get()) ? text : "";
  }
  /// Its exit status; asks it to end first.
  int end() {
    ::kill(pid_, SIGTERM);
    int status = 0;
    ::waitpid(pid_, &status, 0);
    pid_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  pid_t pid_ = -1;
  std::unique_ptr<FILE, int (*)(FILE*)> out_{nullptr, &std::fclose};
};

/// Two pseudo-terminals joined by socat.
class SerialLine {
 public:
  SerialLine() {
    std::string name = "/tmp/tractus-rig-XXXXXX";
    EXPECT_NE(::mkdtemp(name.data()), nullptr);
    folder_ = name;
    socat_ = std::make_unique<Process>(std::vector<std::string>{
        "socat", "pty,raw,echo=0,link=" + end(0), "pty,raw,echo=0,link=" + end(1)});
    for (int tries = 0; tries < 1000 && !there(); ++tries) ::poll(nullptr, 0, 10);
    EXPECT_TRUE(there()) << "socat (deploy/packages-test.txt) made no line";
  }
  ~SerialLine() {
    socat_.reset();
    std::filesystem::remove_all(folder_);
  }
  std::string end(int which) const { return folder_ + (which == 0 ? "/rig" : "/station"); }

 private:
  bool there() const { return std::filesystem::exists(end(0)) && std::filesystem::exists(end(1)); }
  std::string folder_;
  std::unique_ptr<Process> socat_;
};

TEST(RigProgram, AnswersOnTcpAndOnASerialLineAtOnce) {
  const SerialLine line;
  Process program({std::string(checkout::kBin) + "/tractus-rig", "--port", "0", "--json", "--rtu",
                   line.end(0), "--surgeon", "--seed", "3"});
  const auto ready = core::parse_json(program.line(), "tractus-rig");
  ASSERT_TRUE(ready) << ready.error().what;
  EXPECT_EQ((*ready)["simulated"], true);
  const auto tcp = connected((*ready)["port"].get<int>());
  EXPECT_TRUE(cycle(tcp.get(), 0, 0).status() & registers::kSimulated);

  const Client serial(modbus_new_rtu(line.end(1).c_str(), 115200, 'E', 8, 1));
  modbus_set_slave(serial.get(), registers::kUnit);
  modbus_set_response_timeout(serial.get(), 5, 0);
  ASSERT_EQ(modbus_connect(serial.get()), 0) << modbus_strerror(errno);
  for (std::uint16_t k = 1; k <= 50; ++k) EXPECT_EQ(cycle(serial.get(), 0, 0, 0, k).at[1], k);
  // Rubbish on the line costs at most what is in flight.
  const char rubbish[] = "\x01\x17 is not a frame of Modbus RTU \xff\xff\xff";
  ASSERT_EQ(::write(modbus_get_socket(serial.get()), rubbish, sizeof rubbish),
            long(sizeof rubbish));
  ::poll(nullptr, 0, 300);  // a frame ends by silence
  modbus_flush(serial.get());
  EXPECT_EQ(cycle(serial.get(), 0, 0, 0, 99).at[1], 99);
  EXPECT_EQ(program.end(), 0);
  const auto counted = core::parse_json(program.line(), "tractus-rig");
  ASSERT_TRUE(counted);
  EXPECT_EQ((*counted)["answered"], 52);
  EXPECT_GE((*counted)["garbage"].get<int>(), 1);
}

}  // namespace
}  // namespace tractus
